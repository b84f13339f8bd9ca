#pragma once
// A small graded block that the tactile tests press on.

#include "files/text.h"
#include "scene/linear_tissue.h"
#include "tests/temporary_folder.h"

namespace palpa::test {

// 60 x 60 x 20 mm of 20 kPa with a stiff nodule 12 mm left of the middle; surface nodes 2 mm apart in the middle.
struct FingerBlock {
    TemporaryFolder folder;
    scene::LinearTissue tissue;
    FingerBlock() {
        files::write_text_atomically(folder / "block.json", R"({
          "size_mm": [60, 60, 20], "tissue": {"young_Pa": 20000, "poisson": 0.45},
          "nodules": [{"id": "A", "centre_mm": [18, 30, 7], "diameter_mm": 8, "young_Pa": 2e6, "poisson": 0.45}],
          "indenter": {"shape": "sphere", "radius_mm": 8, "contact": "rolling"},
          "depths_mm": [1], "grid": {"origin_mm": [0, 0], "spacing_mm": [1, 1], "count": [2, 2]}})");
        scene::LinearOptions options;
        options.phantom = folder / "block.json";
        options.spacing_m = 3e-3;
        options.grading = mechanics::Grading{{0.03, 0.03}, 2e-3};
        tissue = scene::make_linear_tissue(options, {}, {});
    }
};

inline const FingerBlock& finger_block() {
    static const FingerBlock block;
    return block;
}

}  // namespace palpa::test
