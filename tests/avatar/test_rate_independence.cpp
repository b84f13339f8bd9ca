// Random polylines, cut more and more finely: both laws depend on the line alone.

#include <doctest/doctest.h>
#include <random>

#include "avatar/delay.h"
#include "avatar/display_ratio.h"
#include "tests/avatar/test_tissues.h"

using namespace palpa;
using namespace palpa::avatar;
using namespace palpa::test;

namespace {

// 25 corners with pauses and doubled samples.
std::vector<Touch> random_polyline(std::mt19937& random) {
    std::uniform_real_distribution<double> place(-6e-3, 6e-3);
    std::vector<Touch> corners{touch_at(0.0, place(random), place(random))};
    for (int i = 0; i < 25; ++i) {
        Touch next = touch_at(0.0, place(random), place(random));
        const double pause_s = i % 5 == 2 ? 0.4 : 0.0;
        if (pause_s > 0.0) {
            Touch rest = corners.back();
            rest.t_s += pause_s;
            corners.push_back(rest);
            corners.push_back(rest);
        }
        next.t_s = corners.back().t_s + (next.p_m - corners.back().p_m).norm() / kSpeed_m_per_s;
        corners.push_back(next);
    }
    return corners;
}

std::vector<Touch> cut(const std::vector<Touch>& line, int pieces) {
    std::vector<Touch> out{line.front()};
    for (std::size_t i = 1; i < line.size(); ++i) {
        for (int k = 1; k <= pieces; ++k) {
            const double s = static_cast<double>(k) / pieces;
            Touch touch = line[i];
            if (k < pieces) {
                touch.t_s = line[i - 1].t_s + s * (line[i].t_s - line[i - 1].t_s);
                touch.p_m = line[i - 1].p_m + s * (line[i].p_m - line[i - 1].p_m);
            }
            out.push_back(touch);
        }
    }
    return out;
}

}  // namespace

TEST_CASE("rate independence: cutting a polyline 5 or 40 times more changes nothing") {
    constexpr std::uint32_t kSeed = 7;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    const DisplayRatio ratio = display_ratio_clear();
    const Delay delay = delay_clear();
    for (int n = 0; n < 20; ++n) {
        const auto line = random_polyline(random);
        DisplayRatioState ratio_state[3];
        DelayState delay_state[3];
        const int cuts[3] = {4, 20, 160};  // a teleport would be a segment over 5 mm in no time: cut 4 times at least
        std::vector<Eigen::Vector2d> lags[3];
        std::vector<double> taus[3];
        for (int c = 0; c < 3; ++c) {
            const auto samples = cut(line, cuts[c]);
            const auto every = static_cast<std::size_t>(cuts[c] / 4);
            for (std::size_t i = 0; i < samples.size(); ++i) {
                const auto lag = advance_lag(ratio, samples[i], rise_of(bump_N), ratio_state[c]);
                const Delayed delayed = advance_lag(delay, samples[i], rise_of(bump_N), delay_state[c]);
                if (i % every == 0) {
                    lags[c].push_back(lag);
                    taus[c].push_back(delayed.tau_s);
                }
            }
        }
        for (int c = 1; c < 3; ++c) {
            REQUIRE(lags[c].size() == lags[0].size());
            for (std::size_t i = 0; i < lags[0].size(); ++i) {
                CHECK((lags[c][i] - lags[0][i]).norm() < 1e-12);  // 1e-9 mm
                CHECK(std::abs(taus[c][i] - taus[0][i]) < 1e-12);
            }
        }
    }
}
