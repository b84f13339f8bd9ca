// PRESS.tsv.

#include <cmath>
#include <doctest/doctest.h>

#include "devices/press_file.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa::devices;
using namespace palpa::test;
using palpa::test::contains;
using palpa::test::message_of;

namespace {

std::string said_about(const std::string& text) {
    return message_of([&] { parse_press(text, "press.tsv"); });
}

}  // namespace

TEST_CASE("PRESS: depths and forces are read in their units") {
    const auto depth = parse_press("t_s\tx_mm\ty_mm\tdepth_mm\n0\t10\t20\t0\n0.5\t10\t20\t3\n", "press.tsv");
    REQUIRE(depth.size() == 2);
    CHECK(depth[1].depth_m == close_to(3e-3));
    CHECK(std::isnan(depth[1].force_N));
    CHECK(depth[1].y_m == close_to(0.02));
    const auto force = parse_press("t_s\tforce_N\tx_mm\ty_mm\n0\t2.5\t1\t2\n", "press.tsv");
    CHECK(force[0].force_N == 2.5);
    CHECK(std::isnan(force[0].depth_m));
}

TEST_CASE("PRESS: a time that goes back or stands still is refused with its line") {
    const std::string head = "t_s\tx_mm\ty_mm\tdepth_mm\n0\t0\t0\t0\n1\t0\t0\t1\n";
    CHECK(contains(said_about(head + "0.5\t0\t0\t1\n"), "line 4"));
    CHECK(contains(said_about(head + "0.5\t0\t0\t1\n"), "t_s"));
    CHECK(contains(said_about(head + "1\t0\t0\t1\n"), "after that of the row above"));
    CHECK(said_about(head + "1.0001\t0\t0\t1\n").empty());
    CHECK(contains(said_about(head + "1e17\t0\t0\t1\n"), "line 4"));  // more steps than a counter holds
}

TEST_CASE("PRESS: missing and unknown columns, missing values, no rows") {
    CHECK(contains(said_about("t_s\tx_mm\ty_mm\n0\t0\t0\n"), "neither depth_mm nor force_N"));
    CHECK(contains(said_about("t_s\tx_mm\ty_mm\tdepth_mm\tforce_N\n0\t0\t0\t0\t0\n"), "both"));
    CHECK(contains(said_about("t_s\tx_mm\ty_mm\tdepth_cm\n0\t0\t0\t0\n"), "depth_cm"));
    CHECK(contains(said_about("x_mm\ty_mm\tdepth_mm\n0\t0\t0\n"), "t_s"));
    CHECK(contains(said_about("t_s\tx_mm\ty_mm\tdepth_mm\n"), "no rows"));
    CHECK(contains(said_about("t_s\tx_mm\ty_mm\tdepth_mm\n0\t0\t0\tnan\n"), "line 2"));
    CHECK(contains(said_about("t_s\tx_mm\ty_mm\tdepth_mm\n0\t0\t0\tinf\n"), "line 2"));
}

TEST_CASE("PRESS: linear between rows, held outside of them, also when time jumps back") {
    const auto rows = parse_press("t_s\tx_mm\ty_mm\tdepth_mm\n1\t0\t0\t0\n2\t10\t0\t4\n4\t10\t0\t0\n", "press.tsv");
    std::size_t at = 0;
    CHECK(press_at(rows, 0.0, at).depth_m == 0.0);
    CHECK(press_at(rows, 1.5, at).depth_m == close_to(2e-3));
    CHECK(press_at(rows, 3.0, at).depth_m == close_to(2e-3));
    CHECK(press_at(rows, 9.0, at).depth_m == 0.0);
    CHECK(press_at(rows, 9.0, at).x_m == close_to(0.01));
    CHECK(press_at(rows, 1.25, at).x_m == close_to(2.5e-3));
}

TEST_CASE("PRESS: what is written reads back") {
    const palpa::test::TemporaryFolder folder;
    std::vector<PressRow> rows(2);
    rows[0].force_N = 0.1;
    rows[1].t_s = 0.3;
    rows[1].force_N = 0.7;
    rows[1].x_m = 0.012;
    write_press(rows, folder / "press.tsv");
    const auto back = read_press(folder / "press.tsv");
    REQUIRE(back.size() == 2);
    CHECK(back[1].force_N == 0.7);
    CHECK(back[1].x_m == close_to(0.012));
    CHECK(std::isnan(back[1].depth_m));
}
