#pragma once
// The finger pad's parameters, from assets/fingers.

#include <filesystem>

#include "mechanics/finger.h"

namespace palpa::tactile {

// {"name": "...", "young_Pa": 35000, "rise_Pa_per_N": 35000, "poisson": 0.5, "assumed": true, "source": "..."}
// Throws InputError.
mechanics::PadLaw read_pad_law(const std::filesystem::path& path);

}  // namespace palpa::tactile
