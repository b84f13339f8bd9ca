#pragma once
// The views of a participant's trials: how the map is turned and flipped in each. Every condition is tested in every
// view equally often over full rounds of people, and a person sees as many views as there are.

#include <cstdint>
#include <vector>

#include "study/order.h"

namespace palpa::study {

// Gives the trials, in the order in which they are shown, their views. `who` knows its group, `place` is its place
// there.
//
// Each test has a slot: its condition's place in the group, then its repeat. In a round of as many people as there are
// views, slots move on by one view from person to person, so that each slot meets each view once; which view is which is
// drawn anew in each round. Where a condition has several tests, the view that the person has not seen for longest comes
// first. Practice gets views in which the condition is not tested, as long as there are any.
void give_views(const Protocol& protocol, int place, std::uint64_t seed, PlannedParticipant& who);

}  // namespace palpa::study
