#pragma once
// Virtual rolling indentation: the force on a sphere or cylinder, frictionless or sliding steadily with friction, at
// many places of a bonded block that holds stiff spheres. It is computed from a few finite element tables instead of
// one mesh that is fine everywhere.
//
// Under the tool the surface compliance (depression at a by a unit force at b) is taken apart:
//
//   C(a, b) = G(a - b)          the plain layer, far wider than thick: one column of a fine mesh
//           + S(a, b)           what the free sides change: plain block minus plain layer, both on one
//                               coarse uniform mesh, in which the singular part at a = b cancels
//           + sum_k T_k(a, b)   what inclusion group k changes: block with it minus block without it, both on
//                               one mesh graded around it
//
// S and T are smooth, since inclusions lie below the surface, so they are stored on a few sample lines and interpolated
// by cubics. G does not depend on the place: the lattice of contact nodes moves with the tool, so that rolling over
// nodes causes no ripple. All parts are computed by linear finite elements (hex8_bbar) with small displacements. With
// friction the same columns also give how pressing moves the surface sideways, which is taken apart likewise
// (steady_sliding.h).

#include <functional>
#include <span>
#include <vector>

#include "mechanics/contact.h"
#include "mechanics/steady_sliding.h"

namespace palpa::mechanics {

struct Inclusion {
    Sphere sphere;  // in the block's frame: a corner at the origin, z up, the surface at zmax
    Material material;
};

struct RollingModel {
    std::array<double, 3> size_m{0.12, 0.12, 0.025};
    Material tissue;
    std::vector<Inclusion> inclusions;  // inside the block, without overlap
    IndenterShape shape = IndenterShape::sphere;
    double radius_m = 0.004;
    double length_m = 0.0;  // of a cylinder
    double friction = 0.0;  // coefficient; 0 if the tool rolls, or slides without friction
    double least_depth_m = 0.002;
    double greatest_depth_m = 0.007;
};

// How fine each table is.
struct RollingMesh {
    double contact_m = 0.0;                     // spacing of the lattice under the tool; divides a cylinder's length
    std::array<double, 2> surface_m{0.0, 0.0};  // spacing of S along x and y; divides half the block
    double cells_across = 8.0;                  // cells across the diameter of an inclusion
    double reach_m = 0.0;                       // distance beyond an inclusion at which T has faded to 0
};
// Chooses contact_m so that sqrt(R d) / contact_m > 4 at the least depth, as long as at most about 600 nodes are then
// under the tool. coarseness 1 is meant for maps, larger values are for quick tests and for estimates of the error: they
// make every spacing that much wider. 0.5 is for a check: it halves every spacing, however many nodes that needs, but
// surface_m, which no block of more than 60 cells from its middle to a side has finer. Throws LoadError or MaterialError for a model that cannot be computed.
RollingMesh choose_rolling_mesh(const RollingModel& model, double coarseness = 1.0);

// G at offsets of (i, j) spacings, i, j >= 0: value[j n_x + i], m/N. along_x, along_y: how far the point at that offset
// from the load moves along x and y, m/N; empty without friction.
struct LayerKernel {
    std::array<double, 2> spacing_m{0.0, 0.0};
    int n_x = 0;
    int n_y = 0;
    std::vector<double> value;
    std::vector<double> along_x, along_y;
};

// A function of two surface points near each other. value[node][dy + reach_y][dx + reach_x], with node = iy n_x + ix
// and dx, dy in sample lines, is the depression at the node per newton pressing at node + (dx, dy), m/N; it is
// symmetric. along_x, along_y: how far the node moves along x and y, m/N; empty without friction.
struct PairTable {
    std::vector<double> x_m, y_m;  // sample lines
    int reach_x = 0;
    int reach_y = 0;
    std::vector<double> value;
    std::vector<double> along_x, along_y;
};

LayerKernel contact_kernel(const RollingModel& model, const RollingMesh& mesh);
PairTable side_table(const RollingModel& model, const RollingMesh& mesh);

// Returns groups of positions in model.inclusions: inclusions nearer to each other than the mesh's reach_m, measured
// horizontally between their surfaces, belong to one group and one mesh.
std::vector<std::vector<int>> inclusion_groups(const RollingModel& model, const RollingMesh& mesh);
PairTable inclusion_table(const RollingModel& model, const RollingMesh& mesh, const std::vector<int>& group);

struct RollingTables {
    LayerKernel contact;
    std::vector<PairTable> parts;  // of the sides, then of the groups
};

// The answer at one place and depth. Without friction the tangential force is that of the pressure on the tool,
// sum p d(delta)/dx (contact_geometry.h). This is the slope of the energy, but it becomes inexact at the rim as the
// depth nears the radius, so maps take differences of energy_J instead. With friction, normal_N and tangential_x_N
// belong to a slide along +x, tangential_y_N to one along +y, and energy_J is NaN.
struct RollingForce {
    double normal_N = 0.0;
    double tangential_x_N = 0.0;
    double tangential_y_N = 0.0;
    double energy_J = 0.0;
    double area_m2 = 0.0;
};

struct RollingWork {
    Compliance patch;
    ContactWork contact;
    SteadyWork slide;
    Contact answer;
    std::vector<double> lattice_x, lattice_y;  // places of the lattice's nodes, m
    std::vector<int> lattice_i, lattice_j;     // their positions in the lattice
    Eigen::MatrixXd local, half, weight;
};

// Computes the forces at each depth (ascending) with the tool's lowest point at (x, y). The tool may hang over a side
// of the block. Throws LoadError if no part of the block is under it or a depth is not between 0 and the thickness, and
// SolverError if a slide does not settle (far too much friction).
void roll_to(const RollingModel& model, const RollingMesh& mesh, const RollingTables& tables, double x_m, double y_m,
             std::span<const double> depths_m, RollingWork& work, std::vector<RollingForce>& out);

// Computes the forces at one place on a single mesh of the whole block, graded around the place: the reference that
// shows the error of taking the compliance apart. spacing_m: of the nodes under the tool.
std::vector<RollingForce> press_on_one_mesh(const RollingModel& model, double spacing_m, double cells_across,
                                            double x_m, double y_m, std::span<const double> depths_m);

}  // namespace palpa::mechanics
