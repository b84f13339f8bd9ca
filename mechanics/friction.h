#pragma once
// A rigid tool that slides over the surface with Coulomb friction, step by step.
//
// Per touch node in reach: pressing force p and tangential force t on the tissue, u = C f with the full
// compliance.
//   p >= 0, g >= 0, p g = 0;   |t| <= mu p;   s = (u_t - u_t of the last step) - (move of the tool):
//   sticking s = 0, or slipping with t = -mu p s/|s|
// Solved by block projected Gauss-Seidel: p_i <- max(0, p_i - g_i / C_nn), t_i <- disc of radius mu p_i
// nearest to t_i - s_i / rho_i, rho_i the larger eigenvalue of the node's tangential block. Source: Jourdan,
// Alart, Jean, Comput. Methods Appl. Mech. Eng. 155 (1998) 31.

#include <span>
#include <vector>

#include "mechanics/contact.h"

namespace palpa::mechanics {

struct FrictionOptions {
    double coefficient = 0.3;
    int sweeps = 400;         // at most
    double tolerance = 1e-7;  // stops when a sweep changes no force by more than this share of the largest one
    double max_depth_m = std::numeric_limits<double>::infinity();
};

// What the next step starts from, and all that a replay must restore.
struct FrictionState {
    bool touching = false;
    Pose pose;
    std::vector<int> touch;       // touch nodes under load, ascending
    std::vector<double> force_N;  // three per node: pressing, x, y
};

struct FrictionWork {
    ContactWork contact;         // candidate lists
    Eigen::MatrixXd C;           // full compliance between candidates, top left corner
    Eigen::VectorXd f_N;         // three per candidate
    Eigen::VectorXd u_m;         // C f
    Eigen::VectorXd u_before_m;  // at the last step
};

// Room for `most_in_reach` nodes, so that nothing is allocated later.
FrictionWork make_friction_work(const Compliance& compliance, int most_in_reach);

// Moves the tool to its pose in one step (a slide takes many: at most half a node spacing each) and solves
// there. Needs a compliance with tangential = true; throws LoadError otherwise. A pose that is not finite
// holds everything.
void slide_to(const Compliance& compliance, const Tool& tool, const FrictionOptions& options, FrictionWork& work,
              FrictionState& state, Contact& contact);

}  // namespace palpa::mechanics
