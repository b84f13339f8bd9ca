#include "platform/linux/xinput.h"

#include <SDL.h>
#include <SDL_syswm.h>
#include <X11/Xlib.h>
#include <X11/extensions/XInput2.h>
#include <array>
#include <cmath>
#include <ctime>
#include <poll.h>
#include <string_view>
#include <utility>

namespace palpa::platform {
namespace {

using EventMask = std::array<unsigned char, XIMaskLen(XI_LASTEVENT)>;

void set_bit(EventMask& mask, int event) {
    auto& byte = mask[static_cast<std::size_t>(event) / 8];
    byte = static_cast<unsigned char>(byte | (1u << (event % 8)));
}

void select_events(const XInput& xinput, int device_id, EventMask mask) {
    XIEventMask selection{device_id, static_cast<int>(mask.size()), mask.data()};
    XISelectEvents(xinput.display, xinput.window, &selection, 1);
}

int ignore_error(Display*, XErrorEvent*) { return 0; }

// Selects the events of each pen and mouse. A device may be unplugged between the list and the request, for which Xlib
// would end the program, so errors are ignored here.
void select_device_events(const XInput& xinput) {
    EventMask mask{};
    for (const int event : {XI_Motion, XI_ButtonPress, XI_ButtonRelease}) set_bit(mask, event);
    XSync(xinput.display, False);
    const auto previous = XSetErrorHandler(ignore_error);
    for (const XiDevice& device : xinput.state.devices) {
        if (device.tool != Tool::finger) select_events(xinput, device.id, mask);
    }
    XSync(xinput.display, False);
    XSetErrorHandler(previous);
}

std::string label_of(Display* display, Atom label) {
    if (label == None) return {};
    char* name = XGetAtomName(display, label);
    std::string text = name != nullptr ? name : "";
    XFree(name);
    return text;
}

Axis axis_of(const XIValuatorClassInfo& valuator) {
    return {valuator.number, valuator.min, valuator.max, static_cast<double>(valuator.resolution)};
}

void add_axis(const XIValuatorClassInfo& valuator, std::string_view label, XiDevice& device) {
    const Axis axis = axis_of(valuator);
    const bool absolute = valuator.mode == XIModeAbsolute;
    if (axis.number == 0 && absolute) device.x = axis;
    if (axis.number == 1 && absolute) device.y = axis;
    if (label == "Abs Pressure" || label == "Abs MT Pressure") device.pressure = axis;
    if (label == "Abs Tilt X") device.tilt_x = axis;
    if (label == "Abs Tilt Y") device.tilt_y = axis;
    if (label == "Abs MT Touch Major") device.touch_major = axis;
    if (label == "Abs MT Touch Minor") device.touch_minor = axis;
}

XiDevice describe(Display* display, const XIDeviceInfo& info) {
    XiDevice device;
    device.id = info.deviceid;
    device.name = info.name;
    bool touch_class = false;
    bool pen_pressure = false;
    for (int i = 0; i < info.num_classes; ++i) {
        const XIAnyClassInfo* any = info.classes[i];
        touch_class |= any->type == XITouchClass;
        if (any->type != XIValuatorClass) continue;
        const auto& valuator = *reinterpret_cast<const XIValuatorClassInfo*>(any);
        const std::string label = label_of(display, valuator.label);
        pen_pressure |= label == "Abs Pressure";
        add_axis(valuator, label, device);
        device.axes.push_back(label);
    }
    device.tool = tool_of_device(touch_class, pen_pressure);
    return device;
}

std::vector<XiDevice> list_devices(Display* display) {
    std::vector<XiDevice> devices;
    int count = 0;
    XIDeviceInfo* infos = XIQueryDevice(display, XIAllDevices, &count);
    for (int i = 0; i < count; ++i) {
        const bool pointer = infos[i].use == XISlavePointer || infos[i].use == XIFloatingSlave;
        if (pointer && infos[i].enabled) devices.push_back(describe(display, infos[i]));
    }
    if (infos != nullptr) XIFreeDeviceInfo(infos);
    return devices;
}

std::optional<XiKind> kind_of(int evtype) {
    switch (evtype) {
        case XI_Motion:
            return XiKind::motion;
        case XI_ButtonPress:
            return XiKind::press;
        case XI_ButtonRelease:
            return XiKind::release;
        case XI_TouchBegin:
            return XiKind::touch_begin;
        case XI_TouchUpdate:
            return XiKind::touch_update;
        case XI_TouchEnd:
            return XiKind::touch_end;
        default:
            return std::nullopt;
    }
}

std::size_t count_bits(std::span<const unsigned char> mask) {
    std::size_t count = 0;
    for (const unsigned char byte : mask) count += static_cast<std::size_t>(__builtin_popcount(byte));
    return count;
}

XiEvent plain_event(XiKind kind, const XIDeviceEvent& device_event) {
    XiEvent event;
    event.kind = kind;
    event.device_id = device_event.deviceid;
    event.source_id = device_event.sourceid;
    event.detail = device_event.detail;
    event.time_ms = static_cast<std::uint32_t>(device_event.time);
    event.origin_x_px = device_event.root_x - device_event.event_x;
    event.origin_y_px = device_event.root_y - device_event.event_y;
    event.event_x_px = device_event.event_x;
    event.event_y_px = device_event.event_y;
    event.tip_held = device_event.buttons.mask_len > 0 && (device_event.buttons.mask[0] & (1 << 1)) != 0;
    const XIValuatorState& valuators = device_event.valuators;
    event.mask = {valuators.mask, static_cast<std::size_t>(valuators.mask_len)};
    event.values = {valuators.values, count_bits(event.mask)};
    return event;
}

}  // namespace

bool window_managed(SDL_Window* window) {
    SDL_SysWMinfo info;
    SDL_VERSION(&info.version);
    if (SDL_GetWindowWMInfo(window, &info) != SDL_TRUE || info.subsystem != SDL_SYSWM_X11) return true;
    Display* display = info.info.x11.display;
    const Atom check = XInternAtom(display, "_NET_SUPPORTING_WM_CHECK", True);
    if (check == None) return false;
    Atom type = None;
    int format = 0;
    unsigned long count = 0, left = 0;
    unsigned char* manager = nullptr;
    XGetWindowProperty(display, DefaultRootWindow(display), check, 0, 1, False, AnyPropertyType, &type, &format, &count,
                       &left, &manager);
    if (manager != nullptr) XFree(manager);
    return count > 0;
}

std::optional<XInput> open_xinput(SDL_Window* window) {
    SDL_SysWMinfo info;
    SDL_VERSION(&info.version);
    if (SDL_GetWindowWMInfo(window, &info) == SDL_FALSE || info.subsystem != SDL_SYSWM_X11) return std::nullopt;

    XInput xinput;
    xinput.display = info.info.x11.display;
    xinput.window = info.info.x11.window;
    int first_event = 0;
    int first_error = 0;
    if (XQueryExtension(xinput.display, "XInputExtension", &xinput.opcode, &first_event, &first_error) == False) {
        return std::nullopt;
    }
    // on our window, since a second selection on the root window would undo SDL's
    EventMask mask{};
    set_bit(mask, XI_HierarchyChanged);
    set_bit(mask, XI_DeviceChanged);
    select_events(xinput, XIAllDevices, mask);
    rescan(xinput);
    return xinput;
}

XiNews read_event(const XInput& xinput, const SDL_Event& event, XiEvent& out) {
    if (event.type != SDL_SYSWMEVENT || event.syswm.msg->subsystem != SDL_SYSWM_X11) return XiNews::none;
    const XGenericEventCookie& cookie = event.syswm.msg->msg.x11.event.xcookie;
    if (cookie.type != GenericEvent || cookie.extension != xinput.opcode || cookie.data == nullptr) {
        return XiNews::none;
    }
    if (cookie.evtype == XI_HierarchyChanged) return XiNews::devices_changed;
    if (cookie.evtype == XI_DeviceChanged) {
        // the master pointer also changes each time another device moves it, which is ignored
        const bool changed = static_cast<const XIDeviceChangedEvent*>(cookie.data)->reason == XIDeviceChange;
        return changed ? XiNews::devices_changed : XiNews::none;
    }
    const auto kind = kind_of(cookie.evtype);
    if (!kind) return XiNews::none;
    const auto& device_event = *static_cast<const XIDeviceEvent*>(cookie.data);
    if (device_event.event != xinput.window) return XiNews::none;
    out = plain_event(*kind, device_event);
    return XiNews::event;
}

void wait_for_server(const XInput& xinput, double wait_s) {
    if (XEventsQueued(xinput.display, QueuedAfterFlush) > 0) return;
    pollfd server{ConnectionNumber(xinput.display), POLLIN, 0};
    const auto wait_ns = static_cast<long>(1e9 * (wait_s - std::floor(wait_s)));
    const timespec limit{static_cast<time_t>(wait_s), wait_ns};
    ppoll(&server, 1, &limit, nullptr);
}

std::vector<std::int64_t> rescan(XInput& xinput) {
    XWindowAttributes root;
    if (XGetWindowAttributes(xinput.display, DefaultRootWindow(xinput.display), &root) != 0) {
        xinput.state.screen_width_px = root.width;
        xinput.state.screen_height_px = root.height;
    }
    auto gone = replace_devices(list_devices(xinput.display), xinput.state);
    select_device_events(xinput);
    return gone;
}

}  // namespace palpa::platform
