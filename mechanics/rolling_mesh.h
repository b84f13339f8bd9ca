#pragma once
// Lists of coordinates, plain blocks and checks for rolling.h. Only its own sources include this.

#include "mechanics/rolling.h"
#include "mechanics/statics.h"

namespace palpa::mechanics {

// Throws LoadError or MaterialError for a model that cannot be computed.
void check_model(const RollingModel& model);

// Returns half the size, along x and y, of the rectangle that holds the contact nodes. It holds the whole sphere; of a
// cylinder it holds the length, and along x the part that at the greatest depth is at most as high above the surface as
// the cylinder is deep.
std::array<double, 2> footprint_m(const RollingModel& model);

Indenter indenter_of(const RollingModel& model);

// Solves one contact, or two with friction: slides along x and along y. Throws SolverError if a slide does not settle.
RollingForce force_at(const RollingModel& model, const Compliance& compliance, const Tool& tool, RollingWork& work);

// A part of an axis in which cells must not be larger than `cell_m`.
struct FineZone {
    double low_m = 0.0;
    double high_m = 0.0;
    double cell_m = 0.0;
};

// Returns ascending coordinates over [0, length]. A node stands at both ends of every zone, and the cells inside a zone
// are equal. Between zones the cells grow by the factor `growth` from both ends, up to `most_m`. Zones are cut to the
// interval; where two overlap the finer one wins.
Eigen::VectorXd zoned_coordinates_m(double length_m, std::vector<FineZone> zones, double growth, double most_m);

// Returns coordinates from 0 outwards: n equal cells, then growing ones up to `length`.
Eigen::VectorXd outward_coordinates_m(double cell_m, int n, double growth, double length_m);

// Turns depths below the surface (ascending from 0) into heights above the base (ascending from 0).
Eigen::VectorXd heights_from_depths(const Eigen::VectorXd& depth_m, double thickness_m);

// The lines of a table's mesh.
struct GridLines {
    Eigen::VectorXd x_m, y_m, z_m;
};
std::array<int, 2> contact_offsets(const RollingModel& model, const RollingMesh& mesh);  // n_x, n_y of LayerKernel
GridLines contact_lines(const RollingModel& model, const RollingMesh& mesh);
GridLines side_lines(const RollingModel& model, const RollingMesh& mesh);        // a quarter of the block
GridLines side_layer_lines(const RollingModel& model, const RollingMesh& mesh);  // a quarter of the layer, same cells
GridLines inclusion_lines(const RollingModel& model, const RollingMesh& mesh, const std::vector<int>& group);
// Returns which of `lines_m`, along x (axis 0) or y (axis 1), are the sample lines of a group's table.
std::vector<int> inclusion_samples(const RollingModel& model, const RollingMesh& mesh, const std::vector<int>& group,
                                   std::size_t axis, const Eigen::VectorXd& lines_m);

// The range that a group of inclusions covers along an axis.
struct Extent {
    double low_m = 1e300;
    double high_m = -1e300;
};
Extent extent_of(const RollingModel& model, const std::vector<int>& group, std::size_t axis);

// Returns the problem of a block on a rigid base, with all inclusions of the list mixed in.
Problem block_problem(const Eigen::VectorXd& x_m, const Eigen::VectorXd& y_m, const Eigen::VectorXd& z_m,
                      const Material& tissue, std::span<const Inclusion> inclusions);

// Returns the node on the surface of a hex_box at lines (i, j).
int surface_node(const Eigen::VectorXd& x_m, const Eigen::VectorXd& y_m, const Eigen::VectorXd& z_m, int i, int j);

}  // namespace palpa::mechanics
