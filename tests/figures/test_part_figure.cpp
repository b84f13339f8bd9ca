#include <doctest/doctest.h>
#include <filesystem>

#include "figures/part_figure.h"
#include "tests/error_message.h"
#include "tests/shell.h"

using namespace palpa::figures;
using namespace palpa::test;

TEST_CASE("part figure: a line for each design, and the widest band first") {
    const std::string script = designs_script({"a", 2000.0, 0.02}, {"b's", 1000.0, 0.01}, 4.0, {0.15, 0.25});
    CAPTURE(script);
    CHECK(contains(script, "$a << EOD\n0 0\n2 4\n"));
    CHECK(contains(script, "$b << EOD\n0 0\n4 4\n"));
    CHECK(contains(script, "$band0 << EOD\n0 0\n1.6 4\n2.5 4\n"));
    CHECK(script.find("25 % of the first") < script.find("15 % of the first"));
    CHECK(contains(script, "a: 2 N/mm, 20 g"));
    const std::string doubted = designs_script({"a", 2000.0, 0.02}, {"b", 1000.0, 0.01, false}, 4.0, {0.15, 0.25});
    CHECK(contains(doubted, "b: 1 N/mm, 10 g, DOES NOT APPLY"));
    CHECK_FALSE(contains(doubted, "hard to tell"));
}

TEST_CASE("part figure: gnuplot draws it") {
    if (!has_gnuplot()) return;
    const TemporaryFolder folder;
    plot_designs({"a", 2000.0, 0.02}, {"b's", 1000.0, 0.01}, 4.0, {0.15, 0.22}, folder / "f.svg");
    CHECK(std::filesystem::file_size(folder / "f.svg") > 2000);
}
