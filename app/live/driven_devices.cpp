// All devices of a scene, arm and pins or a soft device, beside a trial: they start with it, rest when it ends, and stop at
// F12 whatever screen is open.

#include "app/live/live_app.h"
#include "session/device_rows.h"

namespace palpa::app {
namespace {

// Beside the log of the trial, or beside its trace.
std::filesystem::path rows_file(const App& app, const std::string& device) {
    if (app.session.files) return app.session.files->file("_" + device + ".tsv");
    if (!app.options.record.empty() && app.session.trials == 1)
        return session::device_rows_of(app.options.record, device);
    return {};
}

}  // namespace

void know_devices(App& app) {
    rest_devices(app);
    know_tactile(app);
    know_tangible(app);
}

bool devices_ready(App& app) {
    const bool tactile = is_ready(app.tactile, [](TactileShown&) {});
    const bool tangible =
        is_ready(app.tangible, [&](TangibleShown& shown) { shown.body = app.tangible.driver->body(); });
    return tactile && tangible;
}

void begin_devices(App& app) {
    know_devices(app);
    if (app.tactile.shown) drive_tactile(rows_file(app, "tactile"), app);
    if (app.tangible.shown) drive_tangible(rows_file(app, "tangible"), app);
}

void rest_devices(App& app) {
    for_each_device(app, [](auto& control) { rest(control); });
}

void follow_devices(double now_s, App& app) {
    if (devices_driven(app) && app.session.trial.finished) return rest_devices(app);
    devices_ready(app);
    follow_tactile(now_s, app);
    follow_tangible(now_s, app);
}

void stop_devices(App& app) {
    if (drives_devices(app.session.scene)) stop(app.tactile);  // pins that are only drawn need no release
    stop(app.tangible);
}

void release_devices(App& app) {
    bool begin = false;
    for_each_device(app, [&](auto& control) { begin = release(control) || begin; });
    if (begin && study_of(app.doing) == nullptr && !app.session.trial.finished) begin_devices(app);
}

bool devices_failed(double now_s, const App& app) {
    bool any = false;
    for_each_device(app, [&](const auto& control) { any = failed(now_s, control) || any; });
    return any;
}

bool devices_driven(const App& app) {
    bool any = false;
    for_each_device(app, [&](const auto& control) { any = control.driver != nullptr || any; });
    return any;
}

}  // namespace palpa::app
