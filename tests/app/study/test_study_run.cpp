// The steps of a study with people, without a screen.

#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <map>

#include "app/study/study_run.h"
#include "files/folder_lock.h"
#include "files/input_error.h"
#include "files/table.h"
#include "files/text.h"
#include "scene/advance.h"
#include "study/exclusions.h"
#include "study/ratings.h"
#include "study/read_logs.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::platform;
using namespace palpa::stiffnessmaps;
using namespace palpa::scene;
using namespace palpa::study;
using namespace palpa::session;
using namespace palpa::app;
using namespace palpa::test;

namespace {

const std::string kScene = PALPA_SOURCE_DIR "/assets/scenes/default.json";

Protocol find_protocol(const TemporaryFolder& folder) {
    write_text_atomically(folder / "p.json",
                          R"({"name": "n", "version": "1", "seed": 1, "order": "fixed", "time_limit_s": 60,
        "practice": {"trials": 1}, "break_every_trials": 1, "instructions": "Find them.",
        "conditions": [{"id": "pen", "modality": "pen", "scene": ")" +
                              kScene + R"("},
                       {"id": "hand", "modality": "hand", "nodules": ["A", "B"]}],
        "demographics": [{"id": "age", "text": "Age", "from": 0, "to": 100}, {"id": "shoes", "text": "Shoes", "choices": ["a", "b"]}],
        "ratings": [{"id": "effort", "text": "It was tiring.", "from": 1, "to": 7}]})");
    return read_protocol(folder / "p.json");
}

// The trial on the tissue as the loop runs it: a mark on nodule A, then the end.
void run_trial(StudyRun& run) {
    REQUIRE(trial_waits(run));
    std::get<step::Trial>(run.step).begun = true;
    Session session;
    session.scene = scene_of(due_scene(run), due_trial(run));
    session.plan = due_scene(run).plan;
    const TrialMode mode = due_trial(run).practice ? TrialMode::practice : TrialMode::test;
    begin_trial(due_files(run), {1280.0, 800.0, kMissing, kMissing, "pen"}, mode, session);
    Sample sample;
    sample.phase = Phase::ui;
    sample.action = Action::mark;
    const Nodule& nodule = session.plan->nodules[0];
    const Eigen::Vector2d px = px_of_tissue(session.state.view, {nodule.x_m, nodule.y_m});
    sample.x_px = px.x();
    sample.y_px = px.y();
    take_sample(sample, session);
    sample.t_host_s = 30.0;
    sample.action = Action::finish;
    take_sample(sample, session);
    REQUIRE(session.trial.finished);
    REQUIRE(close_files({}, session));
    trial_finished(run);
}

void answer_questions(StudyRun& run) {
    REQUIRE(at<step::Questions>(run));
    submit_answers({"33", "b"}, run);
}

void rate(StudyRun& run, const std::string& effort) {
    REQUIRE(at<step::Ratings>(run));
    submit_answers({effort}, run);
}

}  // namespace

TEST_CASE("study run: from the code to the thanks, everything in the log") {
    const TemporaryFolder folder;
    const auto log = folder / "log";
    StudyRun run = open_study_run(find_protocol(folder), log, "");
    CHECK(at<step::Code>(run));
    CHECK(free_code(run) == "01");
    enter_code("P 7", run);
    CHECK(at<step::Code>(run));
    CHECK(run.note == "Enter up to 20 letters and digits.");
    enter_code("", run);
    CHECK(run.note == "Enter a code of up to 20 letters and digits.");
    enter_code("P7", run);
    answer_questions(run);
    REQUIRE(run.progress.plan.trials.size() == 4);  // practice and test under each condition
    std::string steps;
    for (int i = 0; !at<step::Done>(run) && i < 30; ++i) {
        steps += name_of(run.step) + std::string(" ");
        if (at<step::Instructions>(run) || at<step::Pause>(run)) {
            begin_step(run);
        } else if (const auto* told = std::get_if<step::Feedback>(&run.step)) {  // of what was typed in
            CHECK(told->found == 1);
            CHECK(told->nodules == 2);
            begin_step(run);
        } else if (at<step::Trial>(run)) {
            run_trial(run);
        } else if (at<step::Typed>(run)) {
            TypedAnswers typed;
            typed.nodules = {4, kMissed};
            typed.duration_s = 12.0;
            submit_typed(typed, run);
        } else {
            rate(run, "6");
        }
    }
    CHECK(
        steps ==
        "instructions trial instructions trial ratings pause instructions typed feedback instructions typed ratings ");
    CHECK(read_text(log / "participants.tsv").find("sub-P7\t33\tn/a\tn/a\tn/a\tn/a\tn/a\tall\n") != std::string::npos);
    const Observations seen = read_study(log);
    CHECK(seen.notes.empty());
    CHECK(seen.trials.size() == 2);
    CHECK(seen.practice_trials == 2);
    REQUIRE(seen.answers.size() == 3);
    CHECK(seen.answers[0].item == "shoes");
    CHECK(seen.answers[2].condition == "hand");
    const Json settings = read_json(log / "sub-P7/beh/sub-P7_task-palpation_run-02_settings.json");
    CHECK(settings["study"]["map_sha256"].contains("normal_N.npy"));
    CHECK(settings["study"].contains("simulated") == false);
    CHECK(read_json(log / "sub-P7/now.json")["step"] == "done");
    same_person(false, run);  // the next one
    CHECK(contains(message_of([&] { open_study_run(find_protocol(folder), log, "P7"); }),
                   "found 'P7', who has finished all trials"));
    enter_code("P7", run);
    CHECK(contains(run.note, "enter a new code"));
    CHECK(free_code(run) == "02");
}

TEST_CASE("study run: practice tells what was found, a rating names what is rated, and the thanks let go of the code") {
    const TemporaryFolder folder;
    const auto log = folder / "log";
    StudyRun run = open_study_run(find_protocol(folder), log, "P8");
    const auto now = [&] { return read_json(log / "sub-P8/now.json"); };
    answer_questions(run);
    begin_step(run);
    REQUIRE(due_trial(run).practice);
    std::get<step::Trial>(run.step).begun = true;
    give_feedback(2, 1, 4, run);
    REQUIRE(at<step::Feedback>(run));
    CHECK(now()["finished"] == finished_count(run));  // what watch shows counts the trial that is told of
    CHECK(finished_count(run) == run.progress.finished.size() + 1);
    CHECK(std::get<step::Feedback>(run.step).found == 2);
    CHECK(std::get<step::Feedback>(run.step).nodules == 3);
    CHECK(std::get<step::Feedback>(run.step).false_positives == 4);
    CHECK(now()["step"] == "feedback");
    begin_step(run);
    REQUIRE(at<step::Instructions>(run));
    CHECK_FALSE(due_trial(run).practice);
    begin_step(run);
    run_trial(run);
    REQUIRE(at<step::Ratings>(run));
    CHECK(now()["rated"] == "pen");
    CHECK_FALSE(now().contains("condition"));  // that of the next trial
    rate(run, "6");
    for (int i = 0; !at<step::Done>(run) && i < 10; ++i) {
        CHECK(is_folder_locked(log / "sub-P8"));
        if (at<step::Typed>(run)) {
            TypedAnswers typed;
            typed.nodules = {4, kMissed};
            typed.duration_s = 12.0;
            submit_typed(typed, run);
        } else if (at<step::Ratings>(run)) {
            rate(run, "6");
        } else {
            begin_step(run);
        }
    }
    REQUIRE(at<step::Done>(run));
    CHECK_FALSE(is_folder_locked(log / "sub-P8"));
}

TEST_CASE("study run: what a keeper has to take is told, and run numbers that are taken elsewhere stay free") {
    const TemporaryFolder folder;
    const auto log = folder / "log";
    StudyRun run = open_study_run(find_protocol(folder), log, "");
    run.first_run = 21;
    enter_code("P7", run);
    CHECK_FALSE(run.unkept_answers);
    answer_questions(run);
    CHECK(run.unkept_answers);  // the person's line, too
    for (int i = 0; i < 2; ++i) {
        begin_step(run);
        CHECK(due_files(run).first_run == 21);
        run_trial(run);
    }
    run.unkept_answers = false;
    rate(run, "6");
    CHECK(run.unkept_answers);
    CHECK(run.unkept_runs.empty());
    REQUIRE(at<step::Pause>(run));
    begin_step(run);
    begin_step(run);
    REQUIRE(at<step::Typed>(run));
    TypedAnswers typed;
    typed.nodules = {kMissed, kMissed};
    typed.duration_s = 12.0;
    submit_typed(typed, run);
    REQUIRE(run.unkept_runs.size() == 1);
    CHECK(run.unkept_runs[0].stem == "sub-P7_task-palpation_run-23");
}

TEST_CASE("study run: a crash in the middle of a trial costs that trial, nothing else") {
    const TemporaryFolder folder;
    const auto log = folder / "log";
    {
        StudyRun run = open_study_run(find_protocol(folder), log, "07");
        answer_questions(run);
        begin_step(run);
        run_trial(run);
        begin_step(run);
        REQUIRE(at<step::Trial>(run));
        Session session;  // begun, never finished
        session.scene = scene_of(due_scene(run), due_trial(run));
        session.plan = due_scene(run).plan;
        begin_trial(due_files(run), {1280.0, 800.0, kMissing, kMissing, "pen"}, TrialMode::test, session);
    }
    StudyRun again = open_study_run(find_protocol(folder), log, "07");
    CHECK(at<step::Again>(again));
    CHECK(again.progress.finished == std::set<int>{1});
    same_person(true, again);
    CHECK(at<step::Instructions>(again));
    CHECK(due_trial(again).trial == 2);
    begin_step(again);
    run_trial(again);
    CHECK(at<step::Ratings>(again));  // asked once the condition is done
    same_person(false, again);        // left before they are answered
    const Observations seen = read_study(log);
    CHECK(seen.interrupted_trials == 1);
    CHECK(seen.trials.size() == 1);

    StudyRun before_rating = open_study_run(find_protocol(folder), log, "07");
    same_person(true, before_rating);
    CHECK(at<step::Ratings>(before_rating));
}

TEST_CASE("study run: forced choices, both surfaces harder and softer versions of one tissue") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 4, "order": "fixed",
        "conditions": [{"id": "pen", "modality": "pen", "scene": ")" +
                                                 kScene + R"("}],
        "choice": {"reference_kPa": 10, "comparisons_kPa": [5, 20], "repeats": 2}})");
    const Protocol protocol = read_protocol(folder / "p.json");
    StudyRun run = open_study_run(protocol, folder / "log", "01");
    REQUIRE(run.stimuli[0].size() == 3);
    for (const StudyScene& stimulus : run.stimuli[0]) CHECK(stimulus.plan == run.scenes[0]->plan);  // one for all
    const auto depth_m = [&](std::size_t i, double force_scale) {
        Scene scene = run.stimuli[0][i].scene;
        scene.force_scale = force_scale;
        State state = start(scene, *run.stimuli[0][i].plan, {1280, 800});
        Sample press;
        press.phase = Phase::down;
        press.x_px = px_of_tissue(state.view, {0.06, 0.06}).x();
        press.y_px = px_of_tissue(state.view, {0.06, 0.06}).y();
        press.pressure = 0.1;
        advance(scene, *run.stimuli[0][i].plan, press, state);
        return state.contact.depth_m;
    };
    REQUIRE(depth_m(0, 1.0) > 0.0);
    CHECK(depth_m(1, 1.0) > 1.2 * depth_m(0, 1.0));  // half the modulus
    CHECK(depth_m(2, 1.0) < depth_m(0, 1.0) / 1.2);
    // half the force on half the modulus: the same depth
    CHECK(depth_m(1, 0.5) == close_to(depth_m(0, 1.0)).epsilon(1e-5));
    CHECK(run.stimuli[0][1].plan->zone_N == run.stimuli[0][0].plan->zone_N);  // the force bar tells nothing
    CHECK(run.stimuli[0][1].plan->greatest_force_N == run.stimuli[0][0].plan->greatest_force_N);

    REQUIRE(at<step::Instructions>(run));
    begin_step(run);
    int pairs = 0;
    for (; !at<step::Done>(run) && pairs < 10; ++pairs) {
        REQUIRE(at<step::Trial>(run));
        const PlannedTrial trial = due_trial(run);
        const bool reference_first = &due_scene(run) == &run.stimuli[0][0];
        CHECK(reference_first == trial.reference_first);
        run_trial(run);
        CHECK(run.interval == 1);
        CHECK((&due_scene(run) == &run.stimuli[0][0]) != reference_first);
        run_trial(run);
        REQUIRE(at<step::Question>(run));
        run.step_began_s = 5.0 + 10.0 * pairs;
        const bool comparison_softer = trial.comparison == 0;
        choose_softer(comparison_softer != reference_first, 7.5 + 11.0 * pairs, run);  // always right
    }
    CHECK(pairs == 4);
    files::Table events = files::read_tsv(folder / "log/sub-01/beh/sub-01_task-softer_run-01_events.tsv");
    for (int pair = 0; events.next(); ++pair) {
        CHECK(events.finite_number(events.column("onset")) == close_to(10.0 * pair));
        CHECK(events.finite_number(events.column("duration")) == close_to(2.5 + pair));
    }
    const Observations seen = read_study(folder / "log");
    CHECK(seen.interrupted_trials == 0);
    REQUIRE(seen.choices.size() == 4);
    for (const Choices& choice : seen.choices) CHECK(choice.correct == 1);
    CHECK(std::filesystem::exists(folder / "log/sub-01/beh/sub-01_task-interval_run-08_samples.tsv"));
}

TEST_CASE("study run: a trial waits for its device, and one that the device left begins anew") {
    const TemporaryFolder folder;
    const auto log = folder / "log";
    StudyRun run = open_study_run(find_protocol(folder), log, "");
    enter_code("07", run);
    answer_questions(run);
    begin_step(run);
    REQUIRE(trial_waits(run));
    wait_for_device(false, run);
    CHECK_FALSE(trial_waits(run));
    CHECK(read_json(log / "sub-07/now.json")["step"] == "device");
    begin_step(run);  // not here yet
    CHECK(at<step::Device>(run));
    std::get<step::Device>(run.step).here = true;
    begin_step(run);
    REQUIRE(trial_waits(run));
    const int due = due_trial(run).trial;
    wait_for_device(true, run);
    CHECK(std::get<step::Device>(run.step).left);
    std::get<step::Device>(run.step).here = true;
    begin_step(run);
    CHECK(due_trial(run).trial == due);
    run_trial(run);
    CHECK(run.progress.finished == std::set<int>{due});
}

TEST_CASE("study run: a number that is asked for is one whole number in its range, or left open") {
    Item item;
    item.from = 0;
    item.to = 100;
    for (const char* good : {"", "0", "33", "100"}) CHECK(is_answer(item, good));
    for (const char* bad : {"33.5", "30-40", "30-4*", "3+4", "-1", "101", ".", "1 2", "nan"}) {
        CAPTURE(bad);
        CHECK_FALSE(is_answer(item, bad));
    }
    item.from.reset();
    item.to.reset();
    CHECK(is_answer(item, "30-40"));  // a text
}

TEST_CASE("study run: all that a participant reads is among the texts whose letters are checked and drawn") {
    Protocol protocol;
    Item scale;
    scale.text = "a";
    scale.low = "b";
    scale.high = "c";
    protocol.demographics.push_back(scale);
    scale.choices = {"d"};
    protocol.ratings.push_back(scale);
    CHECK(letters_of(protocol) == "abcabcd");
}

TEST_CASE("study run: forced choices without a scene are presented by the experimenter, who is told what") {
    const TemporaryFolder folder;
    StudyRun run =
        open_study_run(read_protocol(PALPA_SOURCE_DIR "/assets/protocols/softer.json"), folder / "log", "01");
    begin_step(run);
    REQUIRE(at<step::Present>(run));
    const Json now = read_json(folder / "log/sub-01/now.json");
    const PlannedTrial trial = due_trial(run);
    CHECK(now["present_kPa"][trial.reference_first ? 0 : 1] == 1.75);
    interval_presented(run);
    CHECK(at<step::Present>(run));
    interval_presented(run);
    CHECK(at<step::Question>(run));
    choose_softer(true, 1.0, run);
    CHECK(run.progress.finished.size() == 1);
    CHECK(read_json(folder / "log/sub-01/now.json")["interval"] == 1);  // of the next pair
}

TEST_CASE("study run: with reference_on every reference is presented under that condition") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 1, "order": "fixed",
        "conditions": [{"id": "real", "modality": "hand"}, {"id": "shown", "modality": "shape-display"}],
        "choice": {"reference_kPa": 1, "comparisons_kPa": [0.5, 2], "repeats": 2, "reference_on": "real"}})");
    StudyRun run = open_study_run(read_protocol(folder / "p.json"), folder / "log", "01");
    for (int pairs = 0; !at<step::Done>(run) && pairs < 20; ++pairs) {
        if (at<step::Instructions>(run)) begin_step(run);
        REQUIRE(at<step::Present>(run));
        const PlannedTrial trial = due_trial(run);
        for (const bool first : {true, false}) {
            const std::string expected = first == trial.reference_first || trial.condition == 0 ? "real" : "shown";
            CHECK(due_condition(run).id == expected);
            CHECK(read_json(folder / "log/sub-01/now.json")["condition"] == expected);
            interval_presented(run);
        }
        choose_softer(trial.reference_first, 1.0 + pairs, run);  // the reference is always called softer
    }
    const Observations seen = read_study(folder / "log");
    REQUIRE(seen.stiffer.size() == 8);
    for (const StifferAnswers& answers : seen.stiffer) {
        CHECK(answers.axis == StiffnessAxis::comparison_reference);
        CHECK(answers.stiffer == 1);
        CHECK(std::abs(answers.x) == close_to(std::log(2.0)));
    }
    CHECK(seen.conditions == std::vector<std::string>{"real", "shown"});
}

TEST_CASE("study run: a folder that cannot be written stops the study in words, before a trial is lost") {
    const TemporaryFolder folder;
    const auto log = folder / "log";
    StudyRun run = open_study_run(find_protocol(folder), log, "");
    write_text_atomically(log / "sub-09", "a file where the folder would be");
    enter_code("09", run);
    CHECK(at<step::Stopped>(run));
    CHECK_FALSE(std::get<step::Stopped>(run.step).why.empty());
    CHECK(
        contains(message_of([&] { open_study_run(find_protocol(folder), log, "a b"); }), "--participant: found 'a b'"));
}

namespace {

Protocol thresholds(const TemporaryFolder& folder) {
    write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 4, "order": "fixed",
        "consent": "You press on surfaces.", "practice": {"trials": 1},
        "conditions": [{"id": "find", "modality": "pen", "task": "find", "scene": ")" +
                                                 kScene + R"("},
                       {"id": "steps", "modality": "pen", "task": "staircase", "scene": ")" +
                                                 kScene + R"("},
                       {"id": "pairs", "modality": "hand", "task": "choice"}],
        "choice": {"reference_kPa": 10, "comparisons_kPa": [5, 20], "repeats": 1},
        "staircase": {"method": "weighted-up-down", "reference_kPa": 10, "comparisons_kPa": [12, 14, 17, 20], "trials": 4}})");
    return read_protocol(folder / "p.json");
}

// How many surfaces of pairs the log calls practice, and how many test.
std::map<std::string, int> blocks_of_pairs(const std::filesystem::path& folder) {
    std::map<std::string, int> count;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (!contains(name, "_task-interval_") || !contains(name, "_events.tsv")) continue;
        Table table = read_tsv(entry.path());
        const std::size_t block = table.column("block");
        if (table.next()) ++count[std::string(table.field(block))];
    }
    return count;
}

// Carries out one step. A pair is answered rightly where the levels differ by half or more.
void one_step(StudyRun& run) {
    if (at<step::Instructions>(run) || at<step::Told>(run)) return begin_step(run);
    if (at<step::Present>(run)) return interval_presented(run);
    if (at<step::Trial>(run)) return run_trial(run);
    REQUIRE(at<step::Question>(run));
    const double kPa = due_comparison_kPa(run);
    const bool right = kPa >= 15.0 || kPa < 7.0;
    const bool first_softer = due_trial(run).reference_first == (kPa > 10.0);
    choose_softer(first_softer == right, 1.0, run);
}

}  // namespace

TEST_CASE("study run: consent comes first; finding, a staircase and choices follow in one session") {
    const TemporaryFolder folder;
    const auto log = folder / "log";
    StudyRun run = open_study_run(thresholds(folder), log, "07");
    REQUIRE(at<step::Consent>(run));
    carry_out(GiveConsent{false}, run);
    CHECK(at<step::Code>(run));
    CHECK(contains(run.note, "nothing was kept"));
    CHECK_FALSE(std::filesystem::exists(log / "sub-07"));
    CHECK_FALSE(std::filesystem::exists(log / "participants.tsv"));
    enter_code("07", run);
    carry_out(GiveConsent{true}, run);
    CHECK(contains(read_text(log / "sub-07/beh/sub-07_task-ratings_beh.tsv"), "n/a\tconsent\tgiven\n"));
    std::string steps, levels;
    int practised = 0, tested = 0;  // surfaces of pairs that were felt
    for (int i = 0; !at<step::Done>(run) && i < 80; ++i) {
        if (at<step::Question>(run) && due_condition(run).id == "steps" && !due_trial(run).practice)
            levels += std::to_string(run.comparison);
        if (at<step::Trial>(run) && due_compares(run)) {
            ++(due_trial(run).practice ? practised : tested);
            CHECK(&due_scene(run) == &run.stimuli[1][(run.interval == 0) == due_trial(run).reference_first
                                                         ? 0
                                                         : 1 + static_cast<std::size_t>(run.comparison)]);
        }
        steps += name_of(run.step) + std::string(" ");
        one_step(run);
        if (i == 20) {         // a crash between two pairs loses nothing
            run.lock.reset();  // the app was closed
            run = open_study_run(thresholds(folder), log, "07");
            same_person(true, run);
        }
    }
    CHECK(at<step::Done>(run));
    CHECK(contains(steps, "instructions trial instructions trial instructions trial trial question told "));
    CHECK(levels == "3213");  // 20 and 17 kPa were felt, 14 kPa was not
    CHECK(practised > 0);
    CHECK(blocks_of_pairs(log / "sub-07/beh") == std::map<std::string, int>{{"practice", practised}, {"test", tested}});
    const Observations seen = read_study(log);
    CHECK(seen.trials.size() == 1);
    CHECK(seen.practice_trials == 3);
    CHECK(seen.choices.size() == 2);  // answers of staircases are no shares of right answers
    REQUIRE(seen.staircases.size() == 1);
    CHECK(seen.staircases[0].estimate.trials == 4);
}

TEST_CASE("study run: who stops is asked about the data, and is left out where they are withdrawn") {
    const TemporaryFolder folder;
    const auto log = folder / "log";
    StudyRun run = open_study_run(find_protocol(folder), log, "");
    for (const char* code : {"01", "02", "03"}) {
        enter_code(code, run);
        answer_questions(run);
        begin_step(run);
        run_trial(run);
        begin_step(run);
        run_trial(run);
        rate(run, "6");
        REQUIRE(at<step::Pause>(run));
        carry_out(WantToLeave{}, run);
        CHECK(at<step::Leaving>(run));
        if (code == std::string("03")) break;
        const bool first = code == std::string("01");
        carry_out(LeaveStudy{first ? Withdrawal::keeps_data : Withdrawal::takes_data}, run);
        CHECK(at<step::Withdrawn>(run));
        CHECK(read_json(log / ("sub-" + std::string(code)) / "now.json")["step"] == "withdrawn");
        same_person(false, run);
    }
    carry_out(LeaveStudy{Withdrawal::none}, run);
    CHECK(at<step::Pause>(run));  // goes on where it was
    const Observations seen = read_study(log);
    CHECK(seen.participants == std::vector<std::string>{"01", "03"});
    REQUIRE(seen.notes.size() == 2);
    CHECK(seen.notes[0] == "sub-01: withdrew from the study; the data may be used");
    CHECK(contains(seen.notes[1], "sub-02: withdrew from the study; the data are left out"));
    enter_code("02", run);
    CHECK(contains(run.note, "02 has withdrawn from the study"));
    CHECK(contains(message_of([&] { open_study_run(find_protocol(folder), log, "02"); }),
                   "who has withdrawn from the study"));
}

TEST_CASE("study run: a withdrawal that the experimenter notes meanwhile ends the study before the next trial") {
    const TemporaryFolder folder;
    const auto log = folder / "log";
    StudyRun run = open_study_run(find_protocol(folder), log, "01");
    answer_questions(run);
    REQUIRE(at<step::Instructions>(run));
    SUBCASE("while the instructions are read") {
        withdraw(log, "01", Withdrawal::takes_data);
        begin_step(run);
        CHECK(at<step::Withdrawn>(run));
    }
    SUBCASE("while a trial that is to be repeated waits for Start") {
        begin_step(run);
        repeat_untouched(run);
        std::get<step::Device>(run.step).here = true;
        withdraw(log, "01", Withdrawal::takes_data);
        begin_step(run);
        CHECK(at<step::Withdrawn>(run));
    }
    SUBCASE("during a trial, which is kept") {
        begin_step(run);
        REQUIRE(at<step::Trial>(run));
        withdraw(log, "01", Withdrawal::keeps_data);
        run_trial(run);
        CHECK(at<step::Withdrawn>(run));
        CHECK(run.progress.finished.size() == 1);
    }
    CHECK(read_json(log / "sub-01/now.json")["step"] == "withdrawn");
}

TEST_CASE("study run: who was replaced does not go on, now or later") {
    const TemporaryFolder folder;
    const auto log = folder / "log";
    StudyRun run = open_study_run(find_protocol(folder), log, "01");
    answer_questions(run);
    begin_step(run);
    REQUIRE(at<step::Trial>(run));
    add_replacement(log, {"01", "02", "felt unwell"});
    run_trial(run);
    const std::string replaced = "01 was replaced by 02; enter that code.";
    CHECK(at<step::Code>(run));
    CHECK(run.note == replaced);
    CHECK(finished_trials(log, "01").size() == 1);
    CHECK(contains(message_of([&] { open_study_run(find_protocol(folder), log, "01"); }), "who was replaced"));
    enter_code("01", run);
    CHECK(run.note == replaced);
    enter_code("02", run);
    CHECK(run.note.empty());
}

namespace {

// A protocol of two conditions on a shape display with this key `tactile` of the scene ("": none).
Protocol pins_protocol(const TemporaryFolder& folder, const std::string& tactile) {
    write_text_atomically(folder / "slab.json", R"({"size_mm": [40, 40, 20], "nodules": [],
        "tissue": {"young_Pa": 17500, "poisson": 0.45}, "indenter": {"shape": "sphere", "radius_mm": 8, "contact": "rolling"},
        "depths_mm": [1], "grid": {"origin_mm": [0, 0], "spacing_mm": [1, 1], "count": [2, 2]}})");
    write_text_atomically(folder / "slab-scene.json",
                          R"({"name": "slab", "tissue": {"linear": {"phantom": "slab.json", "spacing_mm": 4}})" +
                              (tactile.empty() ? "" : R"(, "tactile": )" + tactile) + "}");
    write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 1, "order": "fixed",
        "conditions": [{"id": "pins", "modality": "shape-display", "scene": "slab-scene.json"}],
        "choice": {"reference_kPa": 17.5, "comparisons_kPa": [20, 35], "repeats": 2}, "practice": {"trials": 1}})");
    return read_protocol(folder / "p.json");
}

}  // namespace

TEST_CASE(
    "study run: a shape-display condition whose scene has the key tactile is driven, and its surfaces are trials") {
    const TemporaryFolder folder;
    const Protocol protocol = pins_protocol(folder, R"({"display": {"device": "pins-6x6.json"}, "leads": "touch"})");
    StudyRun run = open_study_run(protocol, folder / "log", "01");
    begin_step(run);
    REQUIRE(trial_waits(run));
    CHECK_FALSE(typed_in(run, 0));
    CHECK(feels_device(run));
    CHECK(due_trial(run).practice);  // whose force bar shows the limit
    const auto scale = [&] { return due_scene(run).scene.stiffness_scale; };
    const bool reference_first = due_trial(run).reference_first;
    CHECK(scale() == close_to(reference_first ? 1.0 : 2.0));  // practice shows the pair that differs most
    std::get<step::Trial>(run.step).begun = true;
    trial_finished(run);
    REQUIRE(trial_waits(run));
    CHECK(scale() == close_to(reference_first ? 2.0 : 1.0));
}

TEST_CASE("study run: a shape-display condition without driven devices is presented by the experimenter, or refused") {
    const TemporaryFolder folder;
    StudyRun run = open_study_run(pins_protocol(folder, ""), folder / "log", "01");
    begin_step(run);
    CHECK(at<step::Present>(run));
    CHECK(typed_in(run, 0));
    const TemporaryFolder other;
    const Protocol drawn = pins_protocol(other, R"({"display": {}})");
    const std::string refused = message_of([&] { open_study_run(drawn, other / "log", "01"); });
    CHECK(contains(refused, "conditions[0] 'pins': scene: found 'slab-scene.json', whose key tactile names no device"));
}

TEST_CASE("study run: a tangible condition whose scene has a soft device is driven, and typed in without one") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "soft.json",
                          R"({"name": "soft", "tissue": {"map": ")" PALPA_SOURCE_DIR R"(/assets/maps/silicone.map"}})");
    write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 1, "order": "fixed",
        "conditions": [{"id": "device", "modality": "tangible", "scene": "soft.json"}]})");
    StudyRun run = open_study_run(read_protocol(folder / "p.json"), folder / "log", "01");
    CHECK(typed_in(run, 0));
    run.scenes[0]->scene.tangible.emplace();
    note_typed_in(run.scenes, run.protocol);
    CHECK_FALSE(typed_in(run, 0));
    begin_step(run);
    REQUIRE(trial_waits(run));
    CHECK(feels_device(run));
    CHECK(shows_tissue(run));
}

TEST_CASE("study run: the answers about a cast name the nodules of the phantom that it is cast from") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 1, "order": "fixed",
        "conditions": [{"id": "cast", "modality": "hand", "cast_of": "pen"},
                       {"id": "pen", "modality": "pen", "scene": ")" +
                                                 kScene + R"("}]})");
    StudyRun run = open_study_run(read_protocol(folder / "p.json"), folder / "log", "01");
    begin_step(run);
    REQUIRE(at<step::Typed>(run));
    CHECK(due_nodules(run) == std::vector<std::string>{"A", "B", "C"});
}
