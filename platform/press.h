#pragma once
// The owner of a press. A press that starts on a panel never reaches the tissue. A press that was cancelled gives no
// more samples until the pen, finger or button is lifted.

#include <cstdint>
#include <vector>

#include "platform/pressure.h"
#include "platform/sample.h"

namespace palpa::platform {

enum class PressOwner : std::uint8_t { tissue, panel, nobody };

struct Press {
    PressOwner owner = PressOwner::tissue;
    Sample last;  // the last sample; a cancel repeats its position
};

struct Presses {
    std::vector<Press> held;
    PressureWatch
        pressure;  // of all presses, also those that a panel owns: any press tells whether its device measures
};

// Appends `sample` to `out` if it may reach the tissue. `down_owner` decides for the whole press and is read only for
// the phase down. Moves and ups of an unknown pointer are dropped, since their down was elsewhere.
void admit(const Sample& sample, PressOwner down_owner, Presses& presses, std::vector<Sample>& out);

// Ends every press on the tissue with phase cancel at `t_host_s`; later samples of the press, its up included, are
// dropped.
void cancel_all(double t_host_s, Presses& presses, std::vector<Sample>& out);

// As cancel_all(), for one pointer that is gone and will send no up.
void cancel_gone(double t_host_s, std::int64_t pointer_id, Presses& presses, std::vector<Sample>& out);

bool presses_tissue(const Presses& presses, std::int64_t pointer_id);

}  // namespace palpa::platform
