// Runs each fuzz target over its corpus, in the usual builds and without libFuzzer: seeds, and what was found once, stay
// readable or refused.

#include <algorithm>
#include <doctest/doctest.h>
#include <random>

#include "files/text.h"
#include "tests/fuzz/fuzz.h"

// The targets' entries (tests/fuzz/fuzz.h); CMakeLists.txt lists them.
#define TARGET(name) extern "C" int palpa_fuzz_##name(const std::uint8_t* data, std::size_t size);
#include "fuzz_targets.inc"
#undef TARGET

namespace {

namespace fs = std::filesystem;

struct Target {
    const char* name;
    int (*run)(const std::uint8_t* data, std::size_t size);
};

const Target kTargets[] = {
#define TARGET(name) {#name, palpa_fuzz_##name},
#include "fuzz_targets.inc"
#undef TARGET
};

// The bytes with one to four changes: a bit turned, a byte set, a piece cut out, doubled, or replaced by one of another input.
std::string changed(std::string bytes, const std::string& other, std::mt19937& random) {
    const auto below = [&](std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(random()) % n; };
    for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
        const std::size_t at = below(bytes.size());
        const std::size_t n = 1 + below(std::min<std::size_t>(32, bytes.size()));
        switch (below(5)) {
            case 0:
                if (!bytes.empty()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
                break;
            case 1:
                if (!bytes.empty()) bytes[at] = "0-.9eE\"[]{},\n\t\0\xff"[below(16)];
                break;
            case 2:
                bytes.erase(at, n);
                break;
            case 3:
                bytes.insert(at, bytes.substr(at, n));
                break;
            default:
                bytes.replace(at, n, other.substr(below(other.size()), n));
        }
    }
    return bytes;
}

}  // namespace

TEST_CASE("fuzz: every target takes or refuses inputs like those of its corpus, changed at random") {
    constexpr std::size_t kLongest = 4096;  // what a reader costs grows with its input
    constexpr int kInputs = 250;            // of each target; scripts/fuzz runs millions, led by what they reach
    constexpr unsigned kSeed = 1;
    CAPTURE(kSeed);
    for (const Target& target : kTargets) {
        CAPTURE(target.name);
        std::vector<std::string> seeds;
        for (const auto& entry : fs::directory_iterator(fs::path(PALPA_SOURCE_DIR) / "tests/fuzz/corpus" / target.name))
            seeds.push_back(palpa::files::read_text(entry.path()).substr(0, kLongest));
        std::sort(seeds.begin(), seeds.end());
        REQUIRE(!seeds.empty());
        std::mt19937 random(kSeed);
        for (int i = 0; i < kInputs; ++i) {
            CAPTURE(i);
            const std::string& from = seeds[random() % seeds.size()];
            const std::string bytes = changed(from, seeds[random() % seeds.size()], random);
            const std::vector<std::uint8_t> input(bytes.begin(), bytes.end());
            CHECK_NOTHROW(target.run(input.data(), input.size()));
        }
    }
}

TEST_CASE("fuzz: every target takes or refuses all of its corpus") {
    const fs::path corpus = fs::path(PALPA_SOURCE_DIR) / "tests/fuzz/corpus";
    for (const Target& target : kTargets) {
        CAPTURE(target.name);
        int files = 0;
        REQUIRE(fs::is_directory(corpus / target.name));
        for (const auto& entry : fs::directory_iterator(corpus / target.name)) {
            CAPTURE(entry.path().filename().string());
            const std::string bytes = palpa::files::read_text(entry.path());
            const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
            CHECK_NOTHROW(target.run(data, bytes.size()));
            // every reader must bear an end anywhere
            for (const std::size_t cut : {std::size_t{0}, bytes.size() / 3, bytes.size() / 2,
                                          bytes.size() - std::min<std::size_t>(bytes.size(), 1)}) {
                CAPTURE(cut);
                const std::vector<std::uint8_t> part(data, data + cut);  // of this size, so that reading on is noticed
                CHECK_NOTHROW(target.run(part.data(), part.size()));
            }
            ++files;
        }
        CHECK(files > 0);
    }
}
