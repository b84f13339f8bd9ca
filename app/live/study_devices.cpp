// Arm and pins of a study's trial: it begins once they run, and its settings name them.

#include "app/live/live_app.h"
#include "app/screens/words.h"
#include "app/study/study_run.h"

namespace palpa::app {

bool devices_stopped(const App& app) {
    const auto& shown = app.tactile.shown;
    return shown && (shown->moment.stopped || !shown->problem.empty());
}

void note_tactile(const App& app, StudyRun& run) {
    run.devices_note.clear();
    if (!run.progress.next || !feels_pins(run)) return;
    if (devices_stopped(app)) {
        const TactileShown& shown = *app.tactile.shown;
        run.devices_note =
            shown.problem.empty() ? words::filled(words::kDevicesStopped, {shown.moment.fault}) : shown.problem;
        return;
    }
    if (app.options.simulate_devices || app.tactile.driver) return;
    for (const std::string& missing : missing_devices(due_scene(run).scene))
        run.devices_note += (run.devices_note.empty() ? "" : "\n") + words::filled(words::kDevicesMissing, {missing});
}

bool devices_ready(App& app) {
    StudyRun& run = *study_of(app.doing);
    bool& opening = std::get<step::Trial>(run.step).opening;
    if (!opening) {
        know_tactile(app);
        if (!app.tactile.shown) return true;
        const session::SessionFiles files = due_files(run);
        drive_tactile(study::next_run(files.log, files.participant, files.task, files.first_run).file("_tactile.tsv"),
                      app);
        opening = true;
    }
    return tactile_ready(app);
}

void name_devices(const App& app, study::TrialLabel& label) {
    if (!app.tactile.shown) return;
    label.study["devices"] = files::Json::array();
    for (const session::TactileDevice& device : app.tactile.shown->devices) {
        label.study["devices"].push_back(
            {{"role", device.role}, {"name", device.name}, {"port", device.port}, {"simulated", device.simulated}});
    }
}

}  // namespace palpa::app
