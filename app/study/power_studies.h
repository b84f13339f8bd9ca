#pragma once
// Simulated studies in memory: every trial runs through the real loop, and the real analysis judges the study, but no log is
// written.

#include <cstdint>
#include <optional>
#include <vector>

#include "app/study/study_scenes.h"
#include "session/session.h"
#include "study/observations.h"
#include "study/power.h"

namespace palpa::app {

// What conditions do, in comparison with the reference.
//
// Nodules to find: of the tests under any other condition the share `effect` (drawn for each test) shows the condition's own
// scene, the others show the reference's. So with 0 no condition differs, with 1 all are as the protocol says, and the
// expected difference to the reference is in proportion to `effect`.
// Choices: the noise of the felt stiffness is exp(effect) times that of the reference, under all other conditions.
struct SimulatedEffect {
    double effect = 1.0;  // 0 to 1
    double noise = 1.0;   // factor on the noise of the eye, and of felt stiffness
    std::size_t reference = 0;
};

// The condition `id`; empty: the first side of the primary comparison of conditions, else the first condition. Throws
// InputError for an id that the protocol does not have, and for a condition by hand.
std::size_t reference_of(const study::Protocol& protocol, const StudyScenes& scenes, const std::string& id);

// Throws InputError for what cannot be simulated in memory: staircases, choices that are felt on arm and pins, and a protocol
// without any other test.
void check_power_protocol(const study::Protocol& protocol, const StudyScenes& scenes);

// Keeps what one thread needs from trial to trial.
struct PowerSessions {
    explicit PowerSessions(std::size_t conditions) : of_condition(conditions) {}
    std::vector<std::optional<session::Session>> of_condition;
};

// The results of a study of `participants` simulated people, as read_study() gives those of its logs; nodules, marks, choices and
// groups, without the plan. `seed`: of the study.
study::Observations study_in_memory(const study::Protocol& protocol, const StudyScenes& scenes, int participants,
                                    std::uint64_t seed, const SimulatedEffect& effect, double rate_Hz,
                                    PowerSessions& sessions);

// The first `participants` people of a study, in the order of the protocol's conditions.
study::Observations first_people(const study::Protocol& protocol, const study::Observations& seen, int participants);

}  // namespace palpa::app
