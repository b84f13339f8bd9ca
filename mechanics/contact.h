#pragma once
// A rigid sphere or cylinder pressed into the surface: frictionless, unilateral, small displacements.
//
//   find p >= 0 with  g = C p - delta >= 0  and  p . g = 0
//
// p: pressing force of each touch node, C: compliance, delta: how far the rigid tool reaches below the node
// at rest. Solved by an active set (dense Cholesky of C on the nodes in contact), warm-started; the answer
// depends on the final set only, not on the way there. When the set does not settle, projected Gauss-Seidel
// with a fixed number of sweeps. Source: James & Pai 2001 (compliance.h); Hintermueller, Ito, Kunisch, SIAM
// J. Optim. 13 (2002) 865 (active set).

#include <Eigen/Core>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "mechanics/compliance.h"

namespace palpa::mechanics {

// cylinder: axis along y, so that it rolls along x.
enum class IndenterShape { sphere, cylinder };

struct Indenter {
    IndenterShape shape = IndenterShape::sphere;
    double radius_m = 0.008;
    double length_m = std::numeric_limits<double>::infinity();  // of a cylinder
};

// Lowest point of the tool: its place on the surface and its depth below the surface at rest.
struct Pose {
    double x_m = 0.0;
    double y_m = 0.0;
    double depth_m = 0.0;
};

struct Tool {
    Indenter indenter;
    Pose pose;
};

struct ContactOptions {
    double max_depth_m = std::numeric_limits<double>::infinity();  // deeper poses stop here; the thickness always does
    int max_changes = 40;  // of the active set before Gauss-Seidel takes over; 0: Gauss-Seidel alone
    int sweeps = 300;
};

struct ToolForce {
    double normal_N = 0.0;
    // Resisting: positive opposes motion along +x (+y). For a frictionless tool this is the slope of the
    // elastic energy at constant depth, sum p_i d(delta_i)/dx; friction adds its own share.
    double tangential_x_N = 0.0;
    double tangential_y_N = 0.0;
    // On the tool, about its lowest point: sum p (y_i - y), -sum p (x_i - x).
    double moment_x_Nm = 0.0;
    double moment_y_Nm = 0.0;
    double area_m2 = 0.0;  // tributary areas of the nodes in contact: steps by one node
    double depth_m = 0.0;  // after capping
};

// What was not as asked. All false for an ordinary contact.
struct ContactFlags {
    bool held = false;          // the pose was not finite: everything else is the last valid answer
    bool capped = false;        // depth cut to the limit, or the force not reached at the limit
    bool over_edge = false;     // the tool reaches beyond the touch nodes
    bool not_settled = false;   // Gauss-Seidel's answer, exact to `violation_m` only
    bool force_missed = false;  // press_with_force came no nearer to the force it was given than normal_N
};

struct Contact {
    std::vector<int> touch;       // touch nodes in contact, ascending
    std::vector<int> by_tool;     // which tool presses each
    std::vector<double> force_N;  // of each, pressing
    std::vector<ToolForce> tool;  // one per tool
    double energy_J = 0.0;
    double violation_m = 0.0;        // largest penetration left
    double stiffness_N_per_m = 0.0;  // d(normal force)/d(depth), set by press_with_force
    int changes = 0;                 // of the active set
    ContactFlags flags;
};

// Scratch memory; also remembers the last active set and its factor. A new one is a cold start.
struct ContactWork {
    std::uint64_t revision = 0;                    // of the compliance this belongs to; another one, or 0, starts cold
    std::vector<Tool> tools;                       // with their depths limited
    std::array<double, 4> touch_box_m{};           // x_min, x_max, y_min, y_max of the touch nodes
    std::vector<std::array<double, 4>> run_box_m;  // the same of each run of kRunLength touch nodes
    std::vector<int> candidate;                    // touch nodes within reach, ascending
    std::vector<int> tool_of;                      // per candidate
    std::vector<double> delta_m;                   // per candidate
    std::vector<double> slope_x, slope_y;
    std::vector<double> p_N, swept_N, gap_m;  // per candidate
    std::vector<char> in_contact;             // per candidate
    std::vector<char> was_in_contact;         // per touch node
    std::vector<int> factored;                // touch nodes that `factor` belongs to
    std::vector<int> active;                  // candidate positions
    Eigen::MatrixXd factor;                   // lower Cholesky factor in its top left corner
    Eigen::VectorXd rhs;
};

// Room for `most_in_contact` nodes, so that nothing is allocated later.
ContactWork make_contact_work(const Compliance& compliance, int most_in_contact);

// All tools held at their depths at once; where two reach the same node the deeper one presses it.
void press_to_depth(const Compliance& compliance, std::span<const Tool> tools, const ContactOptions& options,
                    ContactWork& work, Contact& contact);

// One tool with a given normal force; finds the depth (the pose's own depth is where the search starts if >
// 0).
void press_with_force(const Compliance& compliance, const Tool& tool, double force_N, const ContactOptions& options,
                      ContactWork& work, Contact& contact);

// Depression of all surface nodes under a contact, n_surface.
void surface_depression_m(const Compliance& compliance, const Contact& contact, Eigen::VectorXd& out_m);

// Mean pressure on the share of the surface of entry i of `contact.touch`.
double pressure_Pa(const Compliance& compliance, const Contact& contact, std::size_t i);

// For a case file rather than the loop: throws LoadError with the numbers when the tool is beside the touch
// nodes, has no radius, or goes deeper than the tissue is thick.
void check_tool(const Compliance& compliance, const Tool& tool);

}  // namespace palpa::mechanics
