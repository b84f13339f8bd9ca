#pragma once
// A simulated person searches the tissue of a trial, through the same loop as a pen, and marks what seems stiff.

#include <cstdint>

#include "app/study/felt_search.h"
#include "session/session.h"
#include "study/typed_trial.h"

namespace palpa::app {

struct SearchTask {
    std::uint64_t traits_seed = 1;  // of the person
    std::uint64_t noise_seed = 1;   // of the trial
    double limit_s = 0.0;           // 0: 60 s
    double rate_Hz = 60.0;          // of the pen
    platform::Tool tool = platform::Tool::pen;
    const FeltSearch* felt = nullptr;  // what is felt; null: what the screen shows is seen
};

// The trial must have begun; it ends with Finish.
void search(const SearchTask& task, session::Session& session);

// What the experimenter types in after such a search: each nodule with the confidence of the mark that found it.
study::TypedAnswers typed_answers(const scene::Plan& plan, const session::Trial& trial);

}  // namespace palpa::app
