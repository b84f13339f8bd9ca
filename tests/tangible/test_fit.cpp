#include <doctest/doctest.h>

#include "files/text.h"
#include "tangible/fit.h"
#include "tangible/tick_log.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/tangible/small_strip.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::tangible;
using namespace palpa::test;

namespace {

// A press on a plant, written as a table and read again; every so many ticks, since each takes an equilibrium.
std::vector<RecordedTick> recorded(const PlantOptions& plant, std::size_t every = 1) {
    const PressFigures figures = press_small(0.15, plant);
    const auto model = small_strip();
    std::string text = tick_columns(*model);
    for (std::size_t i = 0; i < figures.ticks.size(); i += every) {
        const PressTick& tick = figures.ticks[i];
        append_tick(*model, CommandKind::force, tick.command, tick.depth_m, tick.wanted_N, tick.rendered_N, text);
    }
    const TemporaryFolder folder;
    files::write_text_atomically(folder / "press.tsv", text);
    return read_presses(folder / "press.tsv", *model);
}

std::string presses_refused(const std::string& text) {
    const TemporaryFolder folder;
    files::write_text_atomically(folder / "press.tsv", text);
    return message_of([&] { read_presses(folder / "press.tsv", *small_strip()); });
}

}  // namespace

TEST_CASE("fit: a press whose cables were told lengths is refused, since nobody knows their tensions") {
    const PressFigures figures = press_small(0.15, small_plant(1.2));
    const auto model = small_strip();
    std::string text = tick_columns(*model);
    for (const PressTick& tick : figures.ticks)
        append_tick(*model, CommandKind::position, tick.command, tick.depth_m, tick.wanted_N, tick.rendered_N, text);
    CHECK(contains(presses_refused(text), "line 2, by_length: found '1', expected 0: drives that were told tensions"));
}

TEST_CASE("fit: a plant's modulus is found again from one press") {
    const FitResult result = fit_presses(small_strip()->device, recorded(small_plant(1.2), 4));
    CHECK(result.settled);
    CHECK(result.fit.modulus_factor == close_to(1.2).epsilon(0.01));
    CHECK(result.fit.friction_share < 0.01);
    CHECK(result.fit.lag_s == 0.0);  // was not asked for
    CHECK(result.rms_after_N < 0.1 * result.rms_before_N);
}

TEST_CASE("fit: friction is told from the difference of pressing and releasing") {
    PlantOptions plant = small_plant(0.9);
    plant.friction_share = 0.08;
    const FitResult result = fit_presses(small_strip()->device, recorded(plant, 4));
    CHECK(result.fit.modulus_factor == close_to(0.9).epsilon(0.02));
    CHECK(result.fit.friction_share == close_to(0.08).epsilon(0.02));
    CHECK(result.rms_after_N < 0.3 * result.rms_before_N);
}

TEST_CASE("fit: the lag of the drives is told from the speed of the press") {
    PlantOptions plant = small_plant(1.1);
    plant.lag_s = 0.05;
    const std::vector<RecordedTick> ticks = recorded(plant, 2);
    const FitResult result = fit_presses(small_strip()->device, ticks, {true, 24, {}});
    CHECK(result.settled);
    CHECK(result.fit.lag_s == close_to(0.05).epsilon(0.1));
    CHECK(result.lag_error_s.has_value());
    CHECK(result.fit.modulus_factor == close_to(1.1).epsilon(0.02));
    CHECK(result.fit.friction_share < 0.02);
    SoftDevice known = small_strip()->device;  // the same presses, and a lag that the device's file holds
    known.fit.lag_s = 0.05;
    const FitResult kept = fit_presses(known, ticks, {false, 24, {}});
    CHECK(kept.fit.lag_s == 0.05);
    CHECK(kept.fit.modulus_factor == close_to(1.1).epsilon(0.005));
}

TEST_CASE("fit: friction of cables that lag has the sense of what they do, not of what they are told") {
    PlantOptions plant = small_plant(0.9);
    plant.friction_share = 0.05;
    plant.lag_s = 0.03;
    const FitResult result = fit_presses(small_strip()->device, recorded(plant), {true, 24, {}});
    CHECK(result.settled);
    CHECK(result.fit.modulus_factor == close_to(0.9).epsilon(0.002));
    CHECK(result.fit.friction_share == close_to(0.05).epsilon(0.02));
    CHECK(result.fit.lag_s == close_to(0.03).epsilon(0.03));
}

TEST_CASE("fit: a lag that is not seen has no standard error") {
    const FitResult result = fit_presses(small_strip()->device, recorded(small_plant(1.1), 4), {true, 24, {}});
    CHECK(result.fit.lag_s == 0.0);
    CHECK_FALSE(result.lag_error_s.has_value());
}

TEST_CASE("fit: bad tables and presses that tell nothing") {
    CHECK(contains(presses_refused("time_s\tdepth_mm\n"), "force_N"));
    CHECK(contains(presses_refused("time_s\tdepth_mm\tforce_N\tleft_N\tright_N\n"), "no rows"));
    CHECK(contains(presses_refused("time_s\tdepth_mm\tforce_N\tleft_N\tright_N\n0\t1\tn/a\t1\t1\n"), "force_N"));
    CHECK(contains(presses_refused("time_s\tdepth_mm\tforce_N\tleft_N\tright_N\n0\t1\t1\t1\t1\n0\t1\t1\t1\t1\n"),
                   "a time after"));
    CHECK_THROWS_AS(fit_presses(small_strip()->device, std::vector<RecordedTick>(5)), std::runtime_error);
    std::vector<RecordedTick> held(30);
    for (std::size_t i = 0; i < held.size(); ++i) {
        held[i].time_s = 0.01 * static_cast<double>(i);
        held[i].depth_m = 3e-3;
        held[i].force_N = 1.0;
    }
    CHECK_THROWS_WITH_AS(fit_presses(small_strip()->device, held), doctest::Contains("stay between 3 and 3 mm deep"),
                         std::runtime_error);
}
