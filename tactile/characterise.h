#pragma once
// How stiff a force arm really feels: it renders known stiffnesses, and a force sensor between arm and hand tells what came
// of them. The paper's measurement (its section III.A, figure 6): lines are fitted to force over depth.

#include <functional>
#include <vector>

#include "tactile/arm_strokes.h"

namespace palpa::tactile {

struct StiffnessRun {
    double asked_N_per_m = 0.0;     // that the tissue was made for; the caller's
    double wanted_N_per_m = 0.0;    // slope of the line through the law's own forces at the same depths
    double rendered_N_per_m = 0.0;  // slope of the line through all cycles
    double error_share = 0.0;       // rendered / wanted - 1
    double hysteresis_N = 0.0;      // half the distance of the lines of pressing and releasing
    double force_at_0_N = 0.0;      // of the line halfway between them
    double force_rms_N = 0.0;       // measured force off the law's, of all readings in the tissue, rms
    std::vector<StrokeRow> rows;
};

// Fits F = k d + c + h sign(v) to the readings of the middle nine tenths of the depth that move about as
// fast as most: k is the rendered stiffness, h the hysteresis. The wanted stiffness is the k of the law's forces at these
// readings, so that the curve of a law is no error of the arm. Throws std::runtime_error for fewer than 100 readings.
StiffnessRun stiffness_of(const std::function<double(double depth_m)>& law_N, std::vector<StrokeRow> rows);

// Where a hand of this stiffness has to go so that it presses this deep; the simulated hand gives way.
double hand_depth_m(double depth_m, double stiffness_N_per_m, double hand_N_per_m);

}  // namespace palpa::tactile
