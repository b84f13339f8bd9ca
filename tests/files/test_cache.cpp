#include <csignal>
#include <cstring>
#include <doctest/doctest.h>
#include <stdlib.h>
#include <sys/resource.h>

#include "files/cache.h"
#include "files/text.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

constexpr std::uint64_t kKey = 0x0123456789abcdefull;

const CachedArrays kArrays{{1.0, -2.5, 1.0 / 3.0}, {}, {1e300}};

// An environment variable for the length of a scope.
class Variable {
  public:
    Variable(const char* name, const char* value) : name_(name) {
        const char* before = getenv(name);
        had_ = before != nullptr;
        if (had_) before_ = before;
        value != nullptr ? setenv(name, value, 1) : unsetenv(name);
    }
    ~Variable() { had_ ? setenv(name_, before_.c_str(), 1) : unsetenv(name_); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

  private:
    const char* name_;
    bool had_;
    std::string before_;
};

}  // namespace

TEST_CASE("cache: arrays come back to the last bit, under their fingerprint only") {
    const TemporaryFolder folder;
    const auto deep = folder / "a" / "palpa";
    CHECK_FALSE(read_cache(deep, kKey));
    CHECK(write_cache(deep, kKey, kArrays).empty());
    CHECK(cache_file(deep, kKey).filename() == "0123456789abcdef.cache");
    REQUIRE(read_cache(deep, kKey));
    CHECK(*read_cache(deep, kKey) == kArrays);
    CHECK_FALSE(read_cache(deep, kKey + 1));
    CHECK(write_cache(deep, kKey, {}).empty());
    CHECK(read_cache(deep, kKey)->empty());
}

TEST_CASE("cache: the folder follows the XDG specification") {
    const Variable home("HOME", "/home/someone");
    {
        const Variable xdg("XDG_CACHE_HOME", "/var/x");
        CHECK(cache_folder() == "/var/x/palpa");
    }
    {
        const Variable relative("XDG_CACHE_HOME", "x");
        CHECK(cache_folder() == "/home/someone/.cache/palpa");
    }
    const Variable none("XDG_CACHE_HOME", nullptr);
    CHECK(cache_folder() == "/home/someone/.cache/palpa");
    const Variable homeless("HOME", nullptr);
    CHECK(cache_folder().empty());
    CHECK(contains(write_cache(cache_folder(), kKey, kArrays), "nothing is kept"));
    CHECK_FALSE(read_cache(cache_folder(), kKey));
}

TEST_CASE("hard case: every flipped bit and every cut of a cache file is noticed, and overwritten") {
    const TemporaryFolder folder;
    CHECK(write_cache(folder.path(), kKey, kArrays).empty());
    const auto file = cache_file(folder.path(), kKey);
    const std::string good = read_text(file);
    for (std::size_t i = 0; i < good.size(); ++i) {
        std::string bad = good;
        bad[i] = static_cast<char>(bad[i] ^ (1 << i % 8));
        write_text_atomically(file, bad);
        CHECK_FALSE(read_cache(folder.path(), kKey));
    }
    for (std::size_t n = 0; n < good.size(); ++n) {
        write_text_atomically(file, good.substr(0, n));
        CHECK_FALSE(read_cache(folder.path(), kKey));
    }
    write_text_atomically(file, good + std::string(8, '\0'));
    CHECK_FALSE(read_cache(folder.path(), kKey));
    CHECK(write_cache(folder.path(), kKey, kArrays).empty());
    CHECK(*read_cache(folder.path(), kKey) == kArrays);
}

TEST_CASE("hard case: a foreign file under a cache's name, another fingerprint's file, a folder in its place") {
    const TemporaryFolder folder;
    const auto file = cache_file(folder.path(), kKey);
    write_text_atomically(file, "not ours at all, but as long as a header: 64 bytes of plain text.");
    CHECK_FALSE(read_cache(folder.path(), kKey));
    CHECK(write_cache(folder.path(), kKey + 1, kArrays).empty());
    std::filesystem::copy_file(cache_file(folder.path(), kKey + 1), file,
                               std::filesystem::copy_options::overwrite_existing);
    CHECK_FALSE(read_cache(folder.path(), kKey));
    std::filesystem::remove(file);
    std::filesystem::create_directory(file);
    CHECK_FALSE(read_cache(folder.path(), kKey));
    CHECK(contains(write_cache(folder.path(), kKey, kArrays), "not kept"));
    write_text_atomically(folder / "plain", "a file");
    CHECK(contains(write_cache(folder / "plain" / "palpa", kKey, kArrays), "not kept"));
}

TEST_CASE("hard case: sizes that no file holds are refused before anything is allocated") {
    const TemporaryFolder folder;
    CHECK(write_cache(folder.path(), kKey, kArrays).empty());
    const auto file = cache_file(folder.path(), kKey);
    const std::string good = read_text(file);
    for (const std::size_t word : {std::size_t{3}, std::size_t{4}, std::size_t{6}}) {
        std::string bad = good;
        bad.replace(8 * word, 8, std::string("\xff\xff\xff\xff\xff\xff\xff\x1f", 8));
        // with the checksum made right again, as a writer with a fault would
        std::uint64_t hash = 14695981039346656037ull;
        for (std::size_t i = 0; i + 8 < bad.size(); i += 8) {
            std::uint64_t value;
            std::memcpy(&value, bad.data() + i, 8);
            hash = (hash ^ value) * 1099511628211ull;
            hash ^= hash >> 32;
        }
        std::memcpy(bad.data() + bad.size() - 8, &hash, 8);
        write_text_atomically(file, bad);
        CHECK_FALSE(read_cache(folder.path(), kKey));
    }
}

TEST_CASE("hard case: disk full while caching is a warning, and leaves what was there") {
    const TemporaryFolder folder;
    CHECK(write_cache(folder.path(), kKey, kArrays).empty());
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{4096, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    const std::string warning = write_cache(folder.path(), kKey, {std::vector<double>(10000, 1.0)});
    setrlimit(RLIMIT_FSIZE, &before);
    CHECK(contains(warning, "cannot be written"));
    CHECK(contains(warning, "the result is used but not kept"));
    REQUIRE(read_cache(folder.path(), kKey));
    CHECK(*read_cache(folder.path(), kKey) == kArrays);
    int left = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++left;
    CHECK(left == 1);  // nothing half written beside it
}
