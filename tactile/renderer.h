#pragma once
// A fingertip on the tissue of a scene: force for depth, depth for force, and the shape of the surface under the pins,
// in real newtons. Solved live on the tissue's compliance, or read from a table (table.h).

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "mechanics/finger.h"
#include "mechanics/pin_shape.h"
#include "scene/linear_tissue.h"

namespace palpa::tactile {

struct Table;

using mechanics::Finger;
using mechanics::FingerContact;
using Press = mechanics::FingerPress;

// Depth and force of a tissue that has no surface to show: a force curve, a part, a button. Linear between points from
// (0, 0) on; both rise strictly. Beyond the last point the answer holds there and says so.
struct DepthForce {
    std::vector<double> depth_m;
    std::vector<double> force_N;
};

// What is wanted of the surface: its depression at points relative to the finger's place, or linear combinations of
// them (`map`, rows x points; empty: the points themselves).
struct Observation {
    Eigen::Matrix2Xd points_m;
    Eigen::MatrixXd map;
};

// Constant while it runs. The tissue must outlive it.
struct Renderer {
    const mechanics::Compliance* compliance = nullptr;  // null: `depth_force` answers
    DepthForce depth_force;
    Finger finger;  // with the pad's law scaled (mechanics/finger.h)
    double stiffness_scale = 1.0;
    double force_limit_N = 2.5;
    Observation observed;
    std::uint64_t content = 0;  // of the tissue: with the finger's numbers, what a table depends on
};

// Where the last answer stands in a table: the first of 4 x 4 places and their weights, and the part of the shape at two
// neighbouring forces.
struct TablePlace {
    int first[2] = {0, 0};
    double weight[2][4] = {};
    int force = 0;
    double share[2] = {0.0, 0.0};  // of `force` and of the one before it
};

// Scratch memory and the last press.
struct RendererWork {
    mechanics::FingerWork finger;
    const Table* table = nullptr;  // answers where it can; set by adopt()
    // of the last press
    Press last;
    Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
    bool from_table = false;
    TablePlace at;
    Eigen::Matrix2Xd points_m;  // absolute
    Eigen::VectorXd u_m;
};

// Throw mechanics::LoadError for a finger or a curve that is wrong, with the numbers. force_limit_N: as a person feels
// it, after stiffness_scale.
Renderer make_renderer(const scene::LinearTissue& tissue, const Finger& finger, double stiffness_scale,
                       double force_limit_N, Observation observed = {});
Renderer make_renderer(DepthForce curve, double stiffness_scale, double force_limit_N);

// What a display of pins asks for: its sinks (mechanics/pin_shape.h), for pins_from_sinks_m().
Observation observation_of(const mechanics::PinShape& shape);

RendererWork make_work(const Renderer& renderer);

// From now on the table answers. A change of fidelity: whoever calls it logs it.
void adopt(const Table* table, RendererWork& work);

// Allocate nothing, throw nothing. Above the force limit (or the depth limit of finger.h) the answer stays there, with
// `capped`. What is not finite gives the last valid answer, with `held`.
Press press_to_depth(const Renderer& renderer, const Eigen::Vector2d& place_m, double depth_m, RendererWork& work);
Press press_with_force(const Renderer& renderer, const Eigen::Vector2d& place_m, double force_N, RendererWork& work);

// Computes what is observed of the surface under the last press: map * u, or u (m). Zero without a surface.
void shape_m(const Renderer& renderer, RendererWork& work, Eigen::Ref<Eigen::VectorXd> out_m);

// For pictures and pressure displays: depression of the surface (m) and pressure on it (Pa) at any points relative to
// the place, always solved live. Zero without a surface.
void surface_m(const Renderer& renderer, RendererWork& work, const Eigen::Matrix2Xd& points_m,
               Eigen::Ref<Eigen::VectorXd> out_m);
void pressure_Pa(const Renderer& renderer, RendererWork& work, const Eigen::Matrix2Xd& points_m,
                 Eigen::Ref<Eigen::VectorXd> out_Pa);

}  // namespace palpa::tactile
