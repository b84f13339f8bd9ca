#include <doctest/doctest.h>

#include "avatar/delay.h"
#include "tests/avatar/test_tissues.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::avatar;
using namespace palpa::test;

namespace {

template <class Force>
Delayed delayed_after(const Delay& law, const std::vector<Touch>& samples, Force force_N, DelayState& state) {
    Delayed out;
    for (const Touch& touch : samples) out = advance_lag(law, touch, rise_of(force_N), state);
    return out;
}

}  // namespace

TEST_CASE("delay: reference delays on the tent, at every sampling rate") {
    struct Row {
        bool clear;
        double x_mm;
        double tau_ms;
        double lag_mm;
    };
    const Row rows[] = {{false, -4, 9, 0.27}, {false, -3, 9, 0.27},   {false, 0, 9, 0.27},
                        {false, 1, 0, 0},     {true, -4.5, 12, 0.36}, {true, -4, 25.333333, 0.76},
                        {true, -3, 52, 1.56}, {true, 0, 54, 1.62},    {true, 1, 22.333333, 0.67},
                        {true, 2, 0, 0}};
    for (const Row& row : rows) {
        for (const double rate_Hz : {30.0, 60.0, 100.0, 133.0, 240.0, 1000.0}) {
            CAPTURE(row.clear);
            CAPTURE(row.x_mm);
            CAPTURE(rate_Hz);
            DelayState state;
            const Delay law = row.clear ? delay_clear() : delay_paper();
            const Delayed out = delayed_after(law, stroke(rate_Hz, 1e-3 * row.x_mm), tent_N, state);
            CHECK(std::abs(out.tau_s - 1e-3 * row.tau_ms) < 1e-9);
            CHECK(std::abs(out.lag_m.x() - 1e-3 * row.lag_mm) < 1e-9);
        }
    }
}

TEST_CASE("delay: on a pause the avatar arrives, then the delay runs out") {
    const Delay law = delay_clear();
    DelayState state;
    const auto samples = stroke(1000, -3e-3);
    delayed_after(law, samples, tent_N, state);
    struct Row {
        double after_ms;
        double lag_mm;
        double tau_ms;
    };
    for (const Row& row : {Row{20, 1.02, 54}, {60, 0, 54}, {150, 0, 52.3333333}, {200, 0, 2.3333333}, {250, 0, 0}}) {
        const Touch standing = touch_at(samples.back().t_s + 1e-3 * row.after_ms, -3e-3);
        const Delayed out = advance_lag(law, standing, rise_of(tent_N), state);
        CAPTURE(row.after_ms);
        CHECK(std::abs(out.lag_m.x() - 1e-3 * row.lag_mm) < 1e-9);
        CHECK(std::abs(out.tau_s - 1e-3 * row.tau_ms) < 1e-9);
    }
}

TEST_CASE("delay: peaks over a round bump") {
    struct Row {
        bool clear;
        double speed;
        double tau_ms;
        double lag_mm;
    };
    for (const Row& row : {Row{true, 0.01, 79.3, 0.793},
                           {true, 0.03, 79.3, 2.380},
                           {true, 0.1, 47.8, 4.783},
                           {false, 0.03, 13.22, 0.397}}) {
        const Delay law = row.clear ? delay_clear() : delay_paper();
        DelayState state;
        Delayed peak;
        for (const Touch& touch : stroke(1000, 10e-3, row.speed)) {
            const Delayed out = advance_lag(law, touch, rise_of(bump_N), state);
            peak.tau_s = std::max(peak.tau_s, out.tau_s);
            peak.lag_m.x() = std::max(peak.lag_m.x(), out.lag_m.x());
        }
        CAPTURE(row.speed);
        CHECK(peak.tau_s == close_to(1e-3 * row.tau_ms).epsilon(2e-3));
        CHECK(peak.lag_m.x() == close_to(1e-3 * row.lag_mm).epsilon(2e-3));
    }
}

TEST_CASE("hard case 10: delay stays in [0, cap] and never runs back, 60 s at 1,000 Hz") {
    const Delay law = delay_clear();
    DelayState state;
    double shown_s = 0.0;
    const auto steep = [](const Eigen::Vector2d& p, const Eigen::Vector2d&) {
        return 50.0 * std::max(0.0, std::sin(4000.0 * p.x()));
    };
    for (int i = 0; i < 60000; ++i) {
        const double t_s = 1e-3 * i;
        const Delayed out = advance_lag(law, touch_at(t_s, 0.04 * std::sin(2.0 * t_s)), rise_of(steep), state);
        REQUIRE(out.tau_s >= 0.0);
        REQUIRE(out.tau_s <= law.cap_s);
        REQUIRE(t_s - out.tau_s >= shown_s - 1e-12);
        shown_s = t_s - out.tau_s;
    }
    CHECK(state.ring.size() == 1024);
}

TEST_CASE("delay: not-a-number, lift and jump of the pen") {
    const Delay law = delay_clear();
    DelayState state;
    const Delayed before = delayed_after(law, stroke(1000, -3e-3), tent_N, state);
    const double t_s = state.path.last.t_s;
    const Delayed same = advance_lag(law, touch_at(t_s + 1e-3, std::nan("")), rise_of(tent_N), state);
    CHECK(same.lag_m == before.lag_m);
    CHECK(same.tau_s == before.tau_s);
    CHECK(advance_lag(law, touch_at(t_s + 1e-3, 20e-3), rise_of(tent_N), state).lag_m.norm() == 0.0);
    Touch up = touch_at(t_s + 2e-3, 20e-3);
    up.down = false;
    const Delayed lifted = advance_lag(law, up, rise_of(tent_N), state);
    CHECK(lifted.lag_m.norm() == 0.0);
    CHECK(lifted.tau_s == 0.0);
}

TEST_CASE("delay: strength 1 is `clear`, `strong` has strength 4 and a longer cap") {
    Delay law;
    set_strength(1.0, law);
    CHECK(law.m_s_per_N == delay_clear().m_s_per_N);
    set_strength(4.0, law);
    CHECK(law.m_s_per_N == 12.0);
    CHECK(delay_strong().m_s_per_N == 12.0);
    CHECK(delay_strong().cap_s == 0.4);
}
