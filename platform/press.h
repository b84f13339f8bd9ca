#pragma once
// Who a press belongs to. A press that starts on a panel never reaches tissue, and one that was cancelled
// stays dead until the pen, finger or button is lifted.

#include <cstdint>
#include <vector>

#include "platform/sample.h"

namespace palpa::platform {

enum class PressOwner : std::uint8_t { tissue, panel, nobody };

struct Press {
    PressOwner owner = PressOwner::tissue;
    Sample last;  // as admitted last; a cancel repeats its place
};

struct Presses {
    std::vector<Press> held;
};

// Appends `sample` to `out` if it may reach tissue. `down_owner` decides for the whole press and is looked at
// only when the phase is down. Moves and ups of an unknown pointer are dropped: its down was elsewhere.
void admit(const Sample& sample, PressOwner down_owner, Presses& presses, std::vector<Sample>& out);

// Ends every press on tissue with phase cancel at `t_host_s`; what follows of it, its up included, is
// dropped.
void cancel_all(double t_host_s, Presses& presses, std::vector<Sample>& out);

// As cancel_all, for one pointer that is gone and will send no up.
void cancel_gone(double t_host_s, std::int64_t pointer_id, Presses& presses, std::vector<Sample>& out);

bool presses_tissue(const Presses& presses, std::int64_t pointer_id);

}  // namespace palpa::platform
