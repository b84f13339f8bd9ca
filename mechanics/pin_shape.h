#pragma once
// The shape of a tissue's surface on a grid of pins under a fingertip.
//
// The arm that carries the pins shows the mean depth; the pins show the rest:
//
//   height = rest - (u - depth)
//
// u: depression of the surface; rest: `skel`: half the stroke; `top`: the height that brings the highest pin to the
// top. Heights count from the lowest position of the pins.
//
// A rubber sheet of thickness h on the pins lets through the share T of a wave of wave number k, x = k h:
//
//   free    T(x) = (cosh x + x sinh x) / (cosh^2 x + x^2)     bonded to the pins below, free above
//   backed  T(x) = (1 + x) exp(-x)                            with a half-space of the same modulus above
//
// for incompressible rubber (plane strain, Stokes' equations; derived for this program, checked against finite elements
// in tests/mechanics/test_pin_shape.cpp). The pins are set so that the top of the sheet has the wanted shape: least
// squares over `sample_m`, with a penalty on the pins' deviation from their mean. A level surface stays exactly level.

#include <Eigen/Core>
#include <vector>

namespace palpa::mechanics {

struct PinGrid {
    int rows = 6;
    int columns = 6;
    double pitch_m = 2e-3;
    double diameter_m = 1e-3;
    double stroke_m = 2e-3;
    double step_m = 1e-4;
    double speed_m_per_s = 0.03;
};

enum class PinZero { skel, top };
enum class OverStroke { clip, scale };
enum class Sheet { off, free, backed };

struct PinShapeOptions {
    PinZero zero = PinZero::skel;
    OverStroke over_stroke = OverStroke::clip;
    Sheet sheet = Sheet::off;
    double sheet_thickness_m = 2e-3;
    double penalty = 1e-2;  // of the mean diagonal of the normal equations
    bool dither = false;
};

// Prepared once. Pin (row i, column j) is number i * columns + j; it stands at ((j - (columns - 1) / 2) pitch,
// (i - (rows - 1) / 2) pitch) from the middle of the finger: columns along x, rows along y.
struct PinShape {
    PinGrid grid;
    PinShapeOptions options;
    Eigen::Matrix2Xd pin_m;     // 2 x n_pins, relative to the finger's middle
    Eigen::Matrix2Xd sample_m;  // where the surface's depression is asked for, 2 x n_sample; without a sheet pin_m
    Eigen::MatrixXd inverse;    // n_pins x n_sample, rows add up to 1; empty without a sheet
    Eigen::MatrixXd forward;    // n_sample x n_pins, rows add up to 1; empty without a sheet
};

struct PinReport {
    double scale = 1.0;  // `scale`: factor on the shape so that it fits the stroke
    int clipped = 0;     // `clip`: pins that are at an end of their stroke and should be beyond
};

inline int pin_count(const PinGrid& grid) { return grid.rows * grid.columns; }

// Throws LoadError with the numbers for a grid or sheet that is wrong: at least one pin, lengths > 0, at most 400 pins.
PinShape make_pin_shape(const PinGrid& grid, const PinShapeOptions& options);

// The linear part: how far each pin should sink for depressions u at sample_m. Costs n_pins x n_sample products with a
// sheet; a table can hold its result instead of u.
void pin_sinks_m(const PinShape& shape, const Eigen::Ref<const Eigen::VectorXd>& u_m,
                 Eigen::Ref<Eigen::VectorXd> sink_m);

// The rest: heights from sinks, within the stroke. Not finite: that pin rests.
void pins_from_sinks_m(const PinShape& shape, double depth_m, const Eigen::Ref<const Eigen::VectorXd>& sink_m,
                       Eigen::Ref<Eigen::VectorXd> height_m, PinReport& report);

// Both.
void pin_heights_m(const PinShape& shape, double depth_m, const Eigen::Ref<const Eigen::VectorXd>& u_m,
                   Eigen::Ref<Eigen::VectorXd> height_m, PinReport& report);

// Height of all pins above the surface, without touch: where the flat surface is shown.
double rest_height_m(const PinShape& shape);

// What a finger feels on top of the sheet (without one: at the pins) for given heights, at sample_m.
void shape_on_top_m(const PinShape& shape, const Eigen::Ref<const Eigen::VectorXd>& height_m,
                    Eigen::Ref<Eigen::VectorXd> out_m);

// Root mean square over sample_m of what is felt minus what is wanted. `top`: up to a common height.
double shape_mismatch_m(const PinShape& shape, double depth_m, const Eigen::Ref<const Eigen::VectorXd>& u_m,
                        const Eigen::Ref<const Eigen::VectorXd>& height_m);

// Rounds to the device's steps, within the stroke. With dither the error of each pin is carried to the next call (first
// order error diffusion in time), so that the mean over time is right; `carried_m` (n_pins, starts at 0) holds it.
void round_to_steps_m(const PinShape& shape, Eigen::Ref<Eigen::VectorXd> carried_m,
                      Eigen::Ref<Eigen::VectorXd> height_m);

// Moves heights towards targets, each pin by at most speed * dt.
void slew_pins_m(const PinGrid& grid, double dt_s, const Eigen::Ref<const Eigen::VectorXd>& target_m,
                 Eigen::Ref<Eigen::VectorXd> height_m);

// The force at which the shape of a press needs more than the stroke, from the sinks per newton and the depth per
// newton (linear tissue); infinity if it never does.
double stroke_used_up_at_N(const PinShape& shape, double depth_m_per_N,
                           const Eigen::Ref<const Eigen::VectorXd>& sink_m_per_N);

// Share of a wave that arrives on top, x = k h >= 0.
double sheet_transfer(Sheet sheet, double x);

}  // namespace palpa::mechanics
