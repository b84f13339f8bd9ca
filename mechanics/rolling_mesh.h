#pragma once
// Coordinate lists, plain blocks and checks for rolling.h; only its own sources include this.

#include "mechanics/rolling.h"
#include "mechanics/statics.h"

namespace palpa::mechanics {

// Throws LoadError / MaterialError for a model that cannot be computed.
void check_model(const RollingModel& model);

// Half the width, along x and y, of the rectangle that holds the contact nodes: the whole sphere; of a cylinder
// what is at most its greatest depth above the surface, and half its length.
std::array<double, 2> footprint_m(const RollingModel& model);

Indenter indenter_of(const RollingModel& model);

// One contact solve, two with friction: along x and along y. Throws SolverError when a slide does not settle.
RollingForce force_at(const RollingModel& model, const Compliance& compliance, const Tool& tool, RollingWork& work);

// Where cells along one axis must not be larger than `cell_m`.
struct FineZone {
    double low_m = 0.0;
    double high_m = 0.0;
    double cell_m = 0.0;
};

// Ascending coordinates over [0, length]: a node stands at both ends of every zone, cells inside are equal;
// between zones they grow by `growth` from both ends, up to `most_m`. Zones are cut to the interval; where two
// overlap the finer one wins.
Eigen::VectorXd zoned_coordinates_m(double length_m, std::vector<FineZone> zones, double growth, double most_m);

// From 0 outwards: n equal cells, then growing to `length`.
Eigen::VectorXd outward_coordinates_m(double cell_m, int n, double growth, double length_m);

// Depth below the surface (0, growing) to heights (ascending, surface at the top).
Eigen::VectorXd heights_from_depths(const Eigen::VectorXd& depth_m, double thickness_m);

// The lines of a table's mesh.
struct GridLines {
    Eigen::VectorXd x_m, y_m, z_m;
};
std::array<int, 2> contact_offsets(const RollingModel& model, const RollingMesh& mesh);  // of its table
GridLines contact_lines(const RollingModel& model, const RollingMesh& mesh);
GridLines side_lines(const RollingModel& model, const RollingMesh& mesh);        // a quarter of the block
GridLines side_layer_lines(const RollingModel& model, const RollingMesh& mesh);  // a quarter of the layer, same cells
GridLines inclusion_lines(const RollingModel& model, const RollingMesh& mesh, const std::vector<int>& group);
// Positions of the lines along x (axis 0) or y at which a group's table is stored.
std::vector<int> inclusion_samples(const RollingModel& model, const RollingMesh& mesh, const std::vector<int>& group,
                                   std::size_t axis, const Eigen::VectorXd& lines_m);

// What a group of inclusions covers along an axis.
struct Extent {
    double low_m = 1e300;
    double high_m = -1e300;
};
Extent extent_of(const RollingModel& model, const std::vector<int>& group, std::size_t axis);

// Block on a rigid base with all inclusions of the list mixed in.
Problem block_problem(const Eigen::VectorXd& x_m, const Eigen::VectorXd& y_m, const Eigen::VectorXd& z_m,
                      const Material& tissue, std::span<const Inclusion> inclusions);

// Surface node of a hex_box at line (i, j).
int surface_node(const Eigen::VectorXd& x_m, const Eigen::VectorXd& y_m, const Eigen::VectorXd& z_m, int i, int j);

}  // namespace palpa::mechanics
