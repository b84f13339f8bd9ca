#pragma once
// Virtual rolling indentation: the force on a frictionless sphere or cylinder, or on one that slides steadily with
// friction, at many places of a bonded block that holds stiff spheres, from a few finite element tables instead of
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
// S and T are smooth (inclusions are some way down), so they are stored on a few sample lines and interpolated
// by cubics. G does not depend on the place: the lattice of contact nodes moves with the tool, so rolling over
// nodes makes no ripple at all. All by finite elements (hex8_bbar), linear, small displacements. With friction the
// same columns also tell how pressing moves the surface sideways, taken apart likewise (steady_sliding.h).

#include <functional>
#include <span>
#include <vector>

#include "mechanics/contact.h"
#include "mechanics/steady_sliding.h"

namespace palpa::mechanics {

struct Inclusion {
    Sphere sphere;  // in the block's frame: corner at the origin, z up, surface at zmax
    Material material;
};

struct RollingModel {
    std::array<double, 3> size_m{0.12, 0.12, 0.025};
    Material tissue;
    std::vector<Inclusion> inclusions;  // apart from each other and inside the block
    IndenterShape shape = IndenterShape::sphere;
    double radius_m = 0.004;
    double length_m = 0.0;  // of a cylinder
    double friction = 0.0;  // coefficient; 0: rolls, or slides without friction
    double least_depth_m = 0.002;
    double greatest_depth_m = 0.007;
};

// How fine each table is.
struct RollingMesh {
    double contact_m = 0.0;                     // lattice under the tool; divides a cylinder's length
    std::array<double, 2> surface_m{0.0, 0.0};  // of S; divides half the block
    double cells_across = 8.0;                  // cells over the diameter of an inclusion
    double reach_m = 0.0;                       // how far beyond an inclusion T goes before it is faded to 0
};
// sqrt(R d) / contact_m > 4 at the least depth, as long as that needs at most about 600 nodes. coarseness 1 is
// meant for maps, larger ones for quick tests, 0.5 for a check: half of every spacing, whatever that needs. Throws
// LoadError / MaterialError for a model that cannot be computed.
RollingMesh choose_rolling_mesh(const RollingModel& model, double coarseness = 1.0);

// G at offsets (i, j) times the spacing, i, j >= 0: value[j n_x + i], m/N. along_x, along_y: how far the point at
// that offset from the load moves along x and y; empty without friction.
struct LayerKernel {
    std::array<double, 2> spacing_m{0.0, 0.0};
    int n_x = 0;
    int n_y = 0;
    std::vector<double> value;
    std::vector<double> along_x, along_y;
};

// Functions of two surface points near each other. value[node][dy + reach_y][dx + reach_x], node = iy n_x + ix, dx
// and dy in sample lines: depression at the node by pressing at node + (dx, dy), symmetric. along_x, along_y: how
// far the node moves along x and y; empty without friction.
struct PairTable {
    std::vector<double> x_m, y_m;
    int reach_x = 0;
    int reach_y = 0;
    std::vector<double> value;
    std::vector<double> along_x, along_y;
};

LayerKernel contact_kernel(const RollingModel& model, const RollingMesh& mesh);
PairTable side_table(const RollingModel& model, const RollingMesh& mesh);

// Inclusions nearer to each other than the mesh's reach belong to one group and one mesh.
std::vector<std::vector<int>> inclusion_groups(const RollingModel& model, const RollingMesh& mesh);
PairTable inclusion_table(const RollingModel& model, const RollingMesh& mesh, const std::vector<int>& group);

struct RollingTables {
    LayerKernel contact;
    std::vector<PairTable> parts;  // sides, then the groups
};

// One place and depth. Without friction the tangential force is that of the pressure on the tool, sum p
// d(delta)/dx: the slope of the energy, but summed over a coarse rim once the depth nears the radius
// (contact_geometry.h). For maps take the slope of energy_J. With friction: normal_N and tangential_x_N of a slide
// along +x, tangential_y_N of one along +y, energy_J NaN.
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
    std::vector<double> lattice_x, lattice_y;  // tool-centred nodes
    std::vector<int> lattice_i, lattice_j;
    Eigen::MatrixXd local, half, weight;
};

// Forces at each depth (ascending) with the tool's lowest point over (x, y). The tool may hang over a side;
// throws LoadError when nothing of the block is under it, or a depth is not in 0 .. thickness, SolverError when a
// slide does not settle (far too much friction).
void roll_to(const RollingModel& model, const RollingMesh& mesh, const RollingTables& tables, double x_m, double y_m,
             std::span<const double> depths_m, RollingWork& work, std::vector<RollingForce>& out);

// The same place on one mesh of the whole block, graded around it, without taking anything apart: the
// reference that shows what that costs. spacing_m: of the nodes under the tool.
std::vector<RollingForce> press_on_one_mesh(const RollingModel& model, double spacing_m, double cells_across,
                                            double x_m, double y_m, std::span<const double> depths_m);

}  // namespace palpa::mechanics
