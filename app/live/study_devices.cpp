// The devices of a study's trial, arm and pins or a soft device: it begins once they run, and its settings name them.

#include <filesystem>

#include "app/live/live_app.h"
#include "app/screens/words.h"
#include "app/study/study_run.h"

namespace palpa::app {
namespace {

void add_line(const std::string& line, std::string& text) { text += (text.empty() ? "" : "\n") + line; }

// Why these devices do not run though they are there; "" if they could.
std::string why_stopped(const DriveState& shown, const char* fault) {
    return shown.problem.empty() ? words::filled(words::kDevicesStopped, {fault}) : shown.problem;
}

// The run of the trial that is due. Devices that were stopped before their trial began have left a file of rows: its number
// is passed over, so that a trial's rows and events have one number.
study::RunFiles run_with_devices(StudyRun& run) {
    for (;; ++run.first_run) {
        const session::SessionFiles files = due_files(run);
        study::RunFiles next = study::next_run(files.log, files.participant, files.task, files.first_run);
        const auto is_there = [&](const char* rows) { return std::filesystem::exists(next.file(rows)); };
        if (!is_there("_tactile.tsv") && !is_there("_tangible.tsv")) return next;
    }
}

}  // namespace

bool devices_stopped(const App& app) {
    bool any = false;
    for_each_device(app, [&](const auto& control) {
        any = any || (control.shown && (control.shown->moment.stopped || !control.shown->problem.empty()));
    });
    return any;
}

void forget_problems(App& app) {
    for_each_device(app, [](auto& control) {
        if (control.shown) control.shown->problem.clear();
    });
}

void note_missing(const App& app, StudyRun& run) {
    run.devices_note.clear();
    if (!run.progress.next || !feels_device(run)) return;
    if (devices_stopped(app)) {
        for_each_device(app, [&](const auto& control) {
            if (control.shown && (control.shown->moment.stopped || !control.shown->problem.empty()))
                add_line(why_stopped(*control.shown, control.shown->moment.fault), run.devices_note);
        });
        return;
    }
    if (app.options.simulate_devices || devices_driven(app)) return;
    const scene::Scene& scene = due_scene(run).scene;
    for (const auto& missing : {missing_devices(scene), missing_soft_device(scene)}) {
        for (const std::string& one : missing) add_line(words::filled(words::kDevicesMissing, {one}), run.devices_note);
    }
}

bool study_devices_ready(App& app) {
    StudyRun& run = *study_of(app.doing);
    bool& opening = std::get<step::Trial>(run.step).opening;
    if (!opening) {
        know_devices(app);
        if (!app.tactile.shown && !app.tangible.shown) return true;
        const study::RunFiles next = run_with_devices(run);
        drive_tactile(next.file("_tactile.tsv"), app);
        drive_tangible(next.file("_tangible.tsv"), app);
        opening = true;
    }
    return devices_ready(app);
}

void name_devices(const App& app, study::TrialLabel& label) {
    if (!app.tactile.shown && !app.tangible.shown) return;
    label.study["devices"] = files::Json::array();
    for_each_device(app, [&](const auto& control) {
        if (!control.shown) return;
        for (const session::TactileDevice& device : control.shown->devices) {
            label.study["devices"].push_back(
                {{"role", device.role}, {"name", device.name}, {"port", device.port}, {"simulated", device.simulated}});
        }
    });
}

}  // namespace palpa::app
