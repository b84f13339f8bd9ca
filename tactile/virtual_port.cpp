#include "tactile/virtual_port.h"

#include <algorithm>
#include <utility>

#include "devices/pin_line.h"

namespace palpa::tactile {
namespace {

using namespace devices::simulators;

void read_heights(const MaestroBoards& boards, std::vector<double>& height_m) {
    for (std::size_t i = 0; i < height_m.size(); ++i) height_m[i] = boards.pin[i].height_m;
}

}  // namespace

VirtualPort::VirtualPort(const TactilePlan& plan, std::vector<devices::PressRow> press, std::uint64_t seed)
    : guarded(guarded_of(plan)) {
    const double begin_s = press.empty() ? 0.0 : press.front().t_s;
    if (plan.arm) arm = make_arm_plant(arm_parameters(seed), std::move(press), seed);
    if (!plan.pin_device) return;
    MaestroSettings settings;
    settings.timeout_s = plan.pin_device->timeout_s;
    settings.pin_speed_m_per_s = plan.pin_device->speed_m_per_s;
    boards = make_maestro_boards(*plan.pin_device, settings, 0.0, seed);
    if (plan.pin_device->detect_baud) take_bytes({&devices::kMaestroBaudByte, 1}, *boards);
    period_s = devices::write_period_s(*plan.pin_device);
    frame_due_s = begin_s + 0.5 * period_s;  // boards keep a time of their own: half a period apart on average
    height_m.resize(boards->pin.size());
    read_heights(*boards, height_m);
}

bool VirtualPort::read(LoopFeedback& feedback) noexcept {
    if (arm) newest = devices::simulators::feedback(*arm);
    feedback.arm = newest;
    return true;
}

void VirtualPort::send(double now_s, const LoopCommand& command) {
    sent = command;
    guard_command(now_s, true, arm ? &newest : nullptr, found, sent, guarded);
    if (arm) devices::simulators::command(sent.arm, *arm);
    if (!boards || now_s < frame_due_s) return;
    frame_due_s = now_s + period_s - 1e-6;
    devices::pin_frame(boards->device, {sent.pins_m.data(), static_cast<std::size_t>(sent.pins)}, frame);
    take_bytes(frame.view(), *boards);
    if (std::any_of(boards->out.begin(), boards->out.end(), [](std::uint8_t byte) { return byte != 0; }))
        found = devices::Fault::board_error;
    boards->out.clear();
}

void VirtualPort::advance(double dt_s) {
    if (arm) devices::simulators::advance(dt_s, *arm);
    if (!boards) return;
    devices::simulators::advance(dt_s, *boards);
    read_heights(*boards, height_m);
}

}  // namespace palpa::tactile
