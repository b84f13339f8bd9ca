#pragma once
// The indenter of a case: its depth or force becomes forces on the nodes of the surface.

#include <functional>

#include "fem/case.h"
#include "mechanics/statics.h"

namespace palpa::fem {

// Is told what is being done, and how much of it is done; total is 0 if it is not known.
using FemProgress = std::function<void(const char* what, int done, int total)>;

struct IndenterContact {
    Eigen::Matrix3Xd force_N;  // on the tissue, 3 x n_nodes
    double normal_N = 0.0;     // pressing is positive
    double area_m2 = 0.0;      // see mechanics/contact_area.h
    double depth_m = 0.0;
    double lateral_N[2] = {0.0, 0.0};          // resists motion of the tool along +x, +y (mechanics/contact.h)
    int nodes = 0;                             // in contact
    int columns = 0;                           // of the compliance that was computed: its touch nodes
    double seconds = 0.0;                      // that compliance and contact took
    double cells_across_radius = 0.0;          // sqrt(R depth) over the spacing of the nodes in contact
    double cells_under_radius = 0.0;           // sqrt(R depth) over the height of the cells under them
    std::optional<double> cells_along_length;  // of a cylinder that has ends: its length over that spacing along it
    bool ends_on_nodes = false;                // of such a cylinder: nodes lie on its ends, where they count whole
    bool settled = true;
    std::string why_not_settled;  // for people; empty if it settled
    bool over_edge = false;       // part of the tool is beside the tissue
};

// Solves the contact on the surface compliance of a rectangle around the tool, which grows until it holds the contact.
// With friction the tool goes straight down in equal steps, so that nodes that stick early stay where they stuck.
//
// before_m: displacement of every node by the other loads and supports, 3 x n_nodes. The tool meets the surface that
// they leave; its depth counts from the surface at rest. Throws InputError for a force that the tissue cannot take, a
// tool that touches no node, reaches supported nodes or a lower part of the surface, or needs too large a compliance.
IndenterContact press_indenter(const FemCase& model, const mechanics::Factored& factored,
                               const Eigen::Matrix3Xd& before_m, const FemProgress& progress);

// Returns warnings for people: of a contact that the mesh cannot resolve, and of one that did not settle.
std::vector<std::string> contact_warnings(const IndenterContact& contact);

}  // namespace palpa::fem
