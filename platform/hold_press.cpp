#include "platform/hold_press.h"

#include <algorithm>

#include "platform/held_pressure.h"

namespace palpa::platform {
namespace {

bool chosen(const HoldPress& hold, Tool tool) {
    return (tool == Tool::pen && hold.pen) || (tool == Tool::finger && hold.finger);
}

void press_on(double to_s, HoldPress& hold) {
    const std::int64_t now = last_grid_point(to_s);
    if (!hold.held.empty()) {
        for (std::int64_t tick = first_grid_point(hold.last_tick, now); tick <= now; ++tick) {
            const double tick_s = grid_time_s(tick);
            for (HeldPointer& pointer : hold.held) {
                if (pointer.last.t_host_s > grid_time_s(tick - 1)) continue;
                pointer.last.t_host_s = tick_s;
                pointer.last.t_device_s = kMissing;
                pointer.last.phase = Phase::move;
                pointer.last.pressure = held_share(tick_s - pointer.down_s, hold.hold_s);
                hold.merged.push_back(pointer.last);
            }
        }
    }
    hold.last_tick = std::max(hold.last_tick, now);
}

void take(Sample sample, HoldPress& hold) {
    if (sample.phase == Phase::ui || !chosen(hold, sample.tool)) {
        hold.merged.push_back(sample);
        return;
    }
    auto pointer = std::find_if(hold.held.begin(), hold.held.end(),
                                [&](const HeldPointer& other) { return other.last.pointer_id == sample.pointer_id; });
    if (sample.phase != Phase::down && sample.phase != Phase::move) {
        if (pointer != hold.held.end()) hold.held.erase(pointer);
        hold.merged.push_back(sample);
        return;
    }
    if (pointer == hold.held.end()) pointer = hold.held.insert(pointer, HeldPointer{sample.t_host_s, sample});
    if (sample.phase == Phase::down) pointer->down_s = sample.t_host_s;
    sample.pressure = held_share(sample.t_host_s - pointer->down_s, hold.hold_s);
    pointer->last = sample;
    hold.merged.push_back(sample);
}

}  // namespace

void press_by_hold(double now_s, HoldPress& hold, std::vector<Sample>& samples) {
    std::erase_if(hold.held, [&](const HeldPointer& pointer) { return !chosen(hold, pointer.last.tool); });
    hold.merged.clear();
    for (const Sample& sample : samples) {
        press_on(sample.t_host_s, hold);
        take(sample, hold);
    }
    press_on(now_s, hold);
    samples.swap(hold.merged);
}

}  // namespace palpa::platform
