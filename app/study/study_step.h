#pragma once
// The steps of a study with people, each with the data that it needs. A study is in one of them at a time.

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "study/typed_trial.h"

namespace palpa::app {

namespace step {

struct Code {  // who is here?
    int refused = 0;
};
struct Again {};      // a code that is known: is it the same person?
struct Questions {};  // before the trials
struct Instructions {};
struct Trial {           // on the tissue; of a choice, one of the two intervals
    bool begun = false;  // false: the loop is to begin it
};
struct Device {         // the trial is due, and what it is done with is not connected
    bool here = false;  // it is now; the loop looks
    bool left = false;  // it went in the middle of the trial, which begins anew
};
struct Present {};   // an interval that the experimenter presents
struct Question {};  // which was softer
struct Typed {};     // the experimenter types what was said
struct Ratings {     // after a condition
    std::size_t condition = 0;
};
struct Pause {};
struct Done {};
struct Stopped {  // it cannot go on
    std::string why;
};

}  // namespace step

using StudyStep =
    std::variant<step::Code, step::Again, step::Questions, step::Instructions, step::Trial, step::Device, step::Present,
                 step::Question, step::Typed, step::Ratings, step::Pause, step::Done, step::Stopped>;
const char* name_of(const StudyStep& step);

// What a participant or the experimenter asks for on the screen of a step.
struct EnterCode {
    std::string code;
};
struct SamePerson {
    bool is = true;
};
struct SubmitAnswers {  // of questions and ratings: to the items of this step, "" = not answered
    std::vector<std::string> answers;
};
struct BeginStep {};  // from instructions, a pause, or once the device is here
struct IntervalPresented {};
struct ChooseSofter {
    bool first = true;
    double at_s = 0.0;  // window's clock
};
struct SubmitTyped {
    study::TypedAnswers answers;
};
using StudyWish =
    std::variant<EnterCode, SamePerson, SubmitAnswers, BeginStep, IntervalPresented, ChooseSofter, SubmitTyped>;

}  // namespace palpa::app
