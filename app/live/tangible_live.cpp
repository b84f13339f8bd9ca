// The soft device of the scene beside a trial.

#include <cmath>

#include "app/live/live_app.h"

namespace palpa::app {
namespace {

// Adds this moment to the press that the screen draws; another press begins anew.
void add_to_press(const session::TangibleMoment& moment, TangibleShown& shown) {
    constexpr double kStep_m = 2e-5;                    // finer steps could not be told apart on a screen
    if (!moment.pressed || is_relaxed(moment)) return;  // nothing is wanted of a relaxed device
    const bool began = shown.press.empty() || moment.ticks < shown.press.back().tick;
    if (began || !shown.was_pressed) shown.press.clear();
    if (!shown.press.empty() && std::abs(moment.depth_m - shown.press.back().depth_m) < kStep_m) return;
    if (shown.press.size() == TangibleShown::kMostPoints)  // a finger that rests: the latest is what counts
        shown.press.erase(shown.press.begin(), shown.press.begin() + TangibleShown::kMostPoints / 4);
    shown.press.push_back({moment.ticks, moment.depth_m, moment.wanted_N, moment.rendered_N});
}

}  // namespace

void know_tangible(App& app) {
    TangibleControl& tangible = app.tangible;
    tangible.report = files::Json();
    const scene::Scene& scene = app.session.scene;
    if (!scene.tangible) return tangible.shown.reset();
    TangibleShown shown;
    shown.device_leads = scene::soft_device_leads(scene);
    show_instead(std::move(shown), tangible);
}

void drive_tangible(const std::filesystem::path& rows, App& app) {
    TangibleControl& tangible = app.tangible;
    const session::Session& session = app.session;
    if (!tangible.shown || app.trace || tangible.shown->moment.stopped) return;
    const DriverOptions options{app.options.simulate_devices, rows};
    const auto open = [&] { tangible.driver = std::make_unique<TangibleDriver>(session.scene, session.plan, options); };
    try {
        open();
        tangible.shown->opening = true;
    } catch (const std::exception& error) {
        tangible.shown->problem = error.what();
    }
}

void follow_tangible(double now_s, App& app) {
    TangibleControl& tangible = app.tangible;
    if (!tangible.shown || !tangible.driver) return;
    if (follow(now_s, app.session.state, tangible)) {
        add_to_press(tangible.shown->moment, *tangible.shown);
        const session::TangibleMoment& moment = tangible.shown->moment;
        tangible.shown->was_pressed = moment.pressed;
        if (tangible.shown->device_leads && palpates(app.doing)) {
            const double force_N = moment.pressed ? moment.wanted_N : 0.0;
            const Eigen::Vector2d& at_m = *app.session.scene.tangible->at_m;
            session::take_device_press({at_m, moment.world_depth_m, force_N}, now_s, app.session);
        }
    }
    if (tangible.driver->latest(*tangible.shown->shape)) tangible.shown->has_shape = true;
}

}  // namespace palpa::app
