#pragma once
// A study with people, in the app: who is here, what comes next, what they answered. app/screens/study_screen.cpp draws
// it, and the loop runs its trials. Everything that counts is on the disk before the next step.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/study/study_scenes.h"
#include "session/session.h"
#include "study/study_folder.h"
#include "study/typed_trial.h"

namespace palpa::app {

enum class StudyStep : std::uint8_t {
    code,       // who is here
    again,      // a code that is known: is it the same person?
    questions,  // before the trials
    instructions,
    trial,     // on the tissue; of a choice, one of the two intervals
    device,    // the trial is due, and what it is done with is not connected
    present,   // an interval that the experimenter presents
    question,  // which was softer
    typed,     // the experimenter types what was said
    ratings,   // after a condition
    pause,
    done,
    stopped,  // it cannot go on: `stopped` says why
};
const char* name_of(StudyStep step);

struct StudyRun {
    study::Protocol protocol;
    StudyScenes scenes;                            // by condition
    std::vector<files::Json> identities;           // by condition
    std::vector<std::vector<StudyScene>> stimuli;  // forced choices, by condition: the reference, then each comparison
    std::filesystem::path directory;
    StudyStep step = StudyStep::code;
    std::string code;                       // of the participant
    std::optional<std::string> typed_code;  // what stands in the field for it; nothing: the next free one is offered
    bool focus_code = false;                // the field is to take letters again
    std::string note;                       // why a code was not taken
    study::StudyProgress progress;
    std::size_t rated = 0;             // condition that `ratings` asks about
    std::vector<std::string> answers;  // to the items of this step, "" = not answered
    study::TypedAnswers typed;
    double step_began_s = 0.0;        // window's clock; the screen sets it when it first draws the step
    double typed_began_s = 0.0;       // 0: the clock stands
    int interval = 0;                 // of a choice: 0 or 1
    bool asked = false;               // the questions before the trials were answered
    bool rested = false;              // the break before this trial is over
    std::optional<std::size_t> told;  // condition whose instructions were read last
    bool told_practice = false;
    bool start_trial = false;  // the loop is to begin one
    bool device_here = true;   // what the due trial is done with; the loop looks
    bool device_left = false;  // in the middle of the due trial, which begins anew
    std::unique_ptr<study::ChoiceLog> choices;
    double choices_began_s = 0.0;
    double question_began_s = 0.0;
    std::string stopped;
    // For a keeper (session/keeper.h): what it has not been given yet, and what it reports.
    bool on_tablet = false;
    int first_run = 1;                         // of the log: those before are known to be taken
    std::vector<study::RunFiles> unkept_runs;  // typed trials
    bool unkept_answers = false;
    bool keeping = false;  // the next step waits
    double keeping_began_s = 0.0;
    std::vector<std::string> warnings;
};

// Loads what the protocol names and opens the folder. Throws InputError (also for a code that has finished), or
// std::runtime_error if the folder cannot be written. `code` may be empty: then it is asked for.
StudyRun open_study_run(const study::Protocol& protocol, const std::filesystem::path& directory,
                        const std::string& code);

// The next free code: 01, 02, ...
std::string free_code(const StudyRun& run);

// What the participant or the experimenter does. Each of these functions leads to the next step, or says in run.note
// why it does not.
void enter_code(const std::string& code, StudyRun& run);
void same_person(bool is, StudyRun& run);
void submit_answers(StudyRun& run);              // of questions and ratings
void begin_step(StudyRun& run);                  // from instructions, a pause, or once the device is here
void wait_for_device(bool left, StudyRun& run);  // instead of a trial; left: in the middle of it
void trial_finished(StudyRun& run);              // it is on the disk
void interval_presented(StudyRun& run);
void choose_softer(bool first, double now_s, StudyRun& run);
void submit_typed(StudyRun& run);
void stop_study(const std::string& why, StudyRun& run);

// The trial that is due. Call these functions only while there is one (in the steps from instructions to typed).
const study::PlannedTrial& due_trial(const StudyRun& run);
const study::Condition& due_condition(const StudyRun& run);
bool typed_in(const study::Condition& condition);  // this program does not drive it
bool shows_tissue(const StudyRun& run);            // the due trial has a scene on this screen
const StudyScene& due_scene(const StudyRun& run);  // of shows_tissue()
session::SessionFiles due_files(const StudyRun& run);
double due_limit_s(const StudyRun& run);                         // 0: none
std::vector<std::string> due_nodules(const StudyRun& run);       // names, for typed answers
const std::vector<study::Item>& due_items(const StudyRun& run);  // of questions and ratings

// For example "3 of 8": the number of the due trial, tests and practice together.
std::string progress_text(const StudyRun& run);

}  // namespace palpa::app
