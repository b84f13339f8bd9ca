#pragma once
// The order of trials: which participant gets which condition when, and how the map is turned. It is a function of the
// protocol, its seed and the participant's number, so that a study script, the app and a reviewer see the same order.

#include <cstdint>
#include <string>
#include <vector>

#include "study/protocol.h"

namespace palpa::study {

struct PlannedTrial {
    int trial = 1;  // number within the participant, practice included
    bool practice = false;
    std::size_t condition = 0;  // index in the protocol
    int repeat = 0;             // index among the trials of this condition, from 0; practice counts apart
    int rotate_deg = 0;
    bool flip = false;
    std::uint32_t seed = 0;
    bool break_before = false;
    int comparison = -1;  // index in comparisons_kPa; -1 if the task is no choice
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

// Both return rows of condition numbers 0 ... n - 1.
// Latin square: every condition stands once in every row and in every column (cyclic).
// Williams design: a Latin square in which every condition also directly follows every other equally often. It has n
// rows for even n, 2 n for odd n above 1.
// Source: Williams, Austral. J. Sci. Res. A 2 (1949) 149.
std::vector<std::vector<std::size_t>> latin_square(std::size_t n);
std::vector<std::vector<std::size_t>> williams_design(std::size_t n);

// How far the plans of `participants` people are from balance; all three differences are 0 if they are balanced.
struct Imbalance {
    std::string group;
    int participants = 0;
    int position = 0;        // greatest minus least count of a condition at a position
    int carry_over = 0;      // greatest minus least count of a condition directly after another
    int turns = 0;           // greatest minus least count of a condition in a view
    int full_rounds_of = 1;  // multiples of this number of people balance positions; 1 for fixed and random orders
};
std::vector<Imbalance> imbalance_of(const Protocol& protocol, const std::vector<PlannedParticipant>& people);

}  // namespace palpa::study
