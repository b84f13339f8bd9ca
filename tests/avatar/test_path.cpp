#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <vector>

#include "avatar/display_ratio.h"
#include "avatar/path.h"
#include "tests/avatar/test_tissues.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::avatar;
using namespace palpa::test;

namespace {

constexpr StationLimit kLimit{4000.0, 4, 64};  // 200 mm/s

struct Walk {
    PathState state;
    std::vector<Pull> pulls;
    std::vector<Eigen::Vector2d> lags;
    int asked_most = 0;  // times that the tissue was asked, in one sample
};

// 0.1 s along x and back.
Walk sweep(double speed_m_per_s, double rate_Hz, const StationLimit& limit) {
    Walk walk;
    DisplayRatioState ratio;
    const DisplayRatio law = display_ratio_clear();
    for (int i = 0; i <= static_cast<int>(0.1 * rate_Hz); ++i) {
        Touch pen;
        pen.t_s = i / rate_Hz;
        pen.p_m = {1e-2 * std::sin(100.0 * speed_m_per_s * pen.t_s), 0.0};  // no faster than the speed
        pen.force_N = 1.0;
        pen.down = true;
        int asked = 0;
        const auto rise = [&](const Eigen::Vector2d& e_m, const Eigen::Vector2d& u, double force_N,
                              double reference_m) {
            ++asked;
            return rise_of(bump_N)(e_m, u, force_N, reference_m);
        };
        walk_to(
            law.path, limit, pen, rise, [&](const Pull& pull) { walk.pulls.push_back(pull); }, walk.state);
        walk.asked_most = std::max(walk.asked_most, asked);
        walk.lags.push_back(advance_lag(law, pen, rise_of(bump_N), ratio, limit));
    }
    return walk;
}

double way_m(const Walk& walk) {
    double sum_m = 0.0;
    for (const Pull& pull : walk.pulls) sum_m += pull.ds_m;
    return sum_m;
}

}  // namespace

TEST_CASE(
    "path: a stroke slower than the limit loses no station at any rate and gives the same numbers to the last bit") {
    for (const double rate_Hz : {30.0, 60.0, 240.0, 1000.0}) {
        CAPTURE(rate_Hz);
        const Walk limited = sweep(0.15, rate_Hz, {4000.0, 4, 1000});
        const Walk free = sweep(0.15, rate_Hz, {});
        CHECK(limited.state.skipped_stations == 0);
        CHECK(limited.lags == free.lags);
        REQUIRE(limited.pulls.size() == free.pulls.size());
        CHECK(limited.state.carry_m == free.state.carry_m);
    }
}

TEST_CASE(
    "path: a faster stroke asks the tissue no more often than the limit allows, counts the rest, and keeps its way") {
    struct Case {
        double rate_Hz;
        int most;
    };
    for (const Case& stroke : {Case{1000.0, 4}, Case{240.0, 16}, Case{60.0, 64}}) {
        const int most = stroke.most;
        CAPTURE(stroke.rate_Hz);
        const Walk free = sweep(1.5, stroke.rate_Hz, {});
        const Walk limited = sweep(1.5, stroke.rate_Hz, kLimit);
        CHECK(free.asked_most > most);
        CHECK(limited.asked_most <= most);
        CHECK(limited.asked_most > most / 2);
        CHECK(limited.state.skipped_stations ==
              static_cast<std::int64_t>(free.pulls.size()) - static_cast<std::int64_t>(limited.pulls.size()));
        CHECK(limited.state.skipped_stations > 0);
        CHECK(way_m(limited) == close_to(way_m(free)).epsilon(0.02));  // one dead band at each turn
        CHECK(limited.state.carry_m == free.state.carry_m);
        CHECK((limited.state.rope_m - free.state.rope_m).norm() < 1e-12);  // the last station of a sample stays
        CHECK(free.state.skipped_stations == 0);
    }
}

TEST_CASE("path: the stations that are left lie evenly") {
    PathState state;
    std::vector<double> at_m;
    const auto rise = [](const Eigen::Vector2d&, const Eigen::Vector2d&, double, double) { return 0.0; };
    const auto note = [&](const Pull& pull) { at_m.push_back(pull.t_s); };
    const auto touch = [](double t_s, double x_m) {
        Touch out;
        out.t_s = t_s;
        out.p_m = {x_m, 0.0};
        out.down = true;
        return out;
    };
    walk_to({}, StationLimit{4000.0, 4, 64}, touch(0.0, 0.0), rise, note, state);
    walk_to({}, StationLimit{4000.0, 4, 64}, touch(0.001, 0.00101), rise, note, state);  // 20 stations, 4 allowed
    REQUIRE(at_m.size() == 4);
    CHECK(state.skipped_stations == 16);
    for (std::size_t i = 0; i < 4; ++i) CHECK(at_m[i] == close_to((static_cast<double>(i) + 1.0) * 2.5e-4 / 1.01));
}

TEST_CASE("path: samples of a burst have the least number of stations each, whatever their times say") {
    CHECK(allowed_stations(kLimit, 0.0, 3) == 3);
    CHECK(allowed_stations(kLimit, 0.0, 100) == 4);
    CHECK(allowed_stations(kLimit, 0.01, 100) == 40);
    CHECK(allowed_stations(kLimit, 60.0, 100) == 64);
    CHECK(allowed_stations({}, 0.01, 100000) == 100000);
    CHECK(allowed_stations({}, 1e300, 100000) == 100000);
}

TEST_CASE("path: without a limit no station is lost, also between two samples of one time") {
    CHECK(allowed_stations({}, 0.0, 100) == 100);
    CHECK(allowed_stations({}, 1e-3, 100) == 100);
    CHECK(allowed_stations({.per_s = 4000.0, .least = 4, .most = 64}, 0.0, 100) == 4);
}
