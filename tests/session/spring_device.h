#pragma once
// A made-up device: a motor that moves a plate, and holds it to the pen's contact by a spring and a damper.

#include "session/device_rows.h"

namespace palpa::test {

struct SpringDevice {
    struct Plan {
        double stiffness_N_per_m = 400.0;
        double damping_Ns_per_m = 3.0;
        double smoothing = 0.1;  // of the velocity, per row
    };
    struct Feedback {
        double position_m = 0.0;
    };
    struct Command {
        double force_N = 0.0;
    };
    struct State {
        double time_s = 0.0;
        double position_m = 0.0;
        double velocity_m_per_s = 0.0;
        bool started = false;
    };

    static Command command(const Plan& plan, const session::DeviceInput<Feedback>& in, State& state) noexcept {
        const double elapsed_s = in.time_s - state.time_s;
        if (state.started && elapsed_s > 0.0) {
            const double raw_m_per_s = (in.feedback.position_m - state.position_m) / elapsed_s;
            state.velocity_m_per_s += plan.smoothing * (raw_m_per_s - state.velocity_m_per_s);
        }
        state.started = true;
        state.time_s = in.time_s;
        state.position_m = in.feedback.position_m;
        return {plan.stiffness_N_per_m * (in.pen.depth_m - in.feedback.position_m) + 0.1 * in.pen.normal_N -
                plan.damping_Ns_per_m * state.velocity_m_per_s};
    }
};

template <class Row, class Visit>
requires std::same_as<std::remove_const_t<Row>, SpringDevice::Feedback>
void visit_fields(Row& row, Visit&& visit) { visit("position_m", row.position_m); }

template <class Row, class Visit>
requires std::same_as<std::remove_const_t<Row>, SpringDevice::Command>
void visit_fields(Row& row, Visit&& visit) { visit("force_N", row.force_N); }

// The plate: a mass that the force moves, and what was sent to it.
struct SpringPort {
    double mass_kg = 0.05;
    double position_m = 0.0;
    double velocity_m_per_s = 0.0;
    double force_N = 0.0;
    bool silent = false;
    std::vector<double> sent_N{};

    bool read(SpringDevice::Feedback& feedback) noexcept {
        constexpr double kPeriod_s = 1e-3;
        velocity_m_per_s += kPeriod_s / mass_kg * force_N;
        position_m += kPeriod_s * velocity_m_per_s;
        feedback.position_m = position_m;
        return !silent;
    }
    void send(const SpringDevice::Command& command) noexcept {
        force_N = command.force_N;
        if (sent_N.size() < sent_N.capacity()) sent_N.push_back(force_N);
    }
};

}  // namespace palpa::test
