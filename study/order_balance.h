#pragma once
// How far the plans of some participants are from balance.

#include <string>
#include <vector>

#include "study/order.h"

namespace palpa::study {

// All three differences are 0 if the plans are balanced.
struct Imbalance {
    std::string group;
    int participants = 0;
    int position = 0;  // greatest minus least count of a condition as the first, second, ... to be tested
    // Greatest minus least count of tests of one condition directly after a test of another. Practice does not count.
    int carry_over = 0;
    int turns = 0;  // greatest minus least count of a condition's tests in a view
    int full_rounds_of =
        1;  // multiples of this number of people balance positions; 1 for fixed and random orders, and for shuffled trials
};
std::vector<Imbalance> imbalance_of(const Protocol& protocol, const std::vector<PlannedParticipant>& people);

}  // namespace palpa::study
