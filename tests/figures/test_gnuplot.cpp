#include <cstdio>
#include <doctest/doctest.h>
#include <filesystem>
#include <stdexcept>
#include <unistd.h>

#include "figures/gnuplot.h"
#include "files/text.h"
#include "tests/shell.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::figures;

TEST_CASE("gnuplot: quoted text, whatever it holds") {
    CHECK(single_quoted("it's \"5\" \\n `x`") == "'it''s \"5\" \\n `x`'");
    CHECK(single_quoted("two\nlines") == "'twolines'");
}

TEST_CASE("gnuplot: a kept script is drawn in its own folder, once for each kind; one that fails is named") {
    const test::TemporaryFolder folder;
    files::write_text_atomically(folder / "a.gp", "set print kind . '.txt'\nprint 'drawn'\n");
    const std::string trouble = draw_script(folder / "a.gp", "a.csv is kept");
    if (!test::has_gnuplot()) {
        CHECK(trouble.find("gnuplot cannot be started") == 0);
        CHECK(trouble.find("a.csv is kept") != std::string::npos);
        return;
    }
    CHECK(trouble.empty());
    for (const char* kind : {"png", "svg", "pdf"})
        CHECK(files::read_text(folder / (std::string(kind) + ".txt")) == "drawn\n");
    files::write_text_atomically(folder / "b.gp", "exit status 3\n");
    CHECK_THROWS_WITH(draw_script(folder / "b.gp", "b.csv is kept"),
                      ("gnuplot could not draw " + (folder / "b.gp").string() + "; b.csv is kept").c_str());
}

TEST_CASE("gnuplot: a figure without its end is removed and named, as when the disk is full") {
    if (!test::has_gnuplot()) return;
    const test::TemporaryFolder folder;
    files::write_text_atomically(folder / "a.gp",
                                 "# set output \"a.\" . kind\nset print 'a.' . kind\nprint 'the begin'\n");
    const auto name = [&](const char* kind) { return (folder / kind).string(); };
    const std::string said = name("a.png") + ", " + name("a.svg") + ", " + name("a.pdf") +
                             ": gnuplot could not draw this to its end (is the disk full?); a.csv is kept";
    CHECK_THROWS_WITH(draw_script(folder / "a.gp", "a.csv is kept"), said.c_str());
    CHECK_FALSE(std::filesystem::exists(folder / "a.png"));
}

TEST_CASE("gnuplot: figures are drawn in folders of any name") {
    if (!test::has_gnuplot()) return;
    const test::TemporaryFolder folder;
    for (const char* name : {"two\nlines", "a\ttab", "\x1b[31m", "it's \"5\" \\n `x` $y %s"}) {
        CAPTURE(name);
        std::filesystem::create_directory(folder / name);
        for (const char* figure : {"a.png", "a.svg", "a.pdf"}) {
            draw_figure("plot x", folder / name / figure, 300, 200);
            CHECK(std::filesystem::exists(folder / name / figure));
        }
    }
}

TEST_CASE("gnuplot: what it says while it draws is told only if it fails") {
    if (!test::has_gnuplot()) return;
    const test::TemporaryFolder folder;
    const auto told = [&](const std::string& script) {
        std::fflush(stderr);
        const int kept = ::dup(2);
        CHECK(std::freopen((folder / "told").c_str(), "w", stderr) != nullptr);
        try {
            draw_figure(script, folder / "a.png", 300, 200);
        } catch (const std::runtime_error&) {
        }
        std::fflush(stderr);
        ::dup2(kept, 2);
        ::close(kept);
        return files::read_text(folder / "told");
    };
    CHECK(told("print 'noise'\nplot x").empty());
    CHECK(std::filesystem::exists(folder / "a.png"));
    CHECK(told("print 'noise'\nexit status 3").find("noise") == 0);
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        CHECK(entry.path().extension() != ".said");
}
