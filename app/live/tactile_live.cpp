// Arm and pins of the scene beside a trial.

#include "app/live/live_app.h"

namespace palpa::app {
namespace {

// What the screens show of a scene before anything is driven.
TactileShown shown_of(const scene::Scene& scene) {
    TactileShown shown;
    shown.arm_leads = scene::arm_leads(scene);
    shown.force_limit_N = scene.tactile->force_limit_N;
    shown.moment.force_limit_N = shown.force_limit_N;
    return shown;
}

}  // namespace

void know_tactile(App& app) {
    TactileControl& tactile = app.tactile;
    tactile.preview.reset();
    tactile.report = files::Json();
    const scene::Scene& scene = app.session.scene;
    if (!scene.tactile) return tactile.shown.reset();
    show_instead(shown_of(scene), tactile);
    attempt(app, [&] { tactile.preview = make_pins_preview(scene, app.session.plan); });
}

void drive_tactile(const std::filesystem::path& rows, App& app) {
    TactileControl& tactile = app.tactile;
    const session::Session& session = app.session;
    if (!tactile.shown || app.trace || tactile.shown->moment.stopped || !drives_devices(session.scene)) return;
    const DriverOptions options{app.options.simulate_devices, rows};
    tactile.driver = std::make_unique<TactileDriver>(session.scene, session.plan, options);
    tactile.shown->opening = true;
}

void follow_tactile(double now_s, App& app) {
    TactileControl& tactile = app.tactile;
    if (!tactile.shown) return;
    if (tactile.driver) {
        const bool fresh = follow(now_s, app.session.state, tactile);
        const session::TactileMoment& moment = tactile.shown->moment;
        if (fresh && tactile.shown->arm_leads && palpates(app.doing))
            session::take_device_press({{moment.x_m, moment.y_m}, moment.depth_m, moment.force_N}, now_s, app.session);
    } else if (tactile.preview && palpates(app.doing)) {
        preview_pins(app.session.state, *tactile.preview, tactile.shown->moment);
    }
}

}  // namespace palpa::app
