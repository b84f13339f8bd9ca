#include <cmath>
#include <doctest/doctest.h>

#include "files/text.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/tangible/small_strip.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::tangible;
using namespace palpa::test;

namespace {

std::string plant_refused(const std::string& text) {
    const TemporaryFolder folder;
    files::write_text_atomically(folder / "plant.json", text);
    return message_of([&] { read_plant((folder / "plant.json").string()); });
}

}  // namespace

TEST_CASE("plant: a modulus 10 % off costs little by force and much by position") {
    const double by_force = press_small(0.1, small_plant(1.1)).force_rms_percent;
    LoopOptions loop;
    loop.command = CommandKind::position;
    const double by_position = press_small(0.1, small_plant(1.1), loop).force_rms_percent;
    CHECK(by_force > 0.1);
    CHECK(by_force < 3.0);
    CHECK(by_position > 2.0 * by_force);
    CHECK(by_position < 20.0);
}

TEST_CASE("plant: drives that lag, and readings that come late, cost force") {
    // stiffening tissue: for a straight line the tension hardly changes
    const auto error_of = [](const PlantOptions& plant) {
        return press_small(0.06, plant, {}, 0.0, 4.0).force_rms_percent;
    };
    const double exact = error_of(small_plant());
    PlantOptions lag = small_plant();
    lag.lag_s = 0.1;
    CHECK(error_of(lag) > exact + 0.5);
    PlantOptions late = small_plant();
    late.sensor.delay_s = 0.05;
    CHECK(error_of(late) > exact + 0.5);
}

TEST_CASE("plant: a loop that knows the lag of the drives undoes it") {
    LoopOptions loop;
    loop.command = CommandKind::position;
    PlantOptions lag = small_plant();
    lag.lag_s = 0.05;
    const double unknown = press_small(0.1, lag, loop).force_rms_percent;
    const double known = press_small(0.1, lag, loop, 0.0, 1e9, lag.lag_s).force_rms_percent;
    MESSAGE("force off by ", unknown, " %, and by ", known, " % where the lag is known");
    CHECK(known < 0.3 * unknown);
}

TEST_CASE("plant: the sensor reads at its own times, late by its delay, with noise of its seed") {
    const auto model = small_strip();
    PlantOptions options = small_plant();
    options.sensor = {50.0, 0.0, 0.005};
    const KnownTissue known(0.1);
    const TangiblePlan plan = make_tangible_plan(model, known.world, {0.0, 0.0}, {});
    const Plant plant = make_plant(model, options, plan.loop);
    PlantState state = make_plant_state(plant, plan, 1);
    double read_s = 0.0;
    for (int k = 0; k <= 10; ++k) {
        place_finger(0.01 * k, 1e-3 * k, state);
        const TangibleFeedback reading = read_plant_sensor(plant, 0.01 * k, state);
        read_s = reading.sensor_s;
        if (k >= 2) CHECK(std::abs(reading.sensor_m - 0.1 * (reading.sensor_s - 0.005)) < 1e-12);
    }
    CHECK(read_s == close_to(0.085));  // 80 ms was read, 5 ms later it came
    options.sensor.noise_m = 1e-5;
    const Plant noisy = make_plant(model, options, plan.loop);
    const auto first = [&](std::uint64_t seed) {
        PlantState s = make_plant_state(noisy, plan, seed);
        place_finger(0.0, 1e-3, s);
        return read_plant_sensor(noisy, 0.0, s).sensor_m;
    };
    CHECK(first(3) == first(3));
    CHECK(first(3) != first(4));
    CHECK(std::abs(first(3) - 1e-3) < 6e-5);
}

TEST_CASE("plant: exact has what was fitted to the device; a plant of one's own has not") {
    const KnownTissue known(0.1);
    const auto rms_percent = [&](const PlantOptions& plant) {
        const auto model = small_strip(0.85, 0.0, 0.02);
        const TangiblePlan plan = make_tangible_plan(model, known.world, {0.0, 0.0}, {});
        const PressFigures figures = run_press(plan, make_plant(model, plant, plan.loop), {4e-3, 8e-3}, 1);
        CHECK(figures.saturated_share < 0.05);
        return figures.force_rms_percent;
    };
    CHECK(rms_percent(read_plant("exact")) < 0.5);
    CHECK(rms_percent(small_plant()) > 0.8);
}

TEST_CASE("plant: a hand comes to rest where its force is the wanted one, with mass and without") {
    const KnownTissue known(0.1);
    const auto model = small_strip();
    const TangiblePlan plan = make_tangible_plan(model, known.world, {0.0, 0.0}, {});
    for (const double mass_kg : {0.0, 0.2}) {
        PlantOptions options = small_plant();
        options.hand = {mass_kg, 10.0};
        const Plant plant = make_plant(model, options, plan.loop);
        PlantState body = make_plant_state(plant, plan, 1);
        TangibleState loop = make_tangible_state(plan);
        place_finger(0.0, 0.0, body);
        PlantAnswer answer;
        for (int k = 0; k < 300; ++k) {
            TangibleInput in;
            in.time_s = 0.01 * k;
            in.feedback = read_plant_sensor(plant, in.time_s, body);
            const TangibleCommand command = tangible_tick(plan, in, loop);
            const double hand_N = std::min(0.3, 0.003 * k);
            answer = mass_kg > 0.0 ? push_plant(plant, command, in.time_s, hand_N, body)
                                   : yield_to_hand(plant, command, in.time_s, hand_N, body);
        }
        CHECK(body.depth_m == close_to(3e-3).epsilon(0.05));
    }
}

TEST_CASE("plant: friction in the guides gives hysteresis, and a loop that knows it takes most of it away") {
    PlantOptions rubbing = small_plant();
    rubbing.friction_share = 0.1;
    const PressFigures known = press_small(0.2, rubbing, {}, 0.1);
    const PressFigures unknown = press_small(0.2, rubbing);
    CHECK(std::abs(unknown.hysteresis_N) > 2.0 * std::abs(known.hysteresis_N));
    CHECK(known.force_rms_percent < 0.5 * unknown.force_rms_percent);
}

TEST_CASE("plant: bad input names the key, what was found and what was expected") {
    CHECK(contains(plant_refused("{}"), "name"));
    CHECK(contains(plant_refused(R"({"name": "p", "modulus_factor": 0})"), "modulus_factor"));
    CHECK(contains(plant_refused(R"({"name": "p", "device": 3})"), "device"));
    CHECK(contains(plant_refused(R"({"name": "p", "sensor": {"rate": 3}})"), "rate"));
    CHECK(contains(plant_refused(R"({"name": "p", "hand": {}})"), "mass_kg"));
    CHECK(contains(plant_refused(R"({"name": "p", "lag": 3})"), "lag"));
    CHECK(read_plant("exact").modulus_factor == 1.0);
}
