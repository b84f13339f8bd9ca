#pragma once
// A rigid tool that has slid a long way at constant depth with Coulomb friction, so that every node in contact slips.
//
//   find p >= 0 with  g = A p - delta >= 0  and  p . g = 0,    A = C + mu (e_x X^T + e_y Y^T)
//
// p: pressing force of each touch node, which drags the tissue along the motion e with mu p; C: compliance; X, Y:
// displacement along x and y per newton pressing (compliance.h), whose transposes are the depression per newton
// dragging (Maxwell-Betti). Transients and lateral slip, which friction.h has, are left out, so the answer has no
// history. A is not symmetric: it is solved by an active set with dense LU on the nodes in contact, or by projected
// Gauss-Seidel as in contact.h. For a large mu there may be no answer or several (Klarbring, Ing.-Arch. 60 (1990) 529);
// a contact that does not settle is flagged.

#include "mechanics/contact.h"

namespace palpa::mechanics {

struct SteadySlide {
    Eigen::Vector2d direction{1.0, 0.0};  // of the tool's motion, length 1
    double coefficient = 0.3;
    int max_changes = 40;  // of the active set before Gauss-Seidel takes over; 0: Gauss-Seidel from the start
    int sweeps = 300;
};

// Scratch memory.
struct SteadyWork {
    ContactWork contact;                  // for its lists of candidates
    Eigen::MatrixXd A;                    // between candidates
    Eigen::VectorXd delta_m, p_N, gap_m;  // per candidate
    std::vector<int> active;              // positions in the list of candidates of the nodes in contact
};

// Computes the contact while the tool passes over its pose. tangential_x_N and tangential_y_N hold the slope of the
// pressure and the friction, sum p d(delta)/dx + mu p e_x. violation_m is max |min(A_ii p_i, g_i)|: the largest
// penetration, or pressing without touch. energy_J is NaN, since it would need the tangential compliance. Throws
// LoadError unless the compliance was computed with sideways = true and the pose is finite.
void slide_steadily(const Compliance& compliance, const Tool& tool, const SteadySlide& slide, SteadyWork& work,
                    Contact& contact);

}  // namespace palpa::mechanics
