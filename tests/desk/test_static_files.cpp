#include <doctest/doctest.h>
#include <sys/stat.h>

#include "desk/static_files.h"
#include "files/text.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::desk;
using namespace palpa::test;

namespace {

namespace fs = std::filesystem;

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("static files: names of plain paths") {
    CHECK(names_of_path("/") == Names{"index.html"});
    CHECK(names_of_path("/a/b.js?v=1") == Names{"a", "b.js"});
    CHECK(names_of_path("/a/") == Names{"a", "index.html"});
    CHECK(names_of_path("/a%20b/%c3%A4.json#x") == Names{"a b", "\xc3\xa4.json"});
    CHECK(names_of_path("/a+b") == Names{"a+b"});
}

TEST_CASE("static files: tricks are no paths") {
    for (const std::string& target : {std::string(),
                                      std::string("a"),
                                      std::string("http://x/a"),
                                      std::string("*"),
                                      std::string("/../a"),
                                      std::string("/a/../b"),
                                      std::string("/./a"),
                                      std::string("/a/.."),
                                      std::string("/%2e%2e/a"),
                                      std::string("/%2E%2e%2Fa"),
                                      std::string("/a%2fb"),
                                      std::string("/a%5cb"),
                                      std::string("/a\\b"),
                                      std::string("/..%5c..%5ca"),
                                      std::string("/a%00.html"),
                                      std::string("/a%0a"),
                                      std::string("/a%7f"),
                                      std::string("/a%"),
                                      std::string("/a%2"),
                                      std::string("/a%zz"),
                                      std::string("/a%u002e"),
                                      std::string("//a"),
                                      std::string("/a//b"),
                                      std::string("/.git/config"),
                                      std::string("/a/.htaccess"),
                                      std::string("/%c0%ae%c0%ae/a"),
                                      std::string("/%ff"),
                                      std::string("/%e2%82"),
                                      std::string("/a\0b", 4),
                                      "/" + std::string(2000, 'a')}) {
        CAPTURE(target);
        CHECK_FALSE(names_of_path(target).has_value());
    }
    CHECK(names_of_path("/%252e%252e/a") == Names{"%2e%2e", "a"});  // once is once
}

TEST_CASE("static files: regular files below the folder, nothing else") {
    const TemporaryFolder folder;
    fs::create_directories(folder / "web" / "sub");
    write_text_atomically(folder / "web" / "a.js", "0123456789");
    write_text_atomically(folder / "web" / "sub" / "b.wasm", "");
    write_text_atomically(folder / "secret", "secret");
    fs::create_symlink(folder / "secret", folder / "web" / "link");
    fs::create_directory_symlink(folder.path(), folder / "web" / "up");
    fs::create_symlink("a.js", folder / "web" / "inside");
    REQUIRE(::mkfifo((folder / "web" / "pipe").c_str(), 0600) == 0);
    const auto opens = [&](const Names& names) { return open_static(folder / "web", names).is_open(); };
    CHECK(opens({"a.js"}));
    CHECK(opens({"sub", "b.wasm"}));
    CHECK_FALSE(opens({"sub"}));
    CHECK_FALSE(opens({"none"}));
    CHECK_FALSE(opens({"a.js", "x"}));
    CHECK_FALSE(opens({"link"}));
    CHECK_FALSE(opens({"inside"}));
    CHECK_FALSE(opens({"up", "secret"}));
    CHECK_FALSE(opens({"pipe"}));
    CHECK_FALSE(opens({}));
    const StaticFile file = open_static(folder / "web", {"a.js"});
    CHECK(file.bytes() == 10);
    char out[4] = "";
    CHECK(file.read(8, out, 4) == 2);
    CHECK(std::string(out, 2) == "89");
    CHECK(file.read(10, out, 4) == 0);
    const std::string before = file.etag();
    CHECK(open_static(folder / "web", {"a.js"}).etag() == before);
    write_text_atomically(folder / "web" / "a.js", "9876543210");
    CHECK(open_static(folder / "web", {"a.js"}).etag() != before);
}

TEST_CASE("static files: types that browsers insist on") {
    CHECK(mime_type("a.wasm") == "application/wasm");
    CHECK(mime_type("a.b.js") == "text/javascript; charset=utf-8");
    CHECK(mime_type("a.webmanifest") == "application/manifest+json");
    CHECK(mime_type("a.npy") == "application/octet-stream");
    CHECK(mime_type("wasm") == "application/octet-stream");
}
