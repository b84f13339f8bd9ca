#pragma once
// Which participant gets which condition when, and how the map is turned. This order is a function of the protocol, its
// seed and the participant's number, so that a study script, the app and a reviewer see the same order.

#include <cstdint>
#include <string>
#include <vector>

#include "study/protocol.h"

namespace palpa::study {

struct PlannedTrial {
    int trial = 1;  // number within the participant, practice included
    bool practice = false;
    std::size_t condition = 0;  // index in the protocol
    int repeat = 0;             // which one of this condition, from 0
    int rotate_deg = 0;
    bool flip = false;
    std::uint32_t seed = 0;
    bool break_before = false;
    int comparison = -1;  // of a choice: index
    bool reference_first = false;
};

struct PlannedParticipant {
    int number = 1;  // from 1, in the order in which people come
    std::size_t group = 0;
    int order_id = 0;  // row of the square, or the number of the shuffle
    std::vector<PlannedTrial> trials;
};

// The plan of one participant; `number` counts from 1.
PlannedParticipant plan_participant(const Protocol& protocol, int number);

// Rows of condition numbers 0 ... n - 1.
// Latin square: every condition stands once in every row and column (cyclic).
// Williams design: a Latin square in which every condition also follows every other equally often; it has n rows for
// even n, 2 n for odd n.
// Source: Williams, Austral. J. Sci. Res. A 2 (1949) 149.
std::vector<std::vector<std::size_t>> latin_square(std::size_t n);
std::vector<std::vector<std::size_t>> williams_design(std::size_t n);

// How far a plan for `participants` people is from balance. 0 everywhere is balanced.
struct Imbalance {
    std::string group;
    int participants = 0;
    int position = 0;        // most minus least often that a condition stands at a position
    int carry_over = 0;      // most minus least often that a condition directly follows another
    int turns = 0;           // most minus least often that a condition is seen in a view
    int full_rounds_of = 1;  // a multiple of so many people balances positions (1: any number does, or none can)
};
std::vector<Imbalance> imbalance_of(const Protocol& protocol, const std::vector<PlannedParticipant>& people);

}  // namespace palpa::study
