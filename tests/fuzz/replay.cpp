// Runs each fuzz target over its corpus, in the usual builds and without libFuzzer: seeds, and what was found once, stay
// readable or refused.

#include <algorithm>
#include <doctest/doctest.h>

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

}  // namespace

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
