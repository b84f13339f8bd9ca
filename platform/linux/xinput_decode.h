#pragma once
// Converts XInput2 events to samples. This part needs no X server.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "platform/sample.h"
#include "platform/sample_clock.h"

namespace palpa::platform {

// One axis ("valuator") of a device. number -1: the device has no such axis.
struct Axis {
    int number = -1;
    double lo = 0.0;          // counts
    double hi = 0.0;          // counts
    double resolution = 0.0;  // tilt: counts per radian, 0 = unknown
};

struct XiDevice {
    int id = 0;
    std::string name;
    Tool tool = Tool::mouse;
    Axis x, y;  // absolute axes only
    Axis pressure, tilt_x, tilt_y;
    Axis touch_major, touch_minor;
    std::vector<std::string> axes{};  // labels of all axes
};

// A device with a touch class is a touch screen, whatever else it has; one with "Abs Pressure" is a pen; all others
// are mice.
Tool tool_of_device(bool has_touch_class, bool has_pen_pressure);

enum class XiKind : std::uint8_t { motion, press, release, touch_begin, touch_update, touch_end };

// An XIDeviceEvent without its X types.
struct XiEvent {
    XiKind kind = XiKind::motion;
    int device_id = 0;          // the recipient: the device itself or the master pointer
    int source_id = 0;          // the device that caused it
    int detail = 0;             // button, or touch id
    std::uint32_t time_ms = 0;  // X server clock
    double origin_x_px = 0.0;   // of the window on the screen
    double origin_y_px = 0.0;
    double event_x_px = 0.0;  // in the window; one sample late in events of the device itself
    double event_y_px = 0.0;
    bool tip_held = false;                // button 1 was down before this event
    std::span<const unsigned char> mask;  // bit k set: axis k has a value
    std::span<const double> values;       // of the set bits, in their order
};

// The last values of axes. An axis that an event does not carry has not changed, so its last value is kept: per device
// for pens, per touch for fingers.
using AxisValues = std::map<int, double>;

struct XiState {
    std::vector<XiDevice> devices;
    double screen_width_px = 0.0;
    double screen_height_px = 0.0;
    UnwrapState clock;
    std::map<int, AxisValues> pens;     // by device
    std::map<int, bool> pen_tip_down;   // by device
    std::map<int, AxisValues> touches;  // by touch id
    std::map<int, int> touch_device;    // by touch id
};

const XiDevice* find_device(const XiState& state, int id);

std::int64_t pen_pointer_id(int device_id);

// Returns the sample of one event of a pen or a finger; nothing for mice, for a pen's other buttons, and for the copy
// of a pen's event that the master pointer sends.
//
//   x_px = (v - lo) / (hi - lo + 1) * screen_width_px - origin_x_px      pressure = (p - lo) / (hi - lo)
//
// The formula of x_px is the one by which the X server itself maps an absolute axis on the screen; axes are finer than
// event_x_px.
std::optional<Sample> decode(const XiEvent& event, double t_host_s, XiState& state);

// Replaces the device list. Returns the pointer ids of pens and touches that went with their device.
std::vector<std::int64_t> replace_devices(std::vector<XiDevice> devices, XiState& state);

}  // namespace palpa::platform
