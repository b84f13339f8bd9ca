#pragma once
// What the stages ask a tissue, and what it answers.

#include <Eigen/Core>
#include <cstdint>

namespace palpa::scene {

// What a sample asks. A tissue is prepared with the stiffness of its file, whereas the scene's tissue is
// stiffness_scale times as stiff. Under a force the scene's tissue is as deep as the prepared one under force /
// stiffness_scale, and its tangential force is stiffness_scale times that of the prepared one.
struct Press {
    Eigen::Vector2d p_m = Eigen::Vector2d::Zero();  // place on the tissue
    double force_N = 0.0;
    Eigen::Vector2d heading = Eigen::Vector2d::Zero();  // direction of motion, length 1; 0 before the first motion
    bool down = false;
    double stiffness_scale = 1.0;
};

// What a station of the pen's path asks: how much the resisting tangential force rises from p - reference_m u to p.
struct Station {
    Eigen::Vector2d p_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d u = Eigen::Vector2d::Zero();  // direction of motion, length 1
    double force_N = 0.0;                         // normal force; its depth at p is the depth at both places
    double reference_m = 0.0;
    double stiffness_scale = 1.0;  // as in Press
};

// The tissue's answer to a touch.
struct Contact {
    double time_s = 0.0;                            // time of the touch on the timeline
    Eigen::Vector2d p_m = Eigen::Vector2d::Zero();  // place on the tissue
    double depth_m = 0.0;
    double normal_N = 0.0;
    double tangential_N = 0.0;  // resists motion along Press::heading
    bool saturated = false;     // the force is not reached at the greatest known depth; the depth stays there
    bool inexact = false;    // a simulated contact did not settle, or its force was not met; the answer is the nearest
    bool measured = true;    // false where a map has no measured cells or ends
    double linearity = 0.0;  // of a simulated tissue: amber above 0.10, red above 0.25 (mechanics/linear_range.h)
    std::int64_t skipped_slides = 0;  // friction steps left out on the way to this touch
};

// The tissue's answer to a finger that is held at a depth, for devices that take a depth and give a force. Forces are those
// of the prepared tissue; whoever asks multiplies them by the scene's stiffness_scale.
struct Push {
    double force_N = 0.0;
    double slope_N_per_m = 0.0;  // of the force over depth
    double depth_m = 0.0;        // that was answered: of the god-object, which stays on the surface
    bool saturated = false;      // the tissue is not known as deep as that; force and depth stay
    bool inexact = false;        // a simulated contact did not settle; the answer is the nearest
};

}  // namespace palpa::scene
