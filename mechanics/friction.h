#pragma once
// A rigid tool that slides over the surface with Coulomb friction, step by step.
//
// Each touch node in reach has a pressing force p, a tangential force t on the tissue, a gap g and a slip s; the
// displacements are u = C f with the full compliance C and the forces f = (p, t):
//   p >= 0, g >= 0, p g = 0;   |t| <= mu p;   s = (u_t - u_t of the last step) - (move of the tool)
//   the node sticks, s = 0, or slips, t = -mu p s/|s|
// Solved by block projected Gauss-Seidel: p_i <- max(0, p_i - g_i / C_nn), and t_i <- the point nearest to
// t_i - s_i / rho_i in the disc of radius mu p_i, where rho_i is the larger eigenvalue of the node's tangential block.
// Source: Jourdan, Alart, Jean, Comput. Methods Appl. Mech. Eng. 155 (1998) 31.

#include <span>
#include <vector>

#include "mechanics/contact.h"

namespace palpa::mechanics {

struct FrictionOptions {
    double coefficient = 0.3;
    int sweeps = 400;         // at most
    double tolerance = 1e-7;  // sweeps end when one changes no force by more than this share of the largest force
    double max_depth_m = std::numeric_limits<double>::infinity();
};

// What the next step starts from: all that a replay must reproduce.
struct FrictionState {
    bool touching = false;
    Pose pose;
    std::vector<int> touch;       // touch nodes under load, ascending
    std::vector<double> force_N;  // three per node: pressing, x, y
};

// Scratch memory.
struct FrictionWork {
    ContactWork contact;         // for its lists of candidates
    Eigen::MatrixXd C;           // full compliance between candidates, in the top left corner
    Eigen::VectorXd f_N;         // three per candidate: pressing, x, y
    Eigen::VectorXd u_m;         // C f
    Eigen::VectorXd u_before_m;  // u at the last step
};

// Returns a work with room for `most_in_reach` nodes: nothing is allocated later while no more nodes are in reach.
FrictionWork make_friction_work(const Compliance& compliance, int most_in_reach);

// Moves the tool to its pose in one step and solves there; the caller divides a slide into steps of at most half a node
// spacing. Throws LoadError unless the compliance was computed with tangential = true. If the pose is not finite,
// nothing changes and the contact is flagged as held.
void slide_to(const Compliance& compliance, const Tool& tool, const FrictionOptions& options, FrictionWork& work,
              FrictionState& state, Contact& contact);

}  // namespace palpa::mechanics
