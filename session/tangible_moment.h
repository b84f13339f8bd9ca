#pragma once
// What the loop of a soft device shows of itself: the latest moment and the shape of the device for the screens, and what
// stays as it is while the loop runs. Nothing here knows the loop, so that screens and the web build need no more than this.

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace palpa::session {

inline constexpr std::size_t kMostTangibleActuators = 8;
inline constexpr std::size_t kMostTangibleNodes = 4096;

using PointOfDevice = std::array<float, 3>;  // m, in the frame of the device file

struct TangibleActuator {
    std::string name;
    bool cavity = false;     // a pressure in Pa; else a cable: N, and a length in m
    bool by_length = false;  // the drive is told the cable's length; else force or pressure
    double lower = 0.0;      // N or Pa
    double upper = 0.0;
    std::vector<PointOfDevice> guides;  // of a cable, from its anchor's side on
    std::int32_t anchor = -1;  // of a cable: index of the node, of those of TangibleShape, nearest to its anchor
};

struct TangibleBearing {  // a cylinder
    PointOfDevice from_m{};
    PointOfDevice to_m{};
    double radius_m = 0.0;
};

// What stays as it is while the loop runs.
struct TangibleBody {
    std::string device;                              // name in the device file
    std::vector<PointOfDevice> rest_m;               // nodes of the surface, undeformed
    std::vector<std::array<std::int32_t, 4>> faces;  // of the surface: indices into rest_m; a triangle repeats its last
    std::vector<TangibleActuator> actuators;
    std::vector<TangibleBearing> bearings;
    PointOfDevice direction{0.0f, 0.0f, -1.0f};  // in which the finger presses; a unit vector
    PointOfDevice effector_m{};                  // where the finger presses, undeformed
    double effector_radius_m = 0.0;
    double rate_Hz = 0.0;   // of the loop
    std::string rendered;   // where TangibleMoment::rendered_N comes from: "model", "plant" or "force sensor"
    std::string algorithm;  // fidelity of the inverse problem: "step", "converged", "stale" or "linear"
};

// The deformed device, less often than the moment.
struct TangibleShape {
    std::array<PointOfDevice, kMostTangibleNodes> node_m{};  // the first TangibleBody::rest_m.size() count
};

struct TangibleMoment {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    using Actuators = std::array<double, kMostTangibleActuators>;

    double time_s = 0.0;          // on the loop's clock
    double depth_m = 0.0;         // of the finger into the device, from the rest height on
    double world_depth_m = 0.0;   // the same into the virtual tissue (depth_scale)
    double wanted_N = 0.0;        // force of the virtual tissue on the finger
    double rendered_N = kNone;    // force with which the device pushes back; TangibleBody::rendered says by whom
    double proxy_m = 0.0;         // depth of the god-object, which stays on the surface of the virtual tissue
    double next_stiffness = 0.0;  // slope of the wanted force over depth, N/m
    bool pressed = false;

    // The inverse problem of this tick, term by term, along the direction of the finger (m):
    // residual_m = gap_m + by_actuators_m.
    double gap_m = 0.0;  // of the effector at the finger's new depth and force, linearised, with the actuators at zero
    double by_actuators_m = 0.0;  // W times the whole actuation
    Actuators compliance{};       // row of W: m/N, or m/Pa
    double residual_m = 0.0;      // what the actuators cannot close
    std::int32_t rank = 0;
    std::uint32_t active = 0;      // bit k: actuator k stands at a limit
    std::int32_t limited_by = -1;  // index of the actuator that keeps the gap open; -1: none
    std::int32_t iterations = 0;
    bool converged = true;

    Actuators actuation{};  // N or Pa
    Actuators length{};     // m, of cables

    const char* fault = "";  // static text: why the device is relaxed or its last command held; "" if it is driven
    bool held = false;       // the last valid command is repeated
    bool stopped = false;    // F12, or another fault that stays until a person releases it

    double period_p50_s = kNone;  // time between two ticks
    double period_p99_s = kNone;
    double step_p50_s = kNone;  // time of one tick's computation
    double step_p99_s = kNone;
    std::int64_t ticks = 0;
    std::int64_t missed_ticks = 0;
    std::int64_t saturated_ticks = 0;
    double held_s = 0.0;               // in all
    double force_rms_percent = kNone;  // rendered minus wanted so far, against the greatest wanted force
};

// True while each drive has its relaxed value, which the device file names.
inline bool is_relaxed(const TangibleMoment& moment) {
    return moment.stopped || (*moment.fault != '\0' && !moment.held);
}

}  // namespace palpa::session
