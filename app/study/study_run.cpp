#include "app/study/study_run.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "files/input_error.h"
#include "files/text.h"
#include "scene/plan.h"
#include "session/plan_in_progress.h"
#include "study/exclusions.h"
#include "study/names.h"
#include "study/ratings.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

constexpr double kRoom_MB = 64.0;  // free disk space for one trial: ten minutes at 1,000 Hz

// Returns a recorded map's plan for another stiffness, with the force bar of the reference's plan.
std::shared_ptr<const scene::Plan> smoothed_anew(const scene::Plan& reference, const scene::Scene& scene) {
    scene::Plan plan = session::make_plan_here(scene);
    plan.greatest_force_N = reference.greatest_force_N;
    plan.greatest_depth_m = reference.greatest_depth_m;
    plan.zone_N = reference.zone_N;
    plan.known_N = reference.known_N;
    return std::make_shared<const scene::Plan>(std::move(plan));
}

// Returns the reference and its comparisons: the same tissue with scaled forces, since forces of linear elastic tissue
// are proportional to its modulus. All look alike to the participant, with the force bar of the reference.
std::vector<StudyScene> stimuli_of(const StudyScene& scene, const study::Protocol& protocol, std::size_t condition) {
    std::vector<StudyScene> out{scene};
    const double reference_kPa = study::reference_kPa_of(protocol, condition);
    for (const double comparison_kPa : study::comparisons_kPa_of(protocol, condition)) {
        StudyScene other = scene;
        other.scene.stiffness_scale *= comparison_kPa / reference_kPa;
        if (!scene::serves(*scene.plan, other.scene)) other.plan = smoothed_anew(*scene.plan, other.scene);
        out.push_back(std::move(other));
    }
    return out;
}

// Pins that are only drawn cannot be felt.
void check_displays(const StudyRun& run) {
    for (std::size_t i = 0; i < run.scenes.size(); ++i) {
        const study::Condition& condition = run.protocol.conditions[i];
        if (condition.modality != study::Modality::shape_display || typed_in(run, i)) continue;
        const scene::TactileOptions& tactile = *run.scenes[i]->scene.tactile;
        if ((tactile.arm && !tactile.arm->device.empty()) || (tactile.display && !tactile.display->device.empty()))
            continue;
        throw files::bad_input(run.protocol.file.string(),
                               "conditions[" + std::to_string(i) + "] " + files::shown(condition.id) + ": scene",
                               files::shown(condition.scene) + ", whose key tactile names no device",
                               "a scene with tactile.arm.device or tactile.display.device, since pins that are only "
                               "drawn cannot be felt");
    }
}

bool plain(const std::string& code) { return code.size() <= 20 && study::is_code(code); }

const char* what_is_wrong(const std::string& code) {
    if (code.empty()) return "Enter a code of up to 20 letters and digits.";
    if (study::names_a_sum(code)) return "Tables take this code for a row of sums. Enter another one.";
    return study::reads_as_missing(code)
               ? "Tables in pandas and R take this code for a missing value. Enter another one."
               : "Enter up to 20 letters and digits.";
}

std::string spelled_alike(const fs::path& directory, const std::string& code) {
    std::vector<std::string> notes;
    return study::spelled_alike(study::read_people(directory, notes), code);
}

void write_now(const StudyRun& run) {
    const fs::path subject = run.directory / ("sub-" + run.code);
    fs::create_directories(subject);
    files::write_text_atomically(subject / "now.json", files::json_text(now_json(run)));
}

void change_step(StudyStep step, StudyRun& run) {
    run.step = std::move(step);
    run.step_began_s = 0.0;
    ++run.entered;
}

void check_room(const StudyRun& run) {
    const double free_MB = 1e-6 * static_cast<double>(fs::space(run.directory).available);
    if (free_MB >= kRoom_MB) return;
    throw std::runtime_error(run.directory.string() + ": found " + files::short_number(free_MB) +
                             " MB free, expected " + files::short_number(kRoom_MB) +
                             " MB for a trial; the study has stopped");
}

// Returns the first condition whose trials are all finished and which was not rated yet.
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

void add_person(const std::vector<std::string>& answers, StudyRun& run) {
    // whoever came at another screen meanwhile has this person's place in the order
    run.progress = study::progress_of(run.directory, run.protocol, run.code);
    study::Person person;
    person.code = run.code;
    person.group = run.protocol.groups[run.progress.plan.group].id;
    std::vector<study::Rating> others;
    for (std::size_t i = 0; i < run.protocol.demographics.size(); ++i) {
        const std::string& id = run.protocol.demographics[i].id;
        const std::string value = i < answers.size() && !answers[i].empty() ? answers[i] : "n/a";
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
    if (!run.protocol.consent.empty()) others.insert(others.begin(), study::consent_given());
    study::add_ratings(run.directory, run.code, others);
    study::add_people(run.directory, {person});
    run.unkept_answers = true;
    run.progress = study::progress_of(run.directory, run.protocol, run.code);
    find_comparison(run);
}

void begin_trial_step(StudyRun& run) {
    if (left_elsewhere(run)) return;
    const study::PlannedTrial& trial = due_trial(run);
    run.told = trial.condition;
    run.told_practice = trial.practice;
    run.interval = 0;
    if (!kept(run, [&] { check_room(run); })) return;
    if (shows_tissue(run)) return enter(step::Trial{}, run);
    if (due_compares(run)) return enter(step::Present{}, run);
    enter(step::Typed{}, run);
}

const char* why_refused(const StudyRun& run, const std::string& code) {
    if (!spelled_alike(run.directory, code).empty())
        return "which differs from a participant's code by capitals or zeros only";
    if (study::withdrawal_of(run.directory, code) != study::Withdrawal::none) return "who has withdrawn from the study";
    if (!study::replaced_by(run.directory, code).empty()) return "who was replaced";
    return run.code.empty() ? "who is at another screen now" : "who has finished all trials";
}

// Makes the person's folder, and holds it until somebody else's code is asked for.
void lock_code(const std::string& code, StudyRun& run) {
    const fs::path subject = run.directory / ("sub-" + code);
    fs::create_directories(subject);
    run.lock.reset();  // it may be the same folder
    run.lock = std::make_unique<files::FolderLock>(subject);
}

void refuse_code(const std::string& why, StudyRun& run) {
    run.note = why;
    if (auto* code = std::get_if<step::Code>(&run.step)) ++code->refused;
}

void finish_due(StudyRun& run) {
    run.progress.finished.insert(due_trial(run).trial);
    run.progress.next = study::next_trial(run.progress.plan, run.progress.finished);
    run.rested = false;
    run.interval = 0;
    if (kept(run, [&] { find_comparison(run); })) go_on(run);
}

}  // namespace

const char* name_of(const StudyStep& step) {
    constexpr const char* kNames[] = {"code",    "again",   "consent",  "questions", "instructions", "trial",
                                      "device",  "present", "question", "told",      "feedback",     "typed",
                                      "ratings", "pause",   "leaving",  "withdrawn", "done",         "stopped"};
    static_assert(std::size(kNames) == std::variant_size_v<StudyStep>);
    return kNames[step.index()];
}

void enter(StudyStep step, StudyRun& run) {
    change_step(std::move(step), run);
    kept(run, [&] { write_now(run); });
}

bool kept(StudyRun& run, const std::function<void()>& work) {
    try {
        work();
        return true;
    } catch (const std::exception& error) {
        stop_study(error.what(), run);
        return false;
    }
}

void go_on(StudyRun& run) {
    run.interval = 0;
    if (left_elsewhere(run)) return;
    const bool known = run.progress.known;
    if (!known && !run.protocol.consent.empty() && !run.consented) return enter(step::Consent{}, run);
    if (!known && !run.protocol.demographics.empty()) return enter(step::Questions{}, run);
    if (!known && !kept(run, [&] { add_person({}, run); })) return;
    if (const auto condition = to_rate(run)) return enter(step::Ratings{*condition}, run);
    if (!run.progress.next) {
        run.lock.reset();  // nothing more is written; the code is free for the experimenter's other programs
        return enter(step::Done{}, run);
    }
    const study::PlannedTrial& trial = *run.progress.next;
    if (trial.break_before && !run.rested) return enter(step::Pause{}, run);
    const bool told = run.told == trial.condition && run.told_practice == trial.practice;
    if (due_compares(run) && told) return begin_trial_step(run);
    enter(step::Instructions{}, run);
}

bool trial_waits(const StudyRun& run) {
    const auto* trial = std::get_if<step::Trial>(&run.step);
    return trial != nullptr && !trial->begun;
}

bool trial_goes_on(const StudyRun& run) {
    const auto* trial = std::get_if<step::Trial>(&run.step);
    return trial != nullptr && trial->begun;
}

StudyRun open_study_run(const study::Protocol& protocol, const fs::path& directory, const std::string& code) {
    StudyRun run;
    run.protocol = protocol;
    run.directory = directory;
    run.scenes = load_study_scenes(protocol);
    note_typed_in(run.scenes, run.protocol);
    run.identities = identities_of(run.scenes);
    for (const auto& scene : run.scenes) {
        run.stimuli.emplace_back();
        const std::size_t condition = run.stimuli.size() - 1;
        if (scene && study::compares(study::task_of(protocol, condition)))
            run.stimuli.back() = stimuli_of(*scene, protocol, condition);
    }
    check_displays(run);
    if (!code.empty() && !plain(code))  // before anything is written
        throw files::bad_input("--participant", "", files::shown(code),
                               study::names_a_sum(code) ? "a code that tables do not take for a row of sums"
                               : study::reads_as_missing(code)
                                   ? "a code that tables in pandas and R do not take for a missing value"
                                   : "up to 20 letters and digits");
    study::open_study(directory, protocol, {false, 0, "palpa " PALPA_VERSION});
    if (code.empty()) return run;
    enter_code(code, run);
    if (!run.note.empty())
        throw files::bad_input("--participant", "", files::shown(code) + ", " + why_refused(run, code), "a new code");
    if (const auto* stopped = std::get_if<step::Stopped>(&run.step)) throw std::runtime_error(stopped->why);
    return run;
}

void carry_out(const StudyWish& wish, StudyRun& run) {
    if (const auto* code = std::get_if<EnterCode>(&wish)) return enter_code(code->code, run);
    if (const auto* person = std::get_if<SamePerson>(&wish)) return same_person(person->is, run);
    if (const auto* consent = std::get_if<GiveConsent>(&wish)) return answer_consent(consent->given, run);
    if (std::holds_alternative<WantToLeave>(wish)) return want_to_leave(run);
    if (const auto* leave = std::get_if<LeaveStudy>(&wish)) return leave_study(leave->how, run);
    if (const auto* submit = std::get_if<SubmitAnswers>(&wish)) return submit_answers(submit->answers, run);
    if (std::holds_alternative<BeginStep>(wish)) return begin_step(run);
    if (std::holds_alternative<IntervalPresented>(wish)) return interval_presented(run);
    if (const auto* softer = std::get_if<ChooseSofter>(&wish)) return choose_softer(softer->first, softer->at_s, run);
    submit_typed(std::get<SubmitTyped>(wish).answers, run);
}

void enter_code(const std::string& code, StudyRun& run) {
    run.note.clear();
    if (!plain(code)) return refuse_code(what_is_wrong(code), run);
    std::string alike;
    if (!kept(run, [&] { alike = spelled_alike(run.directory, code); })) return;
    if (!alike.empty()) {
        return refuse_code(
            alike + " is in this study. Enter that code, or one that differs by more than capitals or zeros.", run);
    }
    if (!kept(run, [&] { lock_code(code, run); })) return;
    if (run.lock->held_elsewhere()) {
        run.lock.reset();
        run.code.clear();
        return refuse_code(code + " is in use at another screen; close the study there, or enter another code.", run);
    }
    auto withdrawal = study::Withdrawal::none;
    std::string successor;
    const bool good = kept(run, [&] {
        run.progress = study::progress_of(run.directory, run.protocol, code);
        withdrawal = study::withdrawal_of(run.directory, code);
        successor = study::replaced_by(run.directory, code);
    });
    if (!good) return;
    if (withdrawal != study::Withdrawal::none) {
        run.lock.reset();
        return refuse_code(code + " has withdrawn from the study; enter a new code.", run);
    }
    if (!successor.empty()) {
        run.lock.reset();
        return refuse_code(words_of_replaced(code, successor), run);
    }
    run.code = code;
    if (!kept(run, [&] { find_comparison(run); })) return;
    run.rested = false;
    run.consented = false;
    run.told.reset();
    run.choices.reset();  // each person's choices go to files of their own
    if (run.progress.known && !run.progress.next && !to_rate(run)) {
        run.lock.reset();
        return refuse_code(code + " has finished all trials; enter a new code.", run);
    }
    if (run.progress.known) return enter(step::Again{}, run);
    go_on(run);
}

void same_person(bool is, StudyRun& run) {
    if (is) return go_on(run);
    change_step(step::Code{}, run);
    run.code.clear();
    run.lock.reset();
}

void submit_answers(const std::vector<std::string>& answers, StudyRun& run) {
    const auto* rated = std::get_if<step::Ratings>(&run.step);
    if (rated == nullptr) {
        if (kept(run, [&] { add_person(answers, run); })) go_on(run);
        return;
    }
    std::vector<study::Rating> ratings;
    for (std::size_t i = 0; i < run.protocol.ratings.size(); ++i) {
        const bool answered = i < answers.size() && !answers[i].empty();
        ratings.push_back(
            {run.protocol.conditions[rated->condition].id, run.protocol.ratings[i].id, answered ? answers[i] : "n/a"});
    }
    run.unkept_answers = true;
    if (kept(run, [&] { study::add_ratings(run.directory, run.code, ratings); })) go_on(run);
}

void begin_step(StudyRun& run) {
    if (at<step::Pause>(run)) {
        run.rested = true;
        return go_on(run);
    }
    if (at<step::Told>(run) || at<step::Feedback>(run)) return finish_due(run);
    const auto* device = std::get_if<step::Device>(&run.step);
    if (device == nullptr) return begin_trial_step(run);
    if (device->here && !left_elsewhere(run)) enter(step::Trial{}, run);  // in a forced choice, the same interval
}

void wait_for_device(bool left, StudyRun& run) { enter(step::Device{.left = left}, run); }

void repeat_untouched(StudyRun& run) { enter(step::Device{.untouched = true}, run); }

void repeat_unseen(StudyRun& run) { enter(step::Device{.unseen = true}, run); }

void repeat_without_level(StudyRun& run) { enter(step::Device{.left = true, .no_level = true}, run); }

void give_feedback(int found, int missed, int false_marks, StudyRun& run) {
    enter(step::Feedback{found, found + missed, false_marks}, run);
}

void trial_finished(StudyRun& run) {
    if (!due_compares(run)) return finish_due(run);
    interval_presented(run);
}

void interval_presented(StudyRun& run) {
    if (run.interval == 1) return enter(step::Question{}, run);
    run.interval = 1;
    if (shows_tissue(run)) return enter(step::Trial{}, run);
    enter(step::Present{}, run);
}

void choose_softer(bool first, double now_s, StudyRun& run) {
    study::ChoiceRow row = due_choice(run, first);
    row.duration_s = now_s - run.step_began_s;
    const bool good = kept(run, [&] {
        if (!run.choices) {
            run.choices =
                std::make_unique<study::ChoiceLog>(study::next_run(run.directory, run.code, "softer", run.first_run));
            run.choices_began_s = run.step_began_s;
        }
        row.onset_s = run.step_began_s - run.choices_began_s;  // of the question
        if (!run.choices->write(row))
            throw std::runtime_error(run.directory.string() +
                                     ": the choice could not be written; the study has stopped");
    });
    run.unkept_answers = true;
    if (!good) return;
    if (due_trial(run).practice) return enter(step::Told{row.correct == 1}, run);
    finish_due(run);
}

void submit_typed(const study::TypedAnswers& typed, StudyRun& run) {
    const study::PlannedTrial& trial = due_trial(run);
    const bool good = kept(run, [&] {
        study::TrialLabel label = label_of(run.protocol, run.progress.plan, trial, run.identities[trial.condition]);
        const study::RunFiles files = study::next_run(run.directory, run.code, "palpation", run.first_run);
        run.unkept_runs.push_back(files);
        study::write_typed_trial(files, label, trial.practice, trial.seed, due_nodules(run), typed);
    });
    if (!good) return;
    if (trial.practice) return give_feedback(found_of(typed), missed_of(typed), typed.false_marks, run);
    finish_due(run);
}

void stop_study(const std::string& why, StudyRun& run) {
    change_step(step::Stopped{why}, run);
    if (run.code.empty()) return;
    try {
        write_now(run);  // for the experimenter
    } catch (const std::exception&) {
        // the disk itself stopped the study; the participant's screen says so
    }
}

}  // namespace palpa::app
