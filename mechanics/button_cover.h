#pragma once
// The soft cover of a push button: a ring between a clamped rim and a stiff cap, as a net of springs.

#include <Eigen/Core>
#include <vector>

namespace palpa::mechanics {

struct ButtonCover {
    double radius_m = 0.0;      // a, of the rim
    double cap_radius_m = 0.0;  // b < a
    double thickness_m = 0.0;   // t
    double young_Pa = 0.0;      // E; the net has a Poisson's ratio of 1/3
    double density_kg_per_m3 = 0.0;
    int spacings = 24;  // of the net over the radius
    // In the frame of the cover, whose z points along the travel, into the button. 0: no gravity.
    Eigen::Vector3d gravity_m_per_s2 = Eigen::Vector3d::Zero();
};

// Springs of a triangular net, cut where the circles of rim and cap cross them; a cut spring keeps its E A, so that its
// stiffness is E A over what is left of it. Nodes 0 to n_free - 1 move; those after them stand on the rim; the last n_cap
// move with the cap.
struct CoverSpring {
    int a = 0, b = 0;
    double length_m = 0.0;   // at rest
    double k_N_per_m = 0.0;  // sqrt(3)/2 E t, uncut
};
struct CoverNet {
    Eigen::Matrix3Xd rest_m;  // 3 x n_nodes
    int n_free = 0;
    int n_cap = 0;
    std::vector<CoverSpring> springs;
    double node_kg = 0.0;  // of each free node
    double cap_kg = 0.0;
    ButtonCover cover;
};

// Throws MeshError for sizes and moduli that are not > 0, a cap that is not smaller than the cover, and fewer than two
// spacings between them or more than 200 over the radius.
// Source of k: a triangular net of springs as an isotropic sheet, e.g. Seung, Nelson, Phys. Rev. A 38 (1988), 1005:
//         E t = 2 k / sqrt(3), nu = 1/3.
CoverNet make_net(const ButtonCover& cover);

// What the net stores with its free nodes displaced by u (3 x n_free) and its cap by the travel w along z, and the force
// on the cap along z:
//   E = 1/2 sum k_i (L_i - L_i0)^2 - sum m_j g . u_j,   F = dE/dw
// The force is the gradient, not a difference of energies. The net has no bending stiffness: it does not hold for
// w below the thickness, where a sheet bends more than it stretches.
struct CoverState {
    Eigen::Matrix3Xd u_m;
    double travel_m = 0.0;
    double energy_J = 0.0;
    double force_N = 0.0;
    double slope_N_per_m = 0.0;  // dF/dw, the free nodes following
    int iterations = 0;
    bool converged = false;
};
double cover_energy_J(const CoverNet& net, const Eigen::Matrix3Xd& u_m, double travel_m);
double cover_force_N(const CoverNet& net, const Eigen::Matrix3Xd& u_m, double travel_m);

// The equilibrium at a travel (>= 0), by Newton's method from the shape of the closed form below: a flat net has no
// stiffness across itself. Where the tangent is not positive definite, or a step does not lower the energy, the step is
// damped. At a travel of 0 without gravity all is 0. `converged`: out-of-balance forces below 1e-10 of the largest spring
// force, or below what doubles resolve.
CoverState press_cover(const CoverNet& net, double travel_m);
// The same at equally spaced travels, one after the other: each is sought from the three before it, and where that fails
// from the closed form; with one analysis of the tangents' pattern.
std::vector<CoverState> press_cover(const CoverNet& net, const std::vector<double>& travels_m);

// Force of a membrane without bending stiffness and with nu = 1/3, clamped at a, pressed by a stiff cap b (N):
//   F = pi/3 E t w^3 / (a^(2/3) - b^(2/3))^3,   w(r) = w (a^(2/3) - r^(2/3)) / (a^(2/3) - b^(2/3)),   u = 0
// For small travel, w << a. Source: the equations of Foeppl; for b = 0 Schwerin's point load (Z. techn. Phys. 10 (1929),
//         651); the cap is ours.
double membrane_force_N(const ButtonCover& cover, double travel_m);

}  // namespace palpa::mechanics
