#pragma once
// A trial of a simulated person through the real loop: the same for logs on a disk and for studies in memory.

#include <cstdint>

#include "app/study/felt_search.h"
#include "session/session.h"
#include "study/order.h"
#include "study/simulated_person.h"
#include "study/typed_trial.h"

namespace palpa::app {

// Seeds of one purpose never meet those of another.
enum Purpose : std::uint64_t {
    kTraits = 11,
    kTrials = 12,
    kAnswers = 13,
    kHabit = 14,
    kDevices = 15,
    kStudies = 16,
    kOwnScene = 17
};

inline constexpr double kSoftnessWeber = 0.2;  // of a simulated answer to "which is softer"; our choice, not measured

struct SimulatedHand {
    std::uint64_t seed = 1;            // of the study
    double rate_Hz = 60.0;             // of the pen
    double noise = 1.0;                // factor on the noise of eye and hand
    const FeltSearch* felt = nullptr;  // what is felt; null: what the screen shows is seen
};

// The window of the simulated person.
platform::TraceInfo simulated_screen();

// Runs a trial that begin_trial() has begun, until the person finishes. `shown`: the condition whose scene is in the session. A
// person has the same traits in all trials, and different noise in each.
void palpate_trial(const study::Protocol& protocol, const study::Condition& shown, int person,
                   const study::PlannedTrial& trial, const SimulatedHand& hand, session::Session& session);

// What the experimenter types in after such a trial: each nodule with the confidence of the mark that found it.
study::TypedAnswers typed_answers(const scene::Plan& plan, const session::Trial& trial);

}  // namespace palpa::app
