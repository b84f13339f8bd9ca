#pragma once
// The order of trials: which participant gets which condition when, and how the map is turned. It is a function of the
// protocol, its seed and the participant's number, so that a study script, the app and a reviewer see the same order.
// Only the comparisons of a staircase follow from the answers.

#include <cstdint>
#include <string>
#include <vector>

#include "study/protocol.h"

namespace palpa::study {

// Counts the changes of the functions below that give other orders for the same protocol. A study goes on only with the
// version that it began with.
inline constexpr int kOrdersVersion = 2;

struct PlannedTrial {
    int trial = 1;  // number within the participant, practice included
    bool practice = false;
    std::size_t condition = 0;  // index in the protocol
    int repeat = 0;             // index among the trials of this condition, from 0; practice counts apart
    int rotate_deg = 0;
    bool flip = false;
    std::uint32_t seed = 0;
    bool break_before = false;
    int comparison = -1;  // index in comparisons_kPa_of(); -1: nothing is compared, or it follows from the answers
    bool reference_first = false;
};

struct PlannedParticipant {
    int number = 1;  // in the order in which participants arrive, from 1
    std::size_t group = 0;
    int order_id = 0;  // row of the square from 1, or the participant's number if the order is random
    std::vector<PlannedTrial> trials;
};

// The plan of one participant; `number` counts from 1.
PlannedParticipant plan_participant(const Protocol& protocol, int number);

// The group of a participant, and the participant's place in it, from 0. Random assignment shuffles blocks of
// people_per_block people of each group, so that the sizes of groups never differ by more than that and the last people
// of a block cannot be guessed from the one before.
struct Membership {
    std::size_t group = 0;
    int place = 0;
};
Membership membership_of(const Protocol& protocol, int number);

// Returns how many tests a participant has under this condition.
int tests_of(const Protocol& protocol, std::size_t condition);

// Both return rows of condition numbers 0 ... n - 1.
// Latin square: every condition stands once in every row and in every column (cyclic).
// Williams design: a Latin square in which every condition also directly follows every other equally often. It has n
// rows for even n, 2 n for odd n above 1.
// Source: Williams, Austral. J. Sci. Res. A 2 (1949) 149.
std::vector<std::vector<std::size_t>> latin_square(std::size_t n);
std::vector<std::vector<std::size_t>> williams_design(std::size_t n);

}  // namespace palpa::study
