// Changes what the app is doing.

#include <utility>

#include "app/live/live_app.h"
#include "app/scene_choices.h"
#include "app/screens/calibrate_form.h"
#include "app/screens/history_screen.h"
#include "app/screens/map_screen.h"
#include "app/screens/words.h"

namespace palpa::app {
namespace {

// Writes the recording to the disk. A profile that was saved can be chosen at once.
void close_calibrate(CalibrateForm& form, App& app) {
    stop_recording(form);
    app.notices.profiles = profile_choices();
}

void open_maps(platform::Window& window, App& app) {
    if (!may_show_maps(*app.session.plan, app.session.trial)) {
        app.notices.note = words::kMapsHidden;
        if (bool* menu = menu_of(app.doing)) *menu = false;
        return;
    }
    if (std::holds_alternative<BrowsingMaps>(app.doing)) return;
    go_to(BrowsingMaps{}, window, app);
    app.view.maps = make_map_browser(app.session.scene, map_choices());
}

// The results show where nodules were, as maps do.
void open_history(platform::Window& window, App& app) {
    if (!may_show_maps(*app.session.plan, app.session.trial)) {
        app.notices.note = words::kMapsHidden;
        return;
    }
    if (std::holds_alternative<BrowsingHistory>(app.doing)) return;
    go_to(BrowsingHistory{}, window, app);
    app.view.history = make_history_view(app.history_folder);
}

void open_devices(platform::Window& window, App& app) {
    app.check = std::make_shared<DeviceCheck>();
    go_to(CheckingDevices{app.check, {}}, window, app);
}

}  // namespace

void go_to(Doing next, platform::Window& window, App& app) {
    if (next.index() != app.doing.index()) end_presses(window, app);
    const Doing before = std::exchange(app.doing, std::move(next));
    if (const auto* calibrating = std::get_if<Calibrating>(&before)) close_calibrate(*calibrating->form, app);
    app.view.maps.reset();
    app.view.history.reset();
}

Doing back_to_trial(const App& app) {
    const session::Session& s = app.session;
    if (s.trial.finished) return review_of(*s.plan, s.trial, s.state.view, app.guided);
    return Palpating{false, app.guided};
}

void open_screen(Screen screen, platform::Window& window, App& app) {
    if (study_of(app.doing) != nullptr) return;
    switch (screen) {
        case Screen::trial:
            return go_to(back_to_trial(app), window, app);
        case Screen::devices:
            return open_devices(window, app);
        case Screen::scale:
            return go_to(MeasuringScreen{}, window, app);
        case Screen::calibrate:
            if (!std::holds_alternative<Calibrating>(app.doing)) go_to(Calibrating{make_calibrate_form()}, window, app);
            return;
        case Screen::maps:
            return open_maps(window, app);
        case Screen::history:
            return open_history(window, app);
        case Screen::tactile:
            return go_to(WatchingTactile{}, window, app);
        case Screen::tangible:
            return go_to(WatchingTangible{}, window, app);
    }
}

bool trial_stopped(const App& app) { return std::holds_alternative<TrialStopped>(app.course); }
bool waits_for_keeper(const App& app) { return std::holds_alternative<WaitsForKeeper>(app.course); }

}  // namespace palpa::app
