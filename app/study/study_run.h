#pragma once
// A study with people, in the app: who is here, what comes next, what they answered. The loop owns it and runs its
// trials; app/screens/study_screen.cpp draws it. Everything that counts is on the disk before the next step.

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

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
    std::vector<std::vector<StudyScene>> stimuli;  // forced choices, by condition: the reference, then each comparison
    std::filesystem::path directory;
    StudyStep step;                           // the functions below change it
    int entered = 0;                          // steps so far: another number, another step
    double step_began_s = 0.0;                // window's clock, when it was first shown; 0: it was not yet
    std::string code;                         // of the participant
    std::unique_ptr<files::FolderLock> lock;  // of the participant's folder: the code is at one screen at a time
    std::string note;                         // why a code was not taken
    study::StudyProgress progress;
    int interval = 0;                 // of a choice: 0 or 1
    bool rested = false;              // the break before this trial is over
    std::optional<std::size_t> told;  // condition whose instructions were read last
    bool told_practice = false;
    std::unique_ptr<study::ChoiceLog> choices;
    double choices_began_s = 0.0;
    // For a keeper (session/keeper.h): what it has not been given yet, and what it reports.
    bool on_tablet = false;
    int first_run = 1;                         // of the log: those before are known to be taken
    std::vector<study::RunFiles> unkept_runs;  // typed trials
    bool unkept_answers = false;
    std::optional<double> keeping_since_s;  // the next step waits for it
    std::vector<std::string> warnings;
};

// Loads what the protocol names and opens the folder. Throws InputError (also for a code that has finished or is at
// another screen), or std::runtime_error if the folder cannot be written. `code` may be empty: then it is asked for.
StudyRun open_study_run(const study::Protocol& protocol, const std::filesystem::path& directory,
                        const std::string& code);

// The next free code: 01, 02, ...
std::string free_code(const StudyRun& run);

template <class Step>
bool at(const StudyRun& run) {
    return std::holds_alternative<Step>(run.step);
}
bool trial_waits(const StudyRun& run);    // the loop is to begin one
bool trial_goes_on(const StudyRun& run);  // on the tissue

// Does what the participant or the experimenter asked for.
void carry_out(const StudyWish& wish, StudyRun& run);

// Each of these functions leads to the next step, or says in run.note why it does not.
void enter_code(const std::string& code, StudyRun& run);
void same_person(bool is, StudyRun& run);
void submit_answers(const std::vector<std::string>& answers, StudyRun& run);  // of questions and ratings
void begin_step(StudyRun& run);                  // from instructions, a pause, or once the device is here
void wait_for_device(bool left, StudyRun& run);  // instead of a trial; left: in the middle of it
void trial_finished(StudyRun& run);              // it is on the disk
void interval_presented(StudyRun& run);
void choose_softer(bool first, double now_s, StudyRun& run);
void submit_typed(const study::TypedAnswers& typed, StudyRun& run);
void stop_study(const std::string& why, StudyRun& run);

// study_due.cpp: the trial that is due. Call these functions only while there is one (in the steps from instructions to typed).
const study::PlannedTrial& due_trial(const StudyRun& run);
const study::Condition& due_condition(const StudyRun& run);
bool typed_in(const study::Condition& condition);  // this program does not drive it
bool shows_tissue(const StudyRun& run);            // the due trial has a scene on this screen
const StudyScene& due_scene(const StudyRun& run);  // of shows_tissue()
session::SessionFiles due_files(const StudyRun& run);
double due_limit_s(const StudyRun& run);                         // 0: none
std::vector<std::string> due_nodules(const StudyRun& run);       // names, for typed answers
const std::vector<study::Item>& due_items(const StudyRun& run);  // of questions and ratings
// False: the item asks for a number, and this is none or outside its range. Left open is an answer.
bool is_answer(const study::Item& item, const std::string& answer);

// For example "3 of 8": the number of the due trial, tests and practice together.
std::string progress_text(const StudyRun& run);

}  // namespace palpa::app
