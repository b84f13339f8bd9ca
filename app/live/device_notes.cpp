// What the app tells the person about pens, fingers and mice while it runs.

#include <algorithm>
#include <string>
#include <string_view>

#include "app/live/live_app.h"
#include "app/screens/words.h"

namespace palpa::app {
namespace {

bool named(const std::vector<platform::PointerDevice>& devices, const std::string& name) {
    return std::any_of(devices.begin(), devices.end(),
                       [&](const platform::PointerDevice& d) { return d.name == name; });
}

// Notes devices that are plugged in or out while the app runs.
void note_changes(const std::vector<platform::PointerDevice>& now, Notices& notices) {
    for (const platform::PointerDevice& device : notices.devices) {
        if (!named(now, device.name)) notices.note = words::filled(words::kDisconnected, {device.name});
    }
    for (const platform::PointerDevice& device : now) {
        if (!notices.devices.empty() && !named(notices.devices, device.name))
            notices.note = words::filled(words::kConnected, {device.name});
    }
}

// Notes a pen or finger that touches without a true pressure, and offers another way to press.
void note_pressure(platform::Tool tool, App& app) {
    const platform::PressureKind kind = platform::pressure_kind(app.pressure, tool);
    const bool held = tool == platform::Tool::pen ? app.hold.pen : app.hold.finger;
    const std::string name(name_of(tool));
    if (held) app.notices.pressure_notes.push_back(words::filled(words::kHeldPress, {name}));
    if (held || (kind != platform::PressureKind::constant && kind != platform::PressureKind::missing)) return;
    const char* found = kind == platform::PressureKind::missing ? words::kReportsNone : words::kReportsConstant;
    app.notices.pressure_notes.push_back(words::filled(found, {name}));
    // a profile of counts or contact areas reads fields that pressing by time does not set
    app.notices.offer_hold = app.session.plan->profile.level == calibration::LevelField::pressure;
}

}  // namespace

void note_devices(const platform::Window& window, App& app) {
    std::vector<std::string>& notes = app.notices.device_notes;
    notes.clear();
    app.notices.pressure_notes.clear();
    if (app.trace) {
        notes.push_back(words::filled(words::kReplayOf, {app.options.trace}));
        return;
    }
    app.notices.devices_listed = window.lists_devices();
    const std::vector<platform::PointerDevice> now = window.devices();
    if (app.notices.devices_listed) note_changes(now, app.notices);
    app.notices.devices = now;
    if (study_of(app.doing) != nullptr) return;
    if (app.keeper != nullptr) {
        app.notices.trials_note = app.keeper->note();
        app.view.part.unstored = !app.keeper->keeps_designs();
    }
    if (!window.input_note().empty()) notes.push_back(window.input_note());
    app.notices.offer_hold = false;
    for (const platform::Tool tool : {platform::Tool::pen, platform::Tool::finger}) note_pressure(tool, app);
    const auto& devices = app.notices.devices;
    const bool pressure =
        std::any_of(devices.begin(), devices.end(), [](const platform::PointerDevice& d) { return d.has_pressure; });
    if (!pressure) notes.push_back(app.notices.devices_listed ? words::kNoSensorHere : words::kNoSensorYet);
    if (!pressure || app.notices.offer_hold) notes.push_back(words::kOtherWays);
}

}  // namespace palpa::app
