#pragma once
// The loop of arm and pins, 1 kHz: one row of input gives one command. A pure function of the plan and the rows so far; it
// reads no clock, allocates nothing and throws nothing, so that recorded rows give the same commands to the last bit.

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "tactile/motion.h"
#include "tactile/plan.h"

namespace palpa::tactile {

inline constexpr double kStep_s = 1e-3;
inline constexpr double kLead_s = 20e-3;  // how far `lead` looks ahead: a frame of the pins' boards

// Whoever presses, if the touch leads: the pen, or a recorded press.
struct TouchInput {
    double time_s = 0.0;
    double x_m = 0.0;  // place on the tissue
    double y_m = 0.0;
    double depth_m = 0.0;
    double force_N = 0.0;
    bool down = false;
};

// What comes from the devices and from beside them.
struct LoopFeedback {
    devices::ArmFeedback arm;
    double by_table = 0.0;  // 1 once the table is complete: a change of fidelity is an input like any other
    double stopped = 0.0;   // 1 once a person has stopped everything
};

template <class Row, class Visit>
requires std::same_as<std::remove_const_t<Row>, LoopFeedback>
void visit_fields(Row& row, Visit&& visit) {
    visit_fields(row.arm, visit);
    visit("by_table", row.by_table);
    visit("stopped", row.stopped);
}

struct LoopInput {
    double time_s = 0.0;
    LoopFeedback feedback;
    TouchInput touch;
};

// What a step computed and wants. The guard (devices/limits.h) stands between it and the wire.
struct LoopCommand {
    double time_s = 0.0;
    double x_m = 0.0;
    double y_m = 0.0;
    double depth_m = 0.0;      // of the finger's bone
    double force_N = 0.0;      // between finger and tissue
    double linearity = 0.0;    // mechanics/linear_range.h
    double shape_scale = 1.0;  // below 1: the shape is scaled into the stroke
    bool pressed = false;
    bool held = false;  // the input is beyond the force limit, so that force and shape hold
    bool over_edge = false;
    bool inexact = false;
    std::int32_t clipped = 0;  // pins that should be beyond their stroke
    std::int32_t pins = 0;     // how many of the values below count
    devices::ArmCommand arm;
    std::array<double, devices::kMostPins> wanted_m{};   // heights of the shape of now
    std::array<double, devices::kMostPins> pins_m{};     // heights that are commanded, in the device's steps
    std::array<double, devices::kMostPins> reached_m{};  // estimate of where the pins are
};

// Visits what must be finite.
template <class Row, class Visit>
requires std::same_as<std::remove_const_t<Row>, LoopCommand>
void visit_fields(Row& row, Visit&& visit) {
    visit("depth_m", row.depth_m);
    visit("force_N", row.force_N);
    visit("linearity", row.linearity);
    visit("shape_scale", row.shape_scale);
    visit_fields(row.arm, visit);
    for (std::size_t i = 0; i < static_cast<std::size_t>(row.pins); ++i) {
        visit("wanted_m", row.wanted_m[i]);
        visit("pins_m", row.pins_m[i]);
        visit("reached_m", row.reached_m[i]);
    }
}

// All that a row changes.
struct LoopState {
    RendererWork now;    // of the press of now
    RendererWork later;  // of the press that the pins are told of ahead
    Motion motion;
    PinEstimate estimate;
    Eigen::VectorXd sink_m;  // of the pins
    Eigen::VectorXd height_m;
    Eigen::VectorXd commanded_m;  // height_m in steps
    Eigen::VectorXd carried_m;    // what rounding owes each pin (dither)
    double rounded_due_s = 0.0;
    bool rounded = false;
    FrictionDirection direction;  // of the arm's compensation
};

LoopState make_loop_state(const TactilePlan& plan);

LoopCommand loop_command(const TactilePlan& plan, const LoopInput& in, LoopState& state) noexcept;

}  // namespace palpa::tactile
