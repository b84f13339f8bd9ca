#include "app/study/study_run.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "files/input_error.h"
#include "files/text.h"
#include "scene/plan.h"
#include "session/plan_in_progress.h"
#include "study/ratings.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

constexpr double kRoom_MB = 64.0;  // for one trial: ten minutes at 1,000 Hz

// A recorded map's plan for another stiffness, with the force bar of the reference's plan.
std::shared_ptr<const scene::Plan> smoothed_anew(const scene::Plan& reference, const scene::Scene& scene) {
    scene::Plan plan = session::make_plan_here(scene);
    plan.greatest_force_N = reference.greatest_force_N;
    plan.greatest_depth_m = reference.greatest_depth_m;
    plan.zone_N = reference.zone_N;
    return std::make_shared<const scene::Plan>(std::move(plan));
}

// The same tissue, harder or softer: forces of linear elastic tissue are proportional to its modulus. All look alike
// to the person: the force bar is the reference's.
std::vector<StudyScene> stimuli_of(const StudyScene& scene, const study::ChoiceTask& task) {
    std::vector<StudyScene> out{scene};
    for (const double comparison_kPa : task.comparisons_kPa) {
        StudyScene other = scene;
        other.scene.stiffness_scale *= comparison_kPa / task.reference_kPa;
        if (!scene::serves(*scene.plan, other.scene)) other.plan = smoothed_anew(*scene.plan, other.scene);
        out.push_back(std::move(other));
    }
    return out;
}

bool plain(const std::string& code) {
    return !code.empty() && code.size() <= 20 && std::all_of(code.begin(), code.end(), [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    });
}

// What the experimenter sees from elsewhere (palpa study watch).
files::Json now_json(const StudyRun& run) {
    files::Json json{{"participant", run.code},
                     {"step", name_of(run.step)},
                     {"finished", run.progress.finished.size()},
                     {"of", run.progress.plan.trials.size()}};
    if (!run.stopped.empty()) json["stopped"] = run.stopped;
    if (!run.progress.next) return json;
    const study::PlannedTrial& trial = *run.progress.next;
    json["trial"] = trial.trial;
    json["condition"] = run.protocol.conditions[trial.condition].id;
    json["practice"] = trial.practice;
    if (trial.comparison < 0) return json;
    const study::ChoiceTask& task = run.protocol.choice;
    const double comparison_kPa = task.comparisons_kPa[static_cast<std::size_t>(trial.comparison)];
    json["present_kPa"] = {trial.reference_first ? task.reference_kPa : comparison_kPa,
                           trial.reference_first ? comparison_kPa : task.reference_kPa};
    json["interval"] = run.interval + 1;
    return json;
}

// A problem with the disk stops the study, in words, before a trial is lost.
template <class Work>
bool kept(StudyRun& run, const Work& work) {
    try {
        work();
        return true;
    } catch (const std::exception& error) {
        stop_study(error.what(), run);
        return false;
    }
}

void write_now(const StudyRun& run) {
    const fs::path subject = run.directory / ("sub-" + run.code);
    fs::create_directories(subject);
    files::write_text_atomically(subject / "now.json", files::json_text(now_json(run)));
}

void enter(StudyStep step, StudyRun& run) {
    run.step = step;
    run.step_began_s = 0.0;
    run.answers.clear();
    kept(run, [&] { write_now(run); });
}

void check_room(const StudyRun& run) {
    const double free_MB = 1e-6 * static_cast<double>(fs::space(run.directory).available);
    if (free_MB >= kRoom_MB) return;
    throw std::runtime_error(run.directory.string() + ": found " + files::short_number(free_MB) +
                             " MB free, expected " + files::short_number(kRoom_MB) +
                             " MB for a trial; the study stops here");
}

// The first condition whose trials are all done and that was not rated.
std::optional<std::size_t> to_rate(const StudyRun& run) {
    if (run.protocol.ratings.empty()) return std::nullopt;
    std::vector<std::string> notes;
    const std::vector<study::Rating> known = study::read_ratings(run.directory, run.code, notes);
    for (const study::PlannedTrial& trial : run.progress.plan.trials) {
        const auto open = [&](const study::PlannedTrial& t) {
            return t.condition == trial.condition && run.progress.finished.count(t.trial) == 0;
        };
        if (std::any_of(run.progress.plan.trials.begin(), run.progress.plan.trials.end(), open)) continue;
        const std::string& id = run.protocol.conditions[trial.condition].id;
        const auto same = [&](const study::Rating& r) { return r.condition == id; };
        if (std::none_of(known.begin(), known.end(), same)) return trial.condition;
    }
    return std::nullopt;
}

void add_person(StudyRun& run) {
    study::Person person;
    person.code = run.code;
    person.group = run.protocol.groups[run.progress.plan.group].id;
    std::vector<study::Rating> others;
    for (std::size_t i = 0; i < run.protocol.demographics.size(); ++i) {
        const std::string& id = run.protocol.demographics[i].id;
        const std::string value = i < run.answers.size() && !run.answers[i].empty() ? run.answers[i] : "n/a";
        if (id == "age")
            person.age = value;
        else if (id == "sex")
            person.sex = value;
        else if (id == "handedness")
            person.handedness = value;
        else if (id == "vision")
            person.vision = value;
        else if (id == "palpation_experience")
            person.palpation_experience = value;
        else if (id == "vr_experience")
            person.vr_experience = value;
        else
            others.push_back({"n/a", id, value});
    }
    study::add_ratings(run.directory, run.code, others);
    study::add_people(run.directory, {person});
    run.unkept_answers = true;
    run.progress = study::progress_of(run.directory, run.protocol, run.code);
}

void begin_trial_step(StudyRun& run) {
    const study::PlannedTrial& trial = due_trial(run);
    run.told = trial.condition;
    run.told_practice = trial.practice;
    run.interval = 0;
    run.typed = {};
    run.typed.nodules.assign(due_nodules(run).size(), study::kMissed);
    run.typed_began_s = 0.0;
    if (!kept(run, [&] { check_room(run); })) return;
    const bool choice = run.protocol.task == study::TaskKind::choice;
    if (!shows_tissue(run)) return enter(choice ? StudyStep::present : StudyStep::typed, run);
    enter(StudyStep::trial, run);
    run.start_trial = run.step == StudyStep::trial;
}

void go_on(StudyRun& run) {
    if (!run.progress.known && !run.asked && !run.protocol.demographics.empty())
        return enter(StudyStep::questions, run);
    if (!run.progress.known && !kept(run, [&] { add_person(run); })) return;
    if (const auto condition = to_rate(run)) {
        run.rated = *condition;
        return enter(StudyStep::ratings, run);
    }
    if (!run.progress.next) return enter(StudyStep::done, run);
    const study::PlannedTrial& trial = *run.progress.next;
    if (trial.break_before && !run.rested) return enter(StudyStep::pause, run);
    const bool told = run.told == trial.condition && run.told_practice == trial.practice;
    if (run.protocol.task == study::TaskKind::choice && told) return begin_trial_step(run);
    enter(StudyStep::instructions, run);
}

void finish_due(StudyRun& run) {
    run.progress.finished.insert(due_trial(run).trial);
    run.progress.next = study::next_trial(run.progress.plan, run.progress.finished);
    run.rested = false;
    go_on(run);
}

}  // namespace

const char* name_of(StudyStep step) {
    constexpr const char* kNames[] = {"code",     "again", "questions", "instructions", "trial", "device", "present",
                                      "question", "typed", "ratings",   "pause",        "done",  "stopped"};
    return kNames[static_cast<int>(step)];
}

StudyRun open_study_run(const study::Protocol& protocol, const fs::path& directory, const std::string& code) {
    StudyRun run;
    run.protocol = protocol;
    run.directory = directory;
    run.scenes = load_study_scenes(protocol);
    for (const auto& scene : run.scenes) {
        run.identities.push_back(identity_of(scene));
        run.stimuli.emplace_back();
        if (protocol.task == study::TaskKind::choice && scene) run.stimuli.back() = stimuli_of(*scene, protocol.choice);
    }
    study::open_study(directory, protocol, {false, 0, "palpa " PALPA_VERSION});
    if (code.empty()) return run;
    if (!plain(code)) throw files::bad_input("--participant", "", files::shown(code), "up to 20 letters and digits");
    enter_code(code, run);
    if (!run.note.empty())
        throw files::bad_input("--participant", "", files::shown(code) + ", who has finished all trials", "a new code");
    if (run.step == StudyStep::stopped) throw std::runtime_error(run.stopped);
    return run;
}

std::string free_code(const StudyRun& run) {
    std::vector<std::string> notes;
    const std::vector<study::Person> people = study::read_people(run.directory, notes);
    for (std::size_t number = people.size() + 1;; ++number) {
        char code[24];
        std::snprintf(code, sizeof code, "%02zu", number);
        if (std::none_of(people.begin(), people.end(), [&](const study::Person& p) { return p.code == code; }))
            return code;
    }
}

void enter_code(const std::string& code, StudyRun& run) {
    run.note.clear();
    if (!plain(code)) {
        run.note = "Up to 20 letters and digits.";
        run.focus_code = true;
        return;
    }
    if (!kept(run, [&] { run.progress = study::progress_of(run.directory, run.protocol, code); })) return;
    run.code = code;
    run.asked = run.rested = false;
    run.told.reset();
    run.choices.reset();  // each person's choices go to files of their own
    if (run.progress.known && !run.progress.next && !to_rate(run)) {
        run.note = code + " has finished all trials; take a new code.";
        run.focus_code = true;
        return;
    }
    if (run.progress.known) return enter(StudyStep::again, run);
    go_on(run);
}

void same_person(bool is, StudyRun& run) {
    if (is) return go_on(run);
    run.step = StudyStep::code;
    run.code.clear();
    run.typed_code.reset();
}

void submit_answers(StudyRun& run) {
    if (run.step == StudyStep::questions) {
        run.asked = true;
        if (kept(run, [&] { add_person(run); })) go_on(run);
        return;
    }
    std::vector<study::Rating> ratings;
    for (std::size_t i = 0; i < run.protocol.ratings.size(); ++i) {
        const bool answered = i < run.answers.size() && !run.answers[i].empty();
        ratings.push_back(
            {run.protocol.conditions[run.rated].id, run.protocol.ratings[i].id, answered ? run.answers[i] : "n/a"});
    }
    run.unkept_answers = true;
    if (kept(run, [&] { study::add_ratings(run.directory, run.code, ratings); })) go_on(run);
}

void begin_step(StudyRun& run) {
    if (run.step == StudyStep::pause) {
        run.rested = true;
        return go_on(run);
    }
    if (run.step != StudyStep::device) return begin_trial_step(run);
    if (!run.device_here) return;
    run.device_left = false;
    enter(StudyStep::trial, run);  // of a choice, the same interval
    run.start_trial = run.step == StudyStep::trial;
}

void wait_for_device(bool left, StudyRun& run) {
    run.start_trial = false;
    run.device_here = false;
    run.device_left = left;
    enter(StudyStep::device, run);
}

void trial_finished(StudyRun& run) {
    if (run.protocol.task == study::TaskKind::find) return finish_due(run);
    interval_presented(run);
    run.start_trial = run.step == StudyStep::trial;
}

void interval_presented(StudyRun& run) {
    const StudyStep again = shows_tissue(run) ? StudyStep::trial : StudyStep::present;
    if (run.interval == 1) return enter(StudyStep::question, run);
    run.interval = 1;
    enter(again, run);
}

void choose_softer(bool first, double now_s, StudyRun& run) {
    const study::PlannedTrial& trial = due_trial(run);
    const study::ChoiceTask& task = run.protocol.choice;
    const study::Condition& condition = due_condition(run);
    const bool reference = first == trial.reference_first;
    study::ChoiceRow row;
    const std::string block = trial.practice ? "practice" : "test";
    row.block = block;
    row.duration_s = now_s - run.step_began_s;
    row.trial = trial.trial;
    row.order_id = run.progress.plan.order_id;
    row.condition = condition.id;
    row.device_id = condition.device;
    row.seed = trial.seed;
    row.reference_kPa = task.reference_kPa;
    row.comparison_kPa = task.comparisons_kPa[static_cast<std::size_t>(trial.comparison)];
    row.first = trial.reference_first ? "reference" : "comparison";
    row.answer = reference ? "reference" : "comparison";
    row.correct = reference == (row.reference_kPa < row.comparison_kPa) ? 1 : 0;
    const bool good = kept(run, [&] {
        if (!run.choices) {
            run.choices =
                std::make_unique<study::ChoiceLog>(study::next_run(run.directory, run.code, "softer", run.first_run));
            run.choices_began_s = now_s;
        }
        row.onset_s = now_s - run.choices_began_s;
        if (!run.choices->write(row))
            throw std::runtime_error(run.directory.string() +
                                     ": the choice could not be written; the study stops here");
    });
    run.unkept_answers = true;
    if (good) finish_due(run);
}

void submit_typed(StudyRun& run) {
    const study::PlannedTrial& trial = due_trial(run);
    const bool good = kept(run, [&] {
        study::TrialLabel label = label_of(run.protocol, run.progress.plan, trial, run.identities[trial.condition]);
        const study::RunFiles files = study::next_run(run.directory, run.code, "palpation", run.first_run);
        run.unkept_runs.push_back(files);
        study::write_typed_trial(files, label, trial.practice, trial.seed, due_nodules(run), run.typed);
    });
    if (good) finish_due(run);
}

void stop_study(const std::string& why, StudyRun& run) {
    run.stopped = why;
    run.step = StudyStep::stopped;
    run.start_trial = false;
    if (run.code.empty()) return;
    try {
        write_now(run);  // for the experimenter
    } catch (const std::exception&) {
        // the disk is what stopped it; the participant's screen says so
    }
}

const study::PlannedTrial& due_trial(const StudyRun& run) { return *run.progress.next; }
const study::Condition& due_condition(const StudyRun& run) { return run.protocol.conditions[due_trial(run).condition]; }

bool typed_in(const study::Condition& condition) {
    return condition.modality == study::Modality::hand || condition.modality == study::Modality::tangible ||
           condition.modality == study::Modality::shape_display;
}

bool shows_tissue(const StudyRun& run) {
    return !typed_in(due_condition(run)) && run.scenes[due_trial(run).condition].has_value();
}

const StudyScene& due_scene(const StudyRun& run) {
    const study::PlannedTrial& trial = due_trial(run);
    if (run.protocol.task == study::TaskKind::find) return *run.scenes[trial.condition];
    const bool reference = (run.interval == 0) == trial.reference_first;
    return run.stimuli[trial.condition][reference ? 0 : 1 + static_cast<std::size_t>(trial.comparison)];
}

session::SessionFiles due_files(const StudyRun& run) {
    const study::PlannedTrial& trial = due_trial(run);
    session::SessionFiles files;
    files.log = run.directory.string();
    files.participant = run.code;
    files.first_run = run.first_run;
    files.label = label_of(run.protocol, run.progress.plan, trial, run.identities[trial.condition]);
    if (run.protocol.task == study::TaskKind::choice) {
        files.task = "interval";
        files.label->study["interval"] = run.interval + 1;
    }
    return files;
}

double due_limit_s(const StudyRun& run) {
    return due_trial(run).practice ? run.protocol.practice_limit_s : run.protocol.time_limit_s;
}

std::vector<std::string> due_nodules(const StudyRun& run) {
    const auto& scene = run.scenes[due_trial(run).condition];
    if (!scene) return due_condition(run).nodules;
    std::vector<std::string> names;
    for (const stiffnessmaps::Nodule& nodule : scene->plan->nodules) names.push_back(nodule.id);
    return names;
}

const std::vector<study::Item>& due_items(const StudyRun& run) {
    return run.step == StudyStep::questions ? run.protocol.demographics : run.protocol.ratings;
}

std::string progress_text(const StudyRun& run) {
    const std::size_t of = run.progress.plan.trials.size();
    return std::to_string(std::min(of, run.progress.finished.size() + 1)) + " of " + std::to_string(of);
}

}  // namespace palpa::app
