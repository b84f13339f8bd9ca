#pragma once
// The devices of a plan in one process, in the loop's own time: the models behind the programs arm_simulator and
// maestro_simulator. Commands pass the same guard as those to real devices, and the pins get the same bytes.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "devices/simulators/arm_plant.h"
#include "devices/simulators/maestro_board.h"
#include "tactile/device_port.h"

namespace palpa::tactile {

// `press` moves the simulated hand on the arm.
struct VirtualPort {
    VirtualPort(const TactilePlan& plan, std::vector<devices::PressRow> press, std::uint64_t seed);

    bool read(LoopFeedback& feedback) noexcept;  // always true
    void send(double now_s, const LoopCommand& command);
    void advance(double dt_s);  // by whole milliseconds

    std::optional<devices::simulators::ArmPlant> arm;
    std::optional<devices::simulators::MaestroBoards> boards;
    std::vector<double> height_m;  // of the pins, true; empty without pins
    Guarded guarded;
    LoopCommand sent;  // what the guard let pass last
    devices::PinFrame frame{};
    devices::ArmFeedback newest;
    devices::Fault found = devices::Fault::none;
    double period_s = 0.02;  // from one set of targets to the next
    double frame_due_s = 0.0;
};

}  // namespace palpa::tactile
