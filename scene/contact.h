#pragma once
// What a tissue is asked, and what it answers.

#include <Eigen/Core>
#include <cstdint>

namespace palpa::scene {

// What a sample asks. The prepared tissue is as stiff as its file says, the scene's stiffness_scale times as stiff:
// under a force that one answers as the prepared one does under force / stiffness_scale, and its newtons are
// stiffness_scale times as many.
struct Press {
    Eigen::Vector2d p_m = Eigen::Vector2d::Zero();  // where on the tissue
    double force_N = 0.0;
    Eigen::Vector2d heading = Eigen::Vector2d::Zero();  // direction of motion, length 1 once moving
    bool down = false;
    double stiffness_scale = 1.0;
};

// The same at a place of the pen's path: by how much does the resisting force rise along u up to there?
struct Station {
    Eigen::Vector2d p_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d u = Eigen::Vector2d::Zero();  // length 1
    double force_N = 0.0;                         // both forces are taken at the depth of this one at p
    double reference_m = 0.0;                     // between the two places
    double stiffness_scale = 1.0;
};

// The tissue's answer to a touch.
struct Contact {
    double time_s = 0.0;                            // of the touch, on the timeline
    Eigen::Vector2d p_m = Eigen::Vector2d::Zero();  // where on the tissue
    double depth_m = 0.0;
    double normal_N = 0.0;
    double tangential_N = 0.0;  // resisting motion along the pen's direction
    bool saturated = false;     // pressed deeper than the tissue is known
    bool measured = true;       // false: between or beside the measured cells
    double linearity = 0.0;     // of a simulated tissue: amber above 0.10, red above 0.25 (mechanics/linear_range.h)
    std::int64_t skipped_slides = 0;  // of friction, on the way to this touch
};

}  // namespace palpa::scene
