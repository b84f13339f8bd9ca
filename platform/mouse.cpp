#include "platform/mouse.h"

namespace palpa::platform {
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
    sample.pressure = mouse.button.down ? pressure_at(mouse.button, t_host_s) : 0.0;
    return sample;
}

}  // namespace

void hold_mouse(double t_host_s, Mouse& mouse, std::vector<Sample>& out) {
    if (!mouse.button.down) return;
    const std::int64_t now = last_grid_point(t_host_s);
    for (std::int64_t tick = first_grid_point(mouse.last_tick, now); tick <= now; ++tick) {
        out.push_back(mouse_sample(mouse, grid_time_s(tick), kMissing, Phase::move));
        mouse.last_tick = tick;
    }
}

void move_mouse(double t_host_s, double t_device_s, double x_px, double y_px, Mouse& mouse, std::vector<Sample>& out) {
    mouse.x_px = x_px;
    mouse.y_px = y_px;
    const Phase phase = mouse.button.down ? Phase::move : Phase::hover;
    out.push_back(mouse_sample(mouse, t_host_s, t_device_s, phase));
}

void press_mouse(double t_host_s, double t_device_s, Mouse& mouse, std::vector<Sample>& out) {
    mouse.button.down = true;
    mouse.button.down_s = t_host_s;
    mouse.last_tick = last_grid_point(t_host_s);
    out.push_back(mouse_sample(mouse, t_host_s, t_device_s, Phase::down));
}

void release_mouse(double t_host_s, double t_device_s, Mouse& mouse, std::vector<Sample>& out) {
    if (!mouse.button.down) return;
    mouse.button.down = false;
    out.push_back(mouse_sample(mouse, t_host_s, t_device_s, Phase::up));
}

void turn_wheel(double t_host_s, double t_device_s, double notches, Mouse& mouse, std::vector<Sample>& out) {
    turn_level(t_host_s, notches, mouse.button);
    if (mouse.button.down) out.push_back(mouse_sample(mouse, t_host_s, t_device_s, Phase::move));
}

}  // namespace palpa::platform
