#pragma once
// A study with people, in the app: who takes part, what comes next, what they answered. The loop owns it and runs its
// trials; app/screens/study_screen.cpp draws it. Everything that counts is on the disk before the next step.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/study/study_device.h"
#include "app/study/study_scenes.h"
#include "app/study/study_step.h"
#include "files/folder_lock.h"
#include "session/session.h"
#include "study/study_folder.h"
#include "study/typed_trial.h"

namespace palpa::app {

struct StudyRun {
    study::Protocol protocol;
    StudyScenes scenes;                            // by condition
    std::vector<files::Json> identities;           // by condition
    std::vector<std::vector<StudyScene>> stimuli;  // of comparisons, by condition: the reference, then each level
    std::filesystem::path directory;
    StudyStep step;                           // only the functions below change it
    int entered = 0;                          // number of steps entered so far, which identifies a step
    double step_began_s = 0.0;                // window's clock when the step was first shown; 0: not yet
    std::string code;                         // of the participant
    std::unique_ptr<files::FolderLock> lock;  // of the participant's folder: the code is at one screen at a time
    std::string note;                         // why a code was refused
    study::StudyProgress progress;
    int comparison = -1;              // of the due trial, index in comparisons_kPa_of(); -1: nothing is compared
    int interval = 0;                 // of a comparison: 0 or 1
    bool consented = false;           // this participant has agreed to take part
    bool rested = false;              // the break before this trial is over
    std::optional<std::size_t> told;  // condition whose instructions were read last
    bool told_practice = false;
    std::unique_ptr<study::ChoiceLog> choices;
    double choices_began_s = 0.0;
    // For a keeper (session/keeper.h): what it has not been given yet, and what it reports.
    bool on_tablet = false;
    bool pressure_must_vary = false;  // a trial has ended because its pen, or finger, always sent the same
    PressureVerdict pressure = PressureVerdict::not_needed;  // of the due trial; set by the loop
    std::string devices_note;                  // why arm and pins of the due trial do not run; set by the loop
    int first_run = 1;                         // first run number of the log that may be free
    std::vector<study::RunFiles> unkept_runs;  // typed trials
    bool unkept_answers = false;
    std::optional<double> keeping_since_s;  // the next step waits for the keeper
    std::vector<std::string> warnings;
    std::string where;  // where the trials of a participant who has finished or withdrawn are, for people
};

// Loads what the protocol names and opens the folder. Throws InputError (also for a code that has finished or is at another screen), and
// std::runtime_error if the folder cannot be written. If `code` is empty, the first step asks for it.
StudyRun open_study_run(const study::Protocol& protocol, const std::filesystem::path& directory,
                        const std::string& code);

// Returns the next free code: 01, 02, ..., after the highest that is a number.
std::string free_code(const StudyRun& run);

template <class Step>
bool at(const StudyRun& run) {
    return std::holds_alternative<Step>(run.step);
}
bool trial_waits(const StudyRun& run);    // the loop must begin the trial
bool trial_goes_on(const StudyRun& run);  // a trial on the tissue is in progress

// Carries out what the participant or the experimenter asked for.
void carry_out(const StudyWish& wish, StudyRun& run);

// Each of these functions goes to the next step, or says in run.note why it does not.
void enter_code(const std::string& code, StudyRun& run);
void same_person(bool is, StudyRun& run);
void submit_answers(const std::vector<std::string>& answers, StudyRun& run);  // of questions and ratings
void begin_step(StudyRun& run);                                               // see BeginStep
void wait_for_device(bool left, StudyRun& run);  // instead of a trial; left: the device went during it
void repeat_without_level(StudyRun& run);        // the touches of the trial gave no force
void repeat_untouched(StudyRun& run);            // the trial's time was over before anything was touched
void repeat_unseen(StudyRun& run);               // it was over while the app was out of sight
void trial_finished(StudyRun& run);              // the trial is on the disk
// The same for practice, which tells what was found.
void give_feedback(int found, int missed, int false_marks, StudyRun& run);
void interval_presented(StudyRun& run);
void choose_softer(bool first, double now_s, StudyRun& run);
void submit_typed(const study::TypedAnswers& typed, StudyRun& run);
void stop_study(const std::string& why, StudyRun& run);

// study_consent.cpp: who takes part, and who stops.
void answer_consent(bool given, StudyRun& run);
// Removes what tells the experimenter where a person is who has not agreed. Nothing else of this person is on the disk.
void forget_unasked(const StudyRun& run);
void want_to_leave(StudyRun& run);
void leave_study(study::Withdrawal how, StudyRun& run);
// True, and the participant has stopped, if the experimenter noted a withdrawal or a replacement meanwhile (palpa study
// withdraw, replace), or if that cannot be read. After a replacement the next code is asked for.
bool left_elsewhere(StudyRun& run);
std::string words_of_replaced(const std::string& code, const std::string& successor);

// For these files alone. kept() runs `work`; an exception, such as a problem with the disk, stops the study with a
// message before a trial is lost.
void enter(StudyStep step, StudyRun& run);
void go_on(StudyRun& run);
bool kept(StudyRun& run, const std::function<void()>& work);
void find_comparison(StudyRun& run);  // of the due trial; in a staircase it follows from the answers on the disk

// study_due.cpp: the trial that is due. To be called only while there is one (in the steps from instructions to typed).
const study::PlannedTrial& due_trial(const StudyRun& run);
// The condition of the trial; of a forced choice, that of the interval that is due (choice.reference_on).
std::size_t due_condition_index(const StudyRun& run);
const study::Condition& due_condition(const StudyRun& run);
// The program does not drive the device of this condition: answers are typed in, and the experimenter presents surfaces.
bool typed_in(const StudyRun& run, std::size_t condition);
bool feels_device(const StudyRun& run);            // the due trial is on a force arm, a shape display or a soft device
bool shows_tissue(const StudyRun& run);            // the due trial has a scene on this screen
bool due_compares(const StudyRun& run);            // a trial is due, and two surfaces are compared in it
double due_comparison_kPa(const StudyRun& run);    // needs due_compares()
const StudyScene& due_scene(const StudyRun& run);  // needs shows_tissue()
session::SessionFiles due_files(const StudyRun& run);
study::ChoiceRow due_choice(const StudyRun& run, bool first_is_softer);  // without times; views into `run`
double due_limit_s(const StudyRun& run);                                 // time limit; 0: none
std::vector<std::string> due_nodules(const StudyRun& run);               // names of its nodules, for typed answers
const std::vector<study::Item>& due_items(const StudyRun& run);          // of the step of questions or ratings
// False if the item asks for a number and the answer is none or outside its range. An empty answer is one.
bool is_answer(const study::Item& item, const std::string& answer);

// Trials that are on the disk, also the one whose result is being told.
std::size_t finished_count(const StudyRun& run);

// Returns what the experimenter sees from elsewhere (palpa study watch).
files::Json now_json(const StudyRun& run);

// What the protocol puts on the screens, each with its key or id for messages; and all of it in one text.
struct ShownText {
    std::string key, text;
};
std::vector<ShownText> shown_texts(const study::Protocol& protocol);
std::string letters_of(const study::Protocol& protocol);

// Returns, for example, "3 of 8": the number of the due trial, tests and practice together.
std::string progress_text(const StudyRun& run);

}  // namespace palpa::app
