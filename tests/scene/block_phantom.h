#pragma once
// A linear tissue for tests.

namespace palpa::test {

// 60 x 60 x 20 mm with one nodule at (24, 30), coarse enough for a test under sanitizers.
inline constexpr const char* kBlockPhantom = R"({
  "size_mm": [60, 60, 20], "tissue": {"young_Pa": 20000, "poisson": 0.45},
  "nodules": [{"id": "A", "centre_mm": [24, 30, 9], "diameter_mm": 12, "young_Pa": 2e6, "poisson": 0.45}],
  "indenter": {"shape": "sphere", "radius_mm": 10, "contact": "rolling"},
  "depths_mm": [1], "grid": {"origin_mm": [0, 0], "spacing_mm": [1, 1], "count": [2, 2]}})";

}  // namespace palpa::test
