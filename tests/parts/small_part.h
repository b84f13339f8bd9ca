#pragma once
// A part that tests change: a beam of 10 x 2 x 2 mm, its outer half soft.

#include <string>

#include "parts/part_file.h"

namespace palpa::test {

inline files::Json small_part() {
    return files::Json::parse(R"({
      "name": "small", "voxel_mm": 0.5, "size_mm": [10, 2, 2], "cell_mm": 0.5,
      "materials": {
        "hard": {"young_Pa": 8.3e9, "poisson": 0.28, "density_kg_per_m3": 1200},
        "soft": {"young_Pa": 2e9, "poisson": 0.394, "density_kg_per_m3": 1020, "colour": "#ee6677", "source": "paper"}},
      "shape": [{"add": {"all": true}, "material": "hard"},
                {"permute": {"box": {"min_mm": [5, 0, 0], "max_mm": [10, 2, 2]}}, "material": "soft"}],
      "supports": [{"face": "xmin", "fix": "xyz"}],
      "loads": {"tip": {"face": "xmax", "direction": "-z", "force_N": 1},
                "patch": {"at_mm": [8, 1, 2], "patch_mm": 2, "direction": [0, 0, -2]}},
      "axis": "x"})");
}

inline parts::Part parsed(const files::Json& json) { return parts::parse_part(json, "p.json"); }

}  // namespace palpa::test
