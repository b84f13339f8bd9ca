#include "platform/press.h"

#include <algorithm>

namespace palpa::platform {
namespace {

auto find(Presses& presses, std::int64_t pointer_id) {
    return std::find_if(presses.held.begin(), presses.held.end(),
                        [&](const Press& press) { return press.last.pointer_id == pointer_id; });
}

void cancel(double t_host_s, Press& press, PressureWatch& pressure, std::vector<Sample>& out) {
    Sample sample = press.last;
    sample.t_host_s = t_host_s;
    sample.t_device_s = kMissing;  // no device sent it
    sample.phase = Phase::cancel;
    watch(sample, pressure);
    if (press.owner == PressOwner::tissue) out.push_back(sample);
    press.owner = PressOwner::nobody;
}

}  // namespace

void admit(const Sample& sample, PressOwner down_owner, Presses& presses, std::vector<Sample>& out) {
    auto press = find(presses, sample.pointer_id);
    const bool known = press != presses.held.end();

    if (sample.phase == Phase::down) {
        if (known) {  // its up was lost
            cancel(sample.t_host_s, *press, presses.pressure, out);
            presses.held.erase(press);
        }
        watch(sample, presses.pressure);
        presses.held.push_back({down_owner, sample});
        if (down_owner == PressOwner::tissue) out.push_back(sample);
        return;
    }
    if (sample.phase == Phase::hover) {
        if (known) {
            cancel(sample.t_host_s, *press, presses.pressure, out);
            presses.held.erase(press);
        }
        out.push_back(sample);
        return;
    }
    if (!known) return;
    watch(sample, presses.pressure);
    press->last = sample;
    if (press->owner == PressOwner::tissue) out.push_back(sample);
    if (sample.phase != Phase::move) presses.held.erase(press);
}

void cancel_all(double t_host_s, Presses& presses, std::vector<Sample>& out) {
    for (Press& press : presses.held) cancel(t_host_s, press, presses.pressure, out);
}

void cancel_gone(double t_host_s, std::int64_t pointer_id, Presses& presses, std::vector<Sample>& out) {
    const auto press = find(presses, pointer_id);
    if (press == presses.held.end()) return;
    cancel(t_host_s, *press, presses.pressure, out);
    presses.held.erase(press);
}

bool presses_tissue(const Presses& presses, std::int64_t pointer_id) {
    return std::any_of(presses.held.begin(), presses.held.end(), [&](const Press& press) {
        return press.last.pointer_id == pointer_id && press.owner == PressOwner::tissue;
    });
}

}  // namespace palpa::platform
