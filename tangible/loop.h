#pragma once
// The loop of a soft device, at a fixed rate: one row of input gives one command. Read the finger, ask the virtual world for
// its force, solve the inverse problem, command (algorithm 1 of "Soft tangible devices controlled by inverse FEM"). A pure
// function of the plan and the rows so far; it reads no clock, allocates nothing and throws nothing, so that recorded rows
// give the same commands to the last bit.

#include <cstdint>
#include <type_traits>

#include "tangible/plan.h"

namespace palpa::tangible {

// One reading of the displacement sensor, and what else comes from outside.
struct TangibleFeedback {
    double sensor_m = 0.0;    // how deep the finger is, from the device's rest
    double sensor_s = 0.0;    // when that was read, on the loop's clock
    double has_sensor = 0.0;  // 1 once there was a reading
    double stopped = 0.0;     // 1 once a person, or a fault of the devices, has stopped everything
};

template <class Row, class Visit>
requires std::same_as<std::remove_const_t<Row>, TangibleFeedback>
void visit_fields(Row& row, Visit&& visit) {
    visit("sensor_m", row.sensor_m);
    visit("sensor_s", row.sensor_s);
    visit("has_sensor", row.has_sensor);
    visit("stopped", row.stopped);
}

struct TangibleInput {
    double time_s = 0.0;
    TangibleFeedback feedback;
    Eigen::Vector2d place_m = Eigen::Vector2d::Zero();  // on the tissue; counts where the scene follows the touch
    bool has_place = false;
};

// Why nothing, or an old command, is sent.
enum class TickFault : std::uint8_t { none, stopped, no_sensor, bad_input, no_equilibrium, slow };
const char* text_of(TickFault fault);

// What a tick computed and wants. The guard stands between it and the wire.
struct TangibleCommand {
    double time_s = 0.0;
    double depth_m = 0.0;        // of the finger, as the loop takes it
    double world_depth_m = 0.0;  // in the tissue
    double proxy_m = 0.0;
    double wanted_N = 0.0;
    double slope_N_per_m = 0.0;
    Actuation actuation{};  // N, Pa
    Lengths length{};       // m; minus m^3
    std::int32_t actuators = 0;
    bool pressed = false;
    bool saturated = false;     // the actuators cannot reach what is wanted, or the tissue is not known as deep
    bool rate_limited = false;  // they cannot be there within this tick
    bool held = false;          // the last valid command is repeated
    bool relaxed = false;       // the lower bounds are commanded
    TickFault fault = TickFault::none;
    // the terms of the inverse problem, for screens
    Actuation compliance{};  // row of W: m/N, m/Pa
    double gap_m = 0.0;
    double residual_m = 0.0;
    std::int32_t rank = 0;
    std::uint32_t active = 0;
    std::int32_t limited_by = -1;
    std::int32_t iterations = 0;
    bool converged = false;
};

// Visits what must be finite.
template <class Row, class Visit>
requires std::same_as<std::remove_const_t<Row>, TangibleCommand>
void visit_fields(Row& row, Visit&& visit) {
    visit("depth_m", row.depth_m);
    visit("wanted_N", row.wanted_N);
    visit("residual_m", row.residual_m);
    for (std::size_t j = 0; j < static_cast<std::size_t>(row.actuators); ++j) {
        visit("actuation", row.actuation[j]);
        visit("length", row.length[j]);
    }
}

// The last readings of a sensor that is slower than the loop.
struct SensorTrack {
    double time_s[2] = {0.0, 0.0};
    double depth_m[2] = {0.0, 0.0};
    int n = 0;
};

// All that a row changes.
struct TangibleState {
    DeviceState device;
    scene::TissueWork world;
    SensorTrack track;
    Actuation actuation{};  // last valid
    Lengths length{};
    Actuation told{};   // the drives, last
    Actuation drive{};  // what they give, behind that by the lag of the device's fit
    Lengths drive_length{};
    double failing_since_s = -1.0;
    bool relaxed = false;  // until the finger is lifted
};

// The sense of friction in a guide while a cable is wound in at a speed: 1, -1 while it is paid out, less in magnitude below 0.5
// mm/s, so that a cable at rest does not flutter. With a share f of friction the body gets (1 - f sense) of the tension.
double friction_sense(double wound_m_per_s) noexcept;

TangibleState make_tangible_state(const TangiblePlan& plan);

TangibleCommand tangible_tick(const TangiblePlan& plan, const TangibleInput& in, TangibleState& state) noexcept;

}  // namespace palpa::tangible
