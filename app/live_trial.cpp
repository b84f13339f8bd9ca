// What becomes of a trial that goes on when something else is asked for, and how the tissue lies in the next one.

#include "app/live_app.h"
#include "app/map_screen.h"

namespace palpa {

void turn_tissue(App& app) {
    Mapping& mapping = app.session.scene.mapping;
    const int now = mapping.rotate_deg / 90 + (mapping.flip ? 4 : 0);
    constexpr int kSteps[] = {3, 5};  // both reach all eight before any comes again
    const int next = (now + kSteps[app.session.scene.seed % 2]) % 8;
    mapping.rotate_deg = 90 * (next % 4);
    mapping.flip = next >= 4;
}

void turn_if_shown(App& app) {
    if (!may_show_maps(app.session.trial)) return;
    if (!close_trial(app)) app.screens.problems.push_back(app.stopped);  // its settings say how it was turned
    turn_tissue(app);
}

void end_press(double now_s, App& app) {
    const State& state = app.session.state;
    if (app.screens.screen != Screen::trial || !state.pointer) return;
    Sample end;
    end.t_host_s = now_s;
    end.pointer_id = *state.pointer;
    end.tool = state.pointer_tool;
    end.phase = Phase::cancel;
    end.x_px = end.y_px = kMissing;
    take_sample(end, app.session);
}

bool marks_at_stake(const App& app) {
    const bool between = app.screens.study && app.screens.screen != Screen::trial;
    const Trial& trial = app.session.trial;
    return !app.trace && !between && app.stopped.empty() && !trial.finished && !trial.marks.empty();
}

}  // namespace palpa
