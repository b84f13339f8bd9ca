#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "calibration/record_session.h"
#include "files/text.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::calibration;
using namespace palpa::test;

namespace {

// One press: holds still for 0.4 s at each level, 0.2 s from one to the next; level at 200 Hz, force at 100 Hz.
double press(const RecordOptions& options, const std::vector<double>& levels, double t_s, double factor,
             std::mt19937_64& random, RecordSession& session) {
    std::normal_distribution<double> normal;
    double before = 0.0;
    for (const double level : levels) {
        for (int i = 0; i < 120; ++i, t_s += 0.005) {
            const double now = i < 40 ? before + (level - before) * i / 40.0 : level;
            take_level(options, t_s, now, true, session);
            if (i % 2 == 0)
                take_force(options, t_s, factor * 0.1 * std::exp(3.5 * now) * (1.0 + 0.005 * normal(random)), session);
            capture(options, t_s, session);
        }
        before = level;
    }
    take_level(options, t_s, 0.0, false, session);
    return t_s + 0.6;
}

std::vector<double> staircase(int n) {
    std::vector<double> levels;
    for (int i = 0; i < n; ++i) levels.push_back((i + 0.5) / n);
    return levels;
}

}  // namespace

TEST_CASE("record: a point where both signals hold still, one for each place, and none in between") {
    RecordOptions options;
    RecordSession session;
    std::mt19937_64 random(1);
    const double t_s = press(options, {0.2, 0.5, 0.9}, 10.0, 1.0, random, session);
    REQUIRE(session.points.size() == 3);
    CHECK(session.points[1].level == close_to(0.5));
    CHECK(session.points[1].force_N == close_to(0.1 * std::exp(1.75)).epsilon(0.005));
    CHECK(session.points[1].time_s - 10.0 == close_to(0.6 + 0.2 + options.steady_s).epsilon(0.02));
    CHECK(session.points[2].phase == PressPhase::press);
    press(options, {0.9, 0.3}, t_s, 1.0, random, session);
    REQUIRE(session.points.size() == 5);
    CHECK(session.points[3].repeat == 1);
    CHECK(session.points[4].phase == PressPhase::release);
}

TEST_CASE("record: levels outside the range give no points") {
    RecordOptions options;
    options.range = {0.3, 0.7};
    RecordSession session;
    std::mt19937_64 random(1);
    press(options, {0.2, 0.5, 0.9}, 10.0, 1.0, random, session);
    REQUIRE(session.points.size() == 1);
    CHECK(session.points[0].level == close_to(0.5));
}

TEST_CASE("record: nothing is captured without a sensor, without touch, or on the move") {
    RecordOptions options;
    RecordSession session;
    for (int i = 0; i < 400; ++i) take_level(options, 0.005 * i, 0.5, true, session);
    CHECK_FALSE(capture(options, 2.0, session));  // no force
    for (int i = 0; i < 100; ++i) take_force(options, 0.01 * i, 1.0, session);
    CHECK_FALSE(capture(options, 2.0, session));  // the sensor stopped a second ago
    for (int i = 100; i < 200; ++i) take_force(options, 0.01 * i, 1.0 + 0.02 * i, session);
    CHECK_FALSE(capture(options, 2.0, session));  // the force still rises
    for (int i = 200; i < 300; ++i) take_force(options, 0.01 * i, 1.0, session);
    CHECK(capture(options, 2.9, session));         // a pen that is held still sends nothing: its level holds
    CHECK_FALSE(capture(options, 2.95, session));  // captured already
    take_level(options, 3.0, 0.0, false, session);
    CHECK_FALSE(capture(options, 3.4, session));
}

TEST_CASE("record: a force of the wrong sign is counted, and makes no point") {
    RecordOptions options;
    RecordSession session;
    std::mt19937_64 random(1);
    press(options, {0.2, 0.5, 0.9}, 10.0, -1.0, random, session);
    CHECK(session.points.empty());
    CHECK(session.below_zero > 0);
}

TEST_CASE("record: the zero is 0.4 s of rest, not a hand that already leans on the sensor") {
    RecordOptions options;
    RecordSession session;
    std::mt19937_64 random(2);
    std::normal_distribution<double> normal;
    double t_s = 0.0;
    for (int i = 0; i < 30; ++i, t_s += 0.01) take_rest(options, t_s, 2.1, session);
    CHECK(std::isnan(session.zero_N));  // 0.3 s only
    for (int i = 0; i < 40; ++i, t_s += 0.01) take_rest(options, t_s, 2.1 + 0.01 * normal(random), session);
    CHECK(session.zero_N == close_to(2.1).epsilon(0.003));
    const double before_N = session.zero_N;
    for (int i = 0; i < 300; ++i, t_s += 0.01) take_rest(options, t_s, 2.4 + 0.002 * i, session);  // 0.2 N/s
    CHECK(session.zero_N == close_to(before_N).epsilon(0.003));
}

TEST_CASE("record: it is enough when every band is known to 5 %, and until then it says what is missing") {
    RecordOptions options;
    options.steady_s = 0.2;
    RecordSession session;
    std::mt19937_64 random(4);
    CHECK(contains(knowledge_of(options, session.points).missing, "no point yet"));
    double t_s = press(options, {0.1, 0.15, 0.2, 0.25, 0.9}, 0.0, 1.0, random, session);
    const Knowledge first = knowledge_of(options, session.points);
    CHECK_FALSE(first.done);
    CHECK(contains(first.missing, "1 of 3 repeats"));
    CHECK(contains(first.missing, "50 % to 55 % (no point)"));
    CHECK(target_band(options, session, first.band_error) == 19);
    int repeats = 1;
    Knowledge now;
    std::normal_distribution<double> normal;
    while (!now.done && repeats < 20) {
        t_s = press(options, staircase(20), t_s, 1.0 + 0.01 * normal(random), random, session);
        now = knowledge_of(options, session.points);
        ++repeats;
    }
    CHECK(now.done);
    CHECK(now.missing.empty());
    CHECK(repeats >= 3);
    CHECK(repeats < 10);
    CHECK(target_band(options, session, now.band_error) == -1);

    // where the curve is only extrapolated it is not known, however well the points agree
    std::vector<double> heavier = staircase(20);
    std::erase_if(heavier, [](double level) { return level < 0.06; });
    RecordSession light;
    t_s = 0.0;
    for (int i = 0; i < 6; ++i) t_s = press(options, heavier, t_s, 1.0 + 0.01 * normal(random), random, light);
    CHECK_FALSE(knowledge_of(options, light.points).done);
    CHECK(contains(knowledge_of(options, light.points).missing, "not known to 5 %: 0 % to 5 % (no point)"));

    std::vector<double> lighter = staircase(20);
    std::erase_if(lighter, [](double level) { return level > 0.93; });
    lighter.push_back(0.96);
    RecordSession weak;
    t_s = 0.0;
    for (int i = 0; i < 6; ++i) t_s = press(options, lighter, t_s, 1.0 + 0.01 * normal(random), random, weak);
    CHECK(contains(knowledge_of(options, weak.points).missing, "95 % to 100 % (no point in its upper half)"));

    // repeats that differ by a third are never enough at once
    RecordSession wild;
    t_s = 0.0;
    for (int i = 0; i < 4; ++i) t_s = press(options, staircase(20), t_s, i % 2 == 0 ? 1.0 : 1.4, random, wild);
    CHECK_FALSE(knowledge_of(options, wild.points).done);
    CHECK(contains(knowledge_of(options, wild.points).missing, "not known to 5 %"));
    options.goal = 0.001;
    CHECK(contains(knowledge_of(options, wild.points).missing, "not known to 0.1 %"));
}

TEST_CASE("record: a session is kept in a file, and resumed from it") {
    const TemporaryFolder folder;
    const std::vector<CapturedPoint> points{{1.25, 0.1, 1.0 / 3.0, 0, PressPhase::press},
                                            {2.5, 0.7, 2.0, 4, PressPhase::release}};
    write_text_atomically(folder / "points.csv", points_csv(points));
    const auto back = read_session(folder / "points.csv");
    REQUIRE(back.size() == 2);
    CHECK(back[0].force_N == 1.0 / 3.0);
    CHECK(back[1].repeat == 4);
    CHECK(back[1].phase == PressPhase::release);
    write_text_atomically(folder / "bad.csv", "time_s,level,force_N,repeat,phase\n1,0.1,1,-1,press\n");
    CHECK(contains(message_of([&] { read_session(folder / "bad.csv"); }), "line 2, repeat: found '-1'"));
}
