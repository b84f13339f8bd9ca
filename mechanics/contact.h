#pragma once
// A rigid sphere or cylinder pressed into the surface: frictionless, unilateral, small displacements.
//
//   find p >= 0 with  g = C p - delta >= 0  and  p . g = 0
//
// p: pressing force of each touch node; C: compliance; delta: how far the rigid tool reaches below the node at rest;
// g: gap. Solved by a warm-started active set (dense Cholesky of C on the nodes in contact); the result depends only on
// the final set, not on the way there. If the set does not settle, projected Gauss-Seidel takes over with a fixed
// number of sweeps.
// Sources: James & Pai 2001 (compliance.h); Hintermueller, Ito, Kunisch, SIAM J. Optim. 13 (2002) 865 (active set).

#include <Eigen/Core>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "mechanics/compliance.h"

namespace palpa::mechanics {

// The axis of a cylinder lies along y, so that it rolls along x.
enum class IndenterShape { sphere, cylinder };

struct Indenter {
    IndenterShape shape = IndenterShape::sphere;
    double radius_m = 0.008;
    double length_m = std::numeric_limits<double>::infinity();  // of a cylinder
};

// The lowest point of the tool: its place on the surface and its depth below the surface at rest.
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
    // Greatest depth; never more than the thickness, unless the tool gives way too.
    double max_depth_m = std::numeric_limits<double>::infinity();
    int max_changes = 40;  // of the active set before Gauss-Seidel takes over; 0: Gauss-Seidel from the start
    int sweeps = 300;
    // A tool that gives way too: this matrix between touch nodes (n_touch x n_touch, symmetric), times the factor, is
    // added to C. Null: a rigid tool.
    const Eigen::MatrixXd* tool_compliance = nullptr;
    double tool_factor = 0.0;
};

struct ToolForce {
    double normal_N = 0.0;
    // Positive opposes motion along +x (+y). For a frictionless tool this is the slope of the elastic energy at
    // constant depth, sum p_i d(delta_i)/dx; friction adds its own share.
    double tangential_x_N = 0.0;
    double tangential_y_N = 0.0;
    // On the tool, about its lowest point: sum p_i (y_i - y), -sum p_i (x_i - x).
    double moment_x_Nm = 0.0;
    double moment_y_Nm = 0.0;
    double area_m2 = 0.0;  // sum of the tributary areas of the nodes in contact, so it changes by whole nodes
    double depth_m = 0.0;  // after the limit
};

// What was not as asked. All false for an ordinary contact.
struct ContactFlags {
    bool held = false;          // the pose or the force was not finite: everything else is the last valid answer
    bool capped = false;        // the depth was limited, or the force is not reached at the limit
    bool over_edge = false;     // the tool reaches beyond the touch nodes
    bool not_settled = false;   // the answer is that of Gauss-Seidel, exact only to `violation_m`
    bool force_missed = false;  // press_with_force: the search ended at normal_N without reaching the force
};

struct Contact {
    std::vector<int> touch;       // touch nodes in contact, ascending
    std::vector<int> by_tool;     // the tool that presses each of them
    std::vector<double> force_N;  // pressing force of each
    std::vector<ToolForce> tool;  // one per tool
    double energy_J = 0.0;
    double violation_m = 0.0;        // largest penetration left
    double stiffness_N_per_m = 0.0;  // d(normal force)/d(depth), set by press_with_force
    int changes = 0;                 // how often the active set changed
    ContactFlags flags;
};

// Scratch memory, which also remembers the last active set and its factor. A new one is a cold start.
struct ContactWork {
    std::uint64_t revision = 0;                    // of the compliance; another one, or 0, means a cold start
    std::vector<Tool> tools;                       // with limited depths
    std::array<double, 4> touch_box_m{};           // x_min, x_max, y_min, y_max of the touch nodes
    double highest_m = 0.0;                        // of the touch nodes, above the surface plane; 0 if all are below it
    std::vector<std::array<double, 4>> run_box_m;  // the same of each run of kRunLength touch nodes
    std::vector<int> candidate;                    // touch nodes within reach, ascending
    std::vector<int> tool_of;                      // per candidate
    std::vector<double> delta_m;                   // per candidate
    std::vector<double> slope_x, slope_y;
    std::vector<double> p_N, swept_N, gap_m;  // per candidate
    std::vector<char> in_contact;             // per candidate
    std::vector<char> was_in_contact;         // per touch node
    std::vector<int> factored;                // touch nodes that `factor` belongs to
    double factored_tool = 0.0;               // tool_factor that it belongs to
    std::vector<int> active;                  // positions in `candidate` of the nodes in contact
    Eigen::MatrixXd factor;                   // lower Cholesky factor in its top left corner
    Eigen::VectorXd rhs;
};

// Returns a work with room for `most_in_contact` nodes: nothing is allocated later while no more nodes touch.
ContactWork make_contact_work(const Compliance& compliance, int most_in_contact);

// Holds all tools at their depths at once. Where two tools reach one node, the tool that reaches deeper presses it.
void press_to_depth(const Compliance& compliance, std::span<const Tool> tools, const ContactOptions& options,
                    ContactWork& work, Contact& contact);

// Presses one tool with a normal force and finds its depth. The search starts from the pose's depth if that is > 0.
void press_with_force(const Compliance& compliance, const Tool& tool, double force_N, const ContactOptions& options,
                      ContactWork& work, Contact& contact);

// Computes the depression of all surface nodes under a contact, n_surface values.
void surface_depression_m(const Compliance& compliance, const Contact& contact, Eigen::VectorXd& out_m);

// Returns the mean pressure on the tributary area of entry i of `contact.touch`.
double pressure_Pa(const Compliance& compliance, const Contact& contact, std::size_t i);

// Throws LoadError with the numbers if the tool has no radius or length, is not at finite numbers, is beside the touch
// nodes, or is as deep as the tissue is thick. Meant for tools from files, not for the loop.
void check_tool(const Compliance& compliance, const Tool& tool);

}  // namespace palpa::mechanics
