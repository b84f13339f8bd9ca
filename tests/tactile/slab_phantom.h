#pragma once
// A small slab with an arm and pins, as text.

namespace palpa::test {

// 40 x 40 x 20 mm, coarse: a test under sanitizers makes it in a second. 17.5 kPa.
inline constexpr const char* kSlabPhantom = R"({
  "size_mm": [40, 40, 20], "tissue": {"young_Pa": 17500, "poisson": 0.45}, "nodules": [],
  "indenter": {"shape": "sphere", "radius_mm": 8, "contact": "rolling"},
  "depths_mm": [1], "grid": {"origin_mm": [0, 0], "spacing_mm": [1, 1], "count": [2, 2]}})";

inline constexpr const char* kArmAndPins = R"({"arm": {"device": "arm.json"}, "display": {"device": "pins-6x6.json"}})";

}  // namespace palpa::test
