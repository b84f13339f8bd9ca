#pragma once
// A press on the soft device of a scene, in virtual time against its plant. A build without PALPA_TANGIBLE has none
// (no_soft_press.cpp).

#include <cstdint>
#include <span>
#include <vector>

#include "devices/press_file.h"
#include "scene/plan.h"
#include "study/simulated_touch.h"

namespace palpa::app {

// `press`: by force; it must not be empty. Throws InputError for a device that cannot be read, or without PALPA_TANGIBLE.
std::vector<study::FeltMoment> press_soft_device(const scene::Scene& scene, const scene::Plan& plan,
                                                 std::span<const devices::PressRow> press, std::uint64_t seed);

}  // namespace palpa::app
