// What stands between drives and sensor of a simulated device.

#include <cmath>
#include <doctest/doctest.h>

#include "tangible/plant/plant_body.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::tangible;
using namespace palpa::test;

namespace {

// A device by hand: one cable, force 1 N/mm per N of tension, surface where it is at rest, length 50 mm minus 2 mm per N.
PlantTable line_table() {
    PlantTable table;
    table.axes = {{{0}, 0.0, 4.0, 2, false}};
    table.actuators = 1;
    table.depths = 2;
    table.step_m = 10e-3;
    table.surface_m = {0.0, 0.0};
    table.force_N = {0.0, 0.0, 0.0, 40.0};
    table.length_m = {50e-3, 50e-3, 42e-3, 42e-3};
    return table;
}

PlantBody body_on(const PlantTable& table) {
    auto model = std::make_shared<DeviceModel>();
    model->actuators.resize(1);
    PlantBody body;
    body.table = &table;
    body.plant.model = model;
    body.motion.pause_s = 0.2;
    return body;
}

void run_body(PlantBody& body, double drive, bool driven, double seconds) {
    for (int i = 0; i < static_cast<int>(std::lround(1e3 * seconds)); ++i) step_body(1e-3, {drive}, driven, body);
}

}  // namespace

TEST_CASE("plant body: a press goes to its depth at its greatest speed and back, then pauses") {
    FingerMotion motion;
    motion.pause_s = 1.0;
    double deepest = 0.0, fastest = 0.0;
    for (double t_s = 0.0; t_s < 1.0; t_s += 0.01) CHECK(press_share(motion, t_s) == 0.0);
    const double round_s = 2.0 * 1.875 * 6.0 / 5.0 + 1.0;
    for (double t_s = 0.0; t_s < round_s; t_s += 1e-3) {
        deepest = std::max(deepest, press_share(motion, t_s));
        fastest = std::max(fastest, 6e-3 * (press_share(motion, t_s + 1e-3) - press_share(motion, t_s)) / 1e-3);
    }
    CHECK(deepest == close_to(1.0).epsilon(1e-6));
    CHECK(fastest == close_to(5e-3).epsilon(1e-3));
    CHECK(press_share(motion, 3.5 * round_s) == close_to(press_share(motion, 0.5 * round_s)));
}

TEST_CASE("plant body: the finger waits for the first command, is zeroed, and feels what the table says") {
    const PlantTable table = line_table();
    PlantBody body = body_on(table);
    run_body(body, 0.0, false, 1.0);
    CHECK_FALSE(body.zeroed);
    CHECK(displacement_m(body) == 0.0);
    run_body(body, 2.0, true, 0.5 + 0.2 + 1.875 * 6.0 / 5.0 + 0.002);
    CHECK(body.zeroed);
    CHECK(body.finger_m == close_to(6e-3).epsilon(1e-3));
    CHECK(body.force_N == close_to(2.0 * 6.0).epsilon(1e-3));
    CHECK(displacement_m(body) == close_to(body.finger_m).epsilon(1e-3));
    run_body(body, 0.0, true, 0.01);
    CHECK(body.force_N == 0.0);
}

TEST_CASE("plant body: drives lag; cables led by length have the tension of that length, and none when slack") {
    const PlantTable table = line_table();
    PlantBody lagging = body_on(table);
    lagging.plant.options.lag_s = 0.05;
    run_body(lagging, 2.0, true, 0.05);
    CHECK(lagging.actuation[0] == close_to(2.0 * (1.0 - std::exp(-1.0))).epsilon(1e-6));
    PlantBody led = body_on(table);
    led.drive.by_length = true;
    run_body(led, 46e-3, true, 0.1);
    CHECK(led.actuation[0] == close_to(2.0).epsilon(1e-3));
    run_body(led, 51e-3, true, 0.1);
    CHECK(led.actuation[0] == 0.0);
}

TEST_CASE("plant body: guides take their share of the tension while a cable is wound in") {
    const PlantTable table = line_table();
    PlantBody body = body_on(table);
    body.plant.options.friction_share = 0.1;
    double drive_N = 1.0;
    for (int i = 0; i < 300; ++i) {
        drive_N += 5e-3;  // winds in at 10 mm/s
        step_body(1e-3, {drive_N}, true, body);
    }
    CHECK(body.actuation[0] == close_to(0.9 * drive_N).epsilon(0.02));
}

TEST_CASE("plant body: a hand comes to rest where the device pushes back as hard") {
    const PlantTable table = line_table();
    PlantBody body = body_on(table);
    body.plant.options.hand = {0.2, 20.0};
    body.motion.hand_N = 3.0;
    body.motion.speed_m_per_s = 1e-3;
    run_body(body, 1.0, true, 0.7 + 1.875 * 6.0 / 1.0);
    CHECK(body.force_N == close_to(3.0).epsilon(0.02));
    CHECK(body.finger_m == close_to(3e-3).epsilon(0.02));
}
