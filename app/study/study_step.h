#pragma once
// The steps of a study with people, each with the data that it needs. A study is in one of them at a time.

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "study/typed_trial.h"
#include "study/withdrawal.h"

namespace palpa::app {

namespace step {

struct Code {         // who takes part?
    int refused = 0;  // number of codes refused so far
};
struct Again {};      // a known code: is it the same person?
struct Consent {};    // the protocol's text, before everything else
struct Questions {};  // of the protocol, before the trials
struct Instructions {};
struct Trial {             // on the tissue; in a forced choice, one of the two intervals
    bool begun = false;    // false: the loop must begin it
    bool opening = false;  // its devices are being opened; set by the loop
};
struct Device {              // a trial is due, and its device is not connected, or is a pen without pressure
    bool here = false;       // the trial could begin now; set by the loop
    bool connected = false;  // likewise
    bool left = false;       // it went during the trial, which begins again
    bool untouched = false;  // the trial's time was over before anything was touched; it begins again
    bool unseen = false;     // the time went by while the app was out of sight; it begins again
    bool no_level = false;   // touches lacked the level that the profile reads, so that no force came of them
};
struct Present {};   // an interval that the experimenter presents
struct Question {};  // which was softer
struct Told {        // after practice of a comparison
    bool right = false;
};
struct Feedback {  // after a practice trial in which nodules were to be found
    int found = 0;
    int nodules = 0;
    int false_positives = 0;
};
struct Typed {};  // the experimenter types in the participant's answers
struct Ratings {  // after a condition
    std::size_t condition = 0;
};
struct Pause {};
struct Leaving {};    // the participant wants to stop: is it certain, and may the data be used?
struct Withdrawn {};  // the participant has stopped
struct Done {};
struct Stopped {  // the study cannot continue
    std::string why;
};

}  // namespace step

using StudyStep = std::variant<step::Code, step::Again, step::Consent, step::Questions, step::Instructions, step::Trial,
                               step::Device, step::Present, step::Question, step::Told, step::Feedback, step::Typed,
                               step::Ratings, step::Pause, step::Leaving, step::Withdrawn, step::Done, step::Stopped>;
const char* name_of(const StudyStep& step);

// What a participant or the experimenter asks for on the screen of a step.
struct EnterCode {
    std::string code;
};
struct SamePerson {
    bool is = true;
};
struct GiveConsent {
    bool given = true;
};
struct WantToLeave {};
struct LeaveStudy {
    study::Withdrawal how = study::Withdrawal::none;  // none: the participant goes on after all
};
struct SubmitAnswers {  // answers to the items of this step; "" = not answered
    std::vector<std::string> answers;
};
struct BeginStep {};  // from instructions, a pause, feedback after practice, or once the device is connected
struct IntervalPresented {};
struct ChooseSofter {
    bool first = true;
    double at_s = 0.0;  // window's clock
};
struct SubmitTyped {
    study::TypedAnswers answers;
};
using StudyWish = std::variant<EnterCode, SamePerson, GiveConsent, WantToLeave, LeaveStudy, SubmitAnswers, BeginStep,
                               IntervalPresented, ChooseSofter, SubmitTyped>;

}  // namespace palpa::app
