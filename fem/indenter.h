#pragma once
// The indenter of a case: from its depth or force to forces on the nodes of the surface.

#include <functional>

#include "fem/case.h"
#include "mechanics/statics.h"

namespace palpa::fem {

// What is being done, and how much of how much (total 0: not known).
using FemProgress = std::function<void(const char* what, int done, int total)>;

struct IndenterContact {
    Eigen::Matrix3Xd force_N;  // on the tissue, per node of the mesh
    double normal_N = 0.0;     // pressing
    double area_m2 = 0.0;      // mechanics/contact_area.h
    double depth_m = 0.0;
    double lateral_N[2] = {0.0, 0.0};  // resists motion of the tool along +x, +y (contact.h)
    int nodes = 0;
    int columns = 0;  // of the compliance that was needed
    double seconds = 0.0;
    double cells_across_radius = 0.0;  // sqrt(R depth) over the spacing of the nodes in contact
    bool settled = true;
    std::string why_not_settled;
    bool over_edge = false;  // part of the tool is beside the tissue
};

// `before_m`: how the other loads and supports move every node, 3 x nodes; the tool then comes down to its depth below
// the surface as it was at rest. Compliance of a rectangle around the tool, enlarged until the contact lies inside; then the contact.
// Friction: the tool goes straight down in equal steps, so that what sticks first stays. Throws InputError
// for a force that the tissue cannot take and for a tool on supported nodes.
IndenterContact press_indenter(const FemCase& model, const mechanics::Factored& factored,
                               const Eigen::Matrix3Xd& before_m, const FemProgress& progress);

// What a person must know of it: a contact that the mesh cannot resolve, one that did not settle.
std::vector<std::string> contact_warnings(const IndenterContact& contact);

}  // namespace palpa::fem
