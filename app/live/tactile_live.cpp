// The devices of the scene's finger, arm and pins beside a trial: they start with it, rest when it ends, and stop at F12
// whatever screen is open.

#include <exception>
#include <string_view>

#include "app/live/live_app.h"
#include "session/device_rows.h"

namespace palpa::app {
namespace {

constexpr const char* kStopKey = "F12";

// What the screens show of a scene before anything is driven. A stop outlives the trial in which it came.
TactileShown shown_of(const scene::Scene& scene, const std::optional<TactileShown>& before) {
    TactileShown shown;
    shown.arm_leads = scene.tactile->arm && scene.tactile->leads == scene::Leads::arm;
    shown.force_limit_N = scene.tactile->force_limit_N;
    shown.moment.force_limit_N = shown.force_limit_N;
    if (!before || !before->moment.stopped) return shown;
    shown.moment.stopped = true;
    shown.moment.fault = before->moment.fault;
    return shown;
}

// Beside the log of the trial, or beside its trace.
std::filesystem::path rows_file(const App& app) {
    if (app.session.files) return app.session.files->file("_tactile.tsv");
    if (!app.options.record.empty() && app.session.trials == 1)
        return session::device_rows_of(app.options.record, "tactile");
    return {};
}

}  // namespace

void know_tactile(App& app) {
    rest_tactile(app);
    TactileControl& tactile = app.tactile;
    tactile.preview.reset();
    tactile.report = files::Json();
    const scene::Scene& scene = app.session.scene;
    if (!scene.tactile) return tactile.shown.reset();
    tactile.shown = shown_of(scene, tactile.shown);
    attempt(app, [&] { tactile.preview = make_pins_preview(scene, app.session.plan); });
}

void drive_tactile(const std::filesystem::path& rows, App& app) {
    TactileControl& tactile = app.tactile;
    const session::Session& session = app.session;
    if (!tactile.shown || app.trace || tactile.shown->moment.stopped || !drives_devices(session.scene)) return;
    const TactileDriverOptions options{app.options.simulate_devices, rows};
    tactile.driver = std::make_unique<TactileDriver>(session.scene, session.plan, options);
    tactile.shown->opening = true;
}

bool tactile_ready(App& app) {
    TactileControl& tactile = app.tactile;
    if (!tactile.driver || tactile.shown->runs) return true;
    try {
        if (!tactile.driver->ready()) return false;
    } catch (const std::exception& error) {
        tactile.driver.reset();
        tactile.shown->opening = false;
        tactile.shown->problem = error.what();
        return true;
    }
    tactile.shown->devices = tactile.driver->devices();
    tactile.shown->opening = false;
    tactile.shown->runs = true;
    if (tactile.shown->moment.stopped) tactile.driver->stop();  // F12 came meanwhile
    return true;
}

void begin_tactile(App& app) {
    know_tactile(app);
    if (app.tactile.shown) drive_tactile(rows_file(app), app);
}

void rest_tactile(App& app) {
    TactileControl& tactile = app.tactile;
    if (!tactile.driver) return;
    tactile.report = tactile.driver->report();
    tactile.driver.reset();
    tactile.fault_since_s.reset();
    if (!tactile.shown) return;
    tactile.shown->runs = tactile.shown->opening = false;
    if (!tactile.shown->moment.stopped) tactile.shown->moment.fault = "";
}

void follow_tactile(double now_s, App& app) {
    TactileControl& tactile = app.tactile;
    if (!tactile.shown) return;
    session::TactileMoment& moment = tactile.shown->moment;
    if (!tactile.driver) {
        if (tactile.preview && palpates(app.doing)) preview_pins(app.session.state, *tactile.preview, moment);
        return;
    }
    if (app.session.trial.finished) return rest_tactile(app);
    if (!tactile_ready(app) || !tactile.driver) return;
    tactile.driver->hand_over(app.session.state);
    const bool stopped = moment.stopped;
    if (tactile.driver->latest(moment)) moment.stopped = moment.stopped || stopped;
    if (std::string_view(moment.fault) == "stopped") moment.fault = kStopKey;  // by whom
    if (*moment.fault == '\0') {
        tactile.fault_since_s.reset();
    } else if (!tactile.fault_since_s) {
        tactile.fault_since_s = now_s;
    }
}

void stop_tactile(App& app) {
    TactileControl& tactile = app.tactile;
    if (!tactile.shown) return;
    if (tactile.driver) tactile.driver->stop();
    tactile.shown->moment.stopped = true;
    tactile.shown->moment.fault = kStopKey;
}

void release_tactile(App& app) {
    TactileControl& tactile = app.tactile;
    if (!tactile.shown || !tactile.shown->moment.stopped) return;
    tactile.shown->moment.stopped = false;
    tactile.shown->moment.fault = "";
    tactile.fault_since_s.reset();
    if (tactile.driver) return tactile.driver->release();
    if (study_of(app.doing) == nullptr && !app.session.trial.finished) begin_tactile(app);
}

bool tactile_failed(double now_s, const App& app) {
    constexpr double kPasses_s = 0.5;  // a short silence passes by itself
    const TactileControl& tactile = app.tactile;
    if (!tactile.driver) return false;
    return tactile.shown->moment.stopped || (tactile.fault_since_s && now_s - *tactile.fault_since_s > kPasses_s);
}

}  // namespace palpa::app
