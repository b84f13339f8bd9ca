#include "platform/mouse.h"

#include <algorithm>
#include <cmath>

namespace palpa {
namespace {

Sample mouse_sample(const Mouse& mouse, double t_host_s, double t_device_s, Phase phase) {
    Sample sample;
    sample.t_host_s = t_host_s;
    sample.t_device_s = t_device_s;
    sample.pointer_id = kMousePointerId;
    sample.tool = Tool::mouse;
    sample.phase = phase;
    sample.x_px = mouse.x_px;
    sample.y_px = mouse.y_px;
    sample.pressure = mouse.down ? mouse_pressure(mouse, t_host_s) : 0.0;
    return sample;
}

std::int64_t tick_at(double t_host_s) {
    return static_cast<std::int64_t>(std::floor(t_host_s * kMouseGrid_Hz));
}

}  // namespace

double mouse_pressure(const Mouse& mouse, double t_host_s) {
    if (mouse.by_wheel) return mouse.wheel_level;
    if (!mouse.down) return 0.0;
    if (mouse.hold_s <= 0.0) return 1.0;
    return std::clamp((t_host_s - mouse.down_s) / mouse.hold_s, 0.0, 1.0);
}

void hold_mouse(double t_host_s, Mouse& mouse, std::vector<Sample>& out) {
    if (!mouse.down) return;
    for (const std::int64_t now = tick_at(t_host_s); mouse.last_tick < now;) {
        ++mouse.last_tick;
        const double tick_s = static_cast<double>(mouse.last_tick) / kMouseGrid_Hz;
        out.push_back(mouse_sample(mouse, tick_s, kMissing, Phase::move));
    }
}

void move_mouse(double t_host_s, double t_device_s, double x_px, double y_px, Mouse& mouse,
                std::vector<Sample>& out) {
    mouse.x_px = x_px;
    mouse.y_px = y_px;
    out.push_back(mouse_sample(mouse, t_host_s, t_device_s, mouse.down ? Phase::move : Phase::hover));
}

void press_mouse(double t_host_s, double t_device_s, Mouse& mouse, std::vector<Sample>& out) {
    mouse.down = true;
    mouse.down_s = t_host_s;
    mouse.last_tick = tick_at(t_host_s);
    out.push_back(mouse_sample(mouse, t_host_s, t_device_s, Phase::down));
}

void release_mouse(double t_host_s, double t_device_s, Mouse& mouse, std::vector<Sample>& out) {
    if (!mouse.down) return;
    mouse.down = false;
    out.push_back(mouse_sample(mouse, t_host_s, t_device_s, Phase::up));
}

void turn_wheel(double t_host_s, double t_device_s, double notches, Mouse& mouse, std::vector<Sample>& out) {
    // a wheel turned during a press goes on from the pressure that holding has reached
    const double level = mouse_pressure(mouse, t_host_s) + kWheelStep * notches;
    mouse.wheel_level = std::clamp(level, 0.0, 1.0);
    mouse.by_wheel = mouse.down || mouse.wheel_level > 0.0;
    if (mouse.down) out.push_back(mouse_sample(mouse, t_host_s, t_device_s, Phase::move));
}

}  // namespace palpa
