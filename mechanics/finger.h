#pragma once
// A fingertip on a surface whose compliance is known. Three contacts:
//
// parabola  the pressure has a fixed shape, p(r) = Pmax (1 - 4 r^2/d0^2), whatever the tissue. The answer is linear.
//           Source: "Integrating Tactile and Force Feedback with Finite Element Models", equation (1).
// rigid     a rigid sphere (contact.h): the shape is given, the pressure follows.
// pad       an elastic sphere: the compliance of a half-space of the pad's modulus is added to that of the tissue, as
//           Hertz's theory does, so that shape and pressure both follow. Its modulus rises with the force (PadLaw).
//
// The depth is always the tissue's own work-conjugate mean, in all three contacts:
//
//   depth = int p u dA / F = 2 (elastic energy of the tissue) / F
//
// u: depression of the tissue. It is what the finger's bone would sink if the finger were rigid: a person who feels the
// answer on a device brings a pad of their own, whose yielding must not be counted twice.
//
// Places are in the frame of the compliance (x, y). Only make_finger_work() throws or allocates,
// and half_space_kernel_per_m().

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

#include "mechanics/contact.h"
#include "mechanics/surface_grid.h"

namespace palpa::mechanics {

enum class FingerContact { parabola, rigid, pad };

// Young's modulus of the pad: young_Pa + rise_Pa_per_N * force. The defaults are assumed, not measured: together with
// 16 mm they give a contact radius of 4 mm and a pad that yields 2 mm at 1 N.
struct PadLaw {
    double young_Pa = 35e3;
    double rise_Pa_per_N = 35e3;
    double poisson = 0.5;
};

struct Finger {
    FingerContact contact = FingerContact::parabola;
    double diameter_m = 16e-3;  // d0 of the parabola, or the sphere's diameter
    PadLaw pad;                 // of `pad` only
};

// What a press may reach. Beyond either the answer holds at the limit and says so.
struct FingerLimits {
    double force_N = std::numeric_limits<double>::infinity();
    double depth_share = 0.45;  // of the tissue's thickness, far beyond the linear range
};

struct FingerPress {
    double force_N = 0.0;
    double depth_m = 0.0;    // the tissue's work-conjugate mean
    double linearity = 0.0;  // linear_range.h
    bool over_edge = false;  // part of the contact is beside the touch nodes
    bool capped = false;     // the answer is at a limit: more was asked for
    bool inexact = false;    // the contact did not settle, or the search missed what was asked for by over 1e-6
    bool held = false;       // what was asked for was not finite: the answer is the last valid one
};

// The pressed nodes as runs of consecutive touch nodes.
struct NodeRun {
    int first = 0;
    int count = 0;
    int offset = 0;  // of its first force
};

// Scratch memory and the last press. `force_N` belongs to a press of one newton (parabola) or to the press itself.
struct FingerWork {
    SurfaceGrid grid;
    FingerLimits limits;
    FingerPress last;
    std::vector<NodeRun> run;
    Eigen::VectorXd force_N;     // of the nodes in `run`, one after another
    double surface_scale = 0.0;  // the last press has surface_scale * force_N on its nodes
    // parabola
    Eigen::Vector2d load_place_m{std::numeric_limits<double>::quiet_NaN(), 0.0};  // that `run` belongs to
    double share = 0.0;          // of the pressure that falls on the surface
    double depth_m_per_N = 0.0;  // per newton that arrives
    Eigen::Matrix2Xd corner_m;
    // rigid and pad
    ContactWork contact_work;
    Contact contact;
    Eigen::MatrixXd pad_per_m;  // of the pad, times its plane modulus; n_touch x n_touch, empty unless asked for
    // surface
    Eigen::VectorXd u_m;           // n_touch
    Eigen::VectorXd row_m;         // n_x
    std::vector<Stencil> stencil;  // two per point, for as many points as a call had
};

// Throws LoadError for a finger that is wrong or a surface that is not a grid, with the numbers. `most_points`: how many
// points finger_surface_m() takes without allocating. A pad needs as much memory as the compliance.
FingerWork make_finger_work(const Compliance& compliance, const Finger& finger, const FingerLimits& limits = {},
                            int most_points = 4096);

// Presses until the tissue's mean depth is reached, or with a force. Negative values and zero mean no touch. The answer
// at a place that is far from the surface is no force.
FingerPress finger_to_depth(const Compliance& compliance, const Finger& finger, const Eigen::Vector2d& place_m,
                            double depth_m, FingerWork& work);
FingerPress finger_with_force(const Compliance& compliance, const Finger& finger, const Eigen::Vector2d& place_m,
                              double force_N, FingerWork& work);

// Computes the depression of the surface at any points (absolute, 2 x n) under the last press; beside the touch nodes
// that of the nearest point of their rectangle. Between nodes by
// cubic splines; points that follow each other at the same y cost less.
void finger_surface_m(const Compliance& compliance, FingerWork& work,
                      const Eigen::Ref<const Eigen::Matrix2Xd>& points_m, Eigen::Ref<Eigen::VectorXd> out_m);

// Computes the pressure on the surface at any points under the last press, linear between the nodes' mean pressures;
// zero beside the touch nodes. For pressure displays.
void finger_pressure_Pa(const Compliance& compliance, FingerWork& work,
                        const Eigen::Ref<const Eigen::Matrix2Xd>& points_m, Eigen::Ref<Eigen::VectorXd> out_Pa);

// Returns the plane modulus E / (1 - nu^2) of the pad under a force.
double pad_modulus_Pa(const PadLaw& pad, double force_N);

// The law for a tissue whose compliance was not divided by `scale`, where it should have been, and whose forces are
// multiplied by it afterwards: (C / s + K / E(s f)) s f = C f + K / (E(s f) / s) f.
PadLaw scaled(const PadLaw& pad, double scale);

// Compliance of a half-space of plane modulus 1 Pa between the nodes of a grid, each of whose forces is spread evenly
// over its tributary rectangle (Love 1929), made symmetric: n x n. Against Hertz the force of a sphere is 0.5 % off with
// four spacings across the contact's radius, 0.1 % with eight.
Eigen::MatrixXd half_space_kernel_per_m(const SurfaceGrid& grid);

// Consistent nodal forces of one newton of parabolic pressure (loads.h) on a grid of rectangles: fills `run` and
// `force_N` of the work and `share`. Exact: rectangles inside the disc by 2 x 2 Gauss points, those at its rim by
// disc_integral.h.
void parabola_on_grid(const Eigen::Vector2d& place_m, double diameter_m, FingerWork& work);

}  // namespace palpa::mechanics
