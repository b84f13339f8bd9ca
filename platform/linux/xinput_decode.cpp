#include "platform/linux/xinput_decode.h"

#include <algorithm>
#include <numbers>
#include <utility>

namespace palpa::platform {
namespace {

bool bit_set(std::span<const unsigned char> mask, int bit) {
    const auto byte = static_cast<std::size_t>(bit) / 8;
    return bit >= 0 && byte < mask.size() && ((mask[byte] >> (bit % 8)) & 1) != 0;
}

double last_value(const Axis& axis, const AxisValues& values) {
    const auto value = values.find(axis.number);
    return axis.number >= 0 && value != values.end() ? value->second : kMissing;
}

double fraction(const Axis& axis, double value) {
    return axis.hi > axis.lo ? (value - axis.lo) / (axis.hi - axis.lo) : kMissing;
}

double screen_px(const Axis& axis, double value, double screen_size_px) {
    return (value - axis.lo) / (axis.hi - axis.lo + 1.0) * screen_size_px;
}

// Drivers either report whole degrees or, as the kernel does, counts per radian.
double tilt_deg(const Axis& axis, double value) {
    if (axis.lo >= -90.0 && axis.hi <= 90.0) return value;
    return axis.resolution > 0.0 ? value / axis.resolution * 180.0 / std::numbers::pi : kMissing;
}

void keep_axes(const XiEvent& event, AxisValues& values) {
    std::size_t next = 0;
    for (int axis = 0; axis < static_cast<int>(event.mask.size()) * 8; ++axis) {
        if (!bit_set(event.mask, axis)) continue;
        if (next == event.values.size()) return;
        values[axis] = event.values[next++];
    }
}

bool usable(const Axis& axis, const AxisValues& values) { return values.contains(axis.number) && axis.hi > axis.lo; }

void fill(const XiDevice& device, const XiEvent& event, const AxisValues& values, const XiState& state,
          Sample& sample) {
    const bool by_axes = usable(device.x, values) && usable(device.y, values);
    const double x = last_value(device.x, values);
    const double y = last_value(device.y, values);
    sample.x_px = by_axes ? screen_px(device.x, x, state.screen_width_px) - event.origin_x_px : event.event_x_px;
    sample.y_px = by_axes ? screen_px(device.y, y, state.screen_height_px) - event.origin_y_px : event.event_y_px;

    sample.pressure_raw = last_value(device.pressure, values);
    sample.pressure = fraction(device.pressure, sample.pressure_raw);
    sample.tilt_x_deg = tilt_deg(device.tilt_x, last_value(device.tilt_x, values));
    sample.tilt_y_deg = tilt_deg(device.tilt_y, last_value(device.tilt_y, values));

    // the ellipse is in units of the position axes; without a minor axis it is a circle
    const double px_per_count_x = state.screen_width_px / (device.x.hi - device.x.lo + 1.0);
    const double px_per_count_y = state.screen_height_px / (device.y.hi - device.y.lo + 1.0);
    const double major = last_value(device.touch_major, values);
    const bool has_minor = values.contains(device.touch_minor.number);
    sample.width_px = major * px_per_count_x;
    sample.height_px = (has_minor ? last_value(device.touch_minor, values) : major) * px_per_count_y;
}

std::optional<Phase> pen_phase(const XiEvent& event, bool& tip_down) {
    if (event.kind == XiKind::motion) {
        if (!tip_down) return Phase::hover;
        if (event.tip_held) return Phase::move;
        tip_down = false;  // another program grabbed the pen and got its release
        return Phase::cancel;
    }
    if (event.detail != 1) return std::nullopt;
    if (event.kind == XiKind::press) {
        tip_down = true;
        return Phase::down;
    }
    if (!std::exchange(tip_down, false)) return std::nullopt;
    return Phase::up;
}

std::optional<Sample> decode_pen(const XiDevice& device, const XiEvent& event, XiState& state) {
    if (event.device_id != event.source_id || event.kind > XiKind::release) return std::nullopt;
    AxisValues& values = state.pens[device.id];
    keep_axes(event, values);
    const auto phase = pen_phase(event, state.pen_tip_down[device.id]);
    if (!phase) return std::nullopt;

    Sample sample;
    sample.pointer_id = pen_pointer_id(device.id);
    sample.tool = Tool::pen;
    sample.phase = *phase;
    fill(device, event, values, state, sample);
    return sample;
}

std::optional<Sample> decode_touch(const XiDevice& device, const XiEvent& event, XiState& state) {
    if (event.device_id == event.source_id || event.kind < XiKind::touch_begin) return std::nullopt;
    if (event.kind == XiKind::touch_begin) {
        state.touches[event.detail].clear();
        state.touch_device[event.detail] = device.id;
    }
    const auto touch = state.touches.find(event.detail);
    if (touch == state.touches.end()) return std::nullopt;
    keep_axes(event, touch->second);

    Sample sample;
    sample.pointer_id = event.detail;
    sample.tool = Tool::finger;
    sample.phase = event.kind == XiKind::touch_begin ? Phase::down : Phase::move;
    fill(device, event, touch->second, state, sample);
    if (event.kind == XiKind::touch_end) {
        sample.phase = Phase::up;
        state.touches.erase(touch);
        state.touch_device.erase(event.detail);
    }
    return sample;
}

}  // namespace

Tool tool_of_device(bool has_touch_class, bool has_pen_pressure) {
    if (has_touch_class) return Tool::finger;
    return has_pen_pressure ? Tool::pen : Tool::mouse;
}

const XiDevice* find_device(const XiState& state, int id) {
    const auto device = std::find_if(state.devices.begin(), state.devices.end(),
                                     [&](const XiDevice& candidate) { return candidate.id == id; });
    return device == state.devices.end() ? nullptr : &*device;
}

std::int64_t pen_pointer_id(int device_id) { return -static_cast<std::int64_t>(device_id); }

std::optional<Sample> decode(const XiEvent& event, double t_host_s, XiState& state) {
    const double t_device_s = 1e-3 * unwrap_ms(event.time_ms, state.clock);
    const XiDevice* device = find_device(state, event.source_id);
    if (device == nullptr || device->tool == Tool::mouse) return std::nullopt;
    auto sample = device->tool == Tool::pen ? decode_pen(*device, event, state) : decode_touch(*device, event, state);
    if (sample) {
        sample->t_host_s = t_host_s;
        sample->t_device_s = t_device_s;
    }
    return sample;
}

std::vector<std::int64_t> replace_devices(std::vector<XiDevice> devices, XiState& state) {
    std::vector<std::int64_t> gone;
    state.devices = std::move(devices);
    std::erase_if(state.pens, [&](const auto& pen) {
        if (find_device(state, pen.first) != nullptr) return false;
        gone.push_back(pen_pointer_id(pen.first));
        state.pen_tip_down.erase(pen.first);
        return true;
    });
    std::erase_if(state.touch_device, [&](const auto& touch) {
        if (find_device(state, touch.second) != nullptr) return false;
        gone.push_back(touch.first);
        state.touches.erase(touch.first);
        return true;
    });
    return gone;
}

}  // namespace palpa::platform
