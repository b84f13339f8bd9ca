#include "mechanics/pin_shape.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/error.h"
#include "mechanics/sheet.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;

constexpr int kMostPins = 400;
constexpr int kSamplesPerPitch = 2;
constexpr double kLeastSheet = 0.05;  // thickness over pitch: a thinner sheet hides nothing

void check(const PinGrid& g, const PinShapeOptions& o) {
    if (g.rows < 1 || g.columns < 1 || g.rows > kMostPins || g.columns > kMostPins || pin_count(g) > kMostPins)
        throw LoadError(text("pins: ", g.rows, " x ", g.columns, "; wanted at least one and at most ", kMostPins));
    const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
    if (!positive(g.pitch_m) || !positive(g.diameter_m) || !positive(g.stroke_m) || !positive(g.step_m) ||
        !positive(g.speed_m_per_s) || g.step_m > g.stroke_m) {
        throw LoadError(text("pins: pitch ", g.pitch_m, " m, diameter ", g.diameter_m, " m, stroke ", g.stroke_m,
                             " m, step ", g.step_m, " m, speed ", g.speed_m_per_s,
                             " m/s; wanted finite numbers > 0 and a step within the stroke"));
    }
    if (o.sheet == Sheet::off) return;
    if (!positive(o.sheet_thickness_m) || o.sheet_thickness_m > 5.0 * g.pitch_m ||
        o.sheet_thickness_m < kLeastSheet * g.pitch_m || !positive(o.penalty)) {
        throw LoadError(text("sheet: thickness ", o.sheet_thickness_m, " m, penalty ", o.penalty,
                             "; wanted from 0.05 to 5 times the pitch of ", g.pitch_m, " m and > 0"));
    }
}

// Places along one axis, symmetric about 0.
double along(Index k, Index count, double spacing_m) {
    return (static_cast<double>(k) - 0.5 * static_cast<double>(count - 1)) * spacing_m;
}

Eigen::Matrix2Xd lattice(Index rows, Index columns, double spacing_m) {
    Eigen::Matrix2Xd out(2, rows * columns);
    for (Index k = 0; k < out.cols(); ++k)
        out.col(k) << along(k % columns, columns, spacing_m), along(k / columns, rows, spacing_m);
    return out;
}

// The least squares inverse of `forward`, with a penalty on the deviation from the mean.
Eigen::MatrixXd flattened_inverse(const Eigen::MatrixXd& forward, double penalty) {
    const Index n = forward.cols();
    Eigen::MatrixXd H = forward.transpose() * forward;
    const double weight = penalty * H.trace() / static_cast<double>(n);
    H.diagonal().array() += weight;
    H.array() -= weight / static_cast<double>(n);
    return H.llt().solve(forward.transpose());
}

double middle_m(const PinShape& shape) {
    return shape.options.zero == PinZero::top ? shape.grid.stroke_m : 0.5 * shape.grid.stroke_m;
}

// The greatest factor up to 1 with which deviations from `low_m` to `high_m` fit the stroke.
double fitting_scale(const PinShape& shape, double low_m, double high_m) {
    const double stroke_m = shape.grid.stroke_m;
    if (shape.options.zero == PinZero::top) return high_m - low_m > stroke_m ? stroke_m / (high_m - low_m) : 1.0;
    const double room_m = middle_m(shape);
    double scale = 1.0;
    if (-low_m > room_m) scale = std::min(scale, room_m / -low_m);
    if (high_m > stroke_m - room_m) scale = std::min(scale, (stroke_m - room_m) / high_m);
    return scale;
}

}  // namespace

PinShape make_pin_shape(const PinGrid& grid, const PinShapeOptions& options) {
    check(grid, options);
    PinShape shape{grid, options, lattice(grid.rows, grid.columns, grid.pitch_m), {}, {}, {}};
    if (options.sheet == Sheet::off) {
        shape.sample_m = shape.pin_m;
        return shape;
    }
    shape.sample_m = lattice(kSamplesPerPitch * (grid.rows - 1) + 1, kSamplesPerPitch * (grid.columns - 1) + 1,
                             grid.pitch_m / kSamplesPerPitch);
    shape.forward = sheet_forward(grid, options.sheet, options.sheet_thickness_m, shape.sample_m);
    shape.inverse = flattened_inverse(shape.forward, options.penalty);
    return shape;
}

void pin_sinks_m(const PinShape& shape, const Eigen::Ref<const Eigen::VectorXd>& u_m,
                 Eigen::Ref<Eigen::VectorXd> sink_m) {
    if (shape.inverse.size() > 0)
        sink_m.noalias() = shape.inverse * u_m;
    else
        sink_m = u_m;
}

void pins_from_sinks_m(const PinShape& shape, double depth_m, const Eigen::Ref<const Eigen::VectorXd>& sink_m,
                       Eigen::Ref<Eigen::VectorXd> height_m, PinReport& report) {
    report = {};
    double low_m = std::numeric_limits<double>::infinity();
    double high_m = -low_m;
    for (Index k = 0; k < sink_m.size(); ++k) {
        const double above_m = depth_m - sink_m(k);
        height_m(k) = above_m;
        if (!std::isfinite(above_m)) continue;
        low_m = std::min(low_m, above_m);
        high_m = std::max(high_m, above_m);
    }
    const bool any = high_m >= low_m;
    if (any && shape.options.over_stroke == OverStroke::scale) report.scale = fitting_scale(shape, low_m, high_m);
    const bool to_top = shape.options.zero == PinZero::top;
    const double base_m = to_top && any ? middle_m(shape) - report.scale * high_m : middle_m(shape);
    constexpr double kRoundOff = 1e-9;  // of the stroke
    for (Index k = 0; k < height_m.size(); ++k) {
        const double wanted_m = std::isfinite(height_m(k)) ? base_m + report.scale * height_m(k) : middle_m(shape);
        height_m(k) = std::clamp(wanted_m, 0.0, shape.grid.stroke_m);
        if (std::abs(height_m(k) - wanted_m) > kRoundOff * shape.grid.stroke_m) ++report.clipped;
    }
}

void pin_heights_m(const PinShape& shape, double depth_m, const Eigen::Ref<const Eigen::VectorXd>& u_m,
                   Eigen::Ref<Eigen::VectorXd> height_m, PinReport& report) {
    // the heights hold the sinks for a moment, entry by entry
    pin_sinks_m(shape, u_m, height_m);
    pins_from_sinks_m(shape, depth_m, height_m, height_m, report);
}

double rest_height_m(const PinShape& shape) { return middle_m(shape); }

void shape_on_top_m(const PinShape& shape, const Eigen::Ref<const Eigen::VectorXd>& height_m,
                    Eigen::Ref<Eigen::VectorXd> out_m) {
    if (shape.forward.size() > 0)
        out_m.noalias() = shape.forward * height_m;
    else
        out_m = height_m;
}

double shape_mismatch_m(const PinShape& shape, double depth_m, const Eigen::Ref<const Eigen::VectorXd>& u_m,
                        const Eigen::Ref<const Eigen::VectorXd>& height_m) {
    double sum = 0.0;
    double squares = 0.0;
    for (Index k = 0; k < u_m.size(); ++k) {
        const double felt_m = shape.forward.size() > 0 ? shape.forward.row(k).dot(height_m) : height_m(k);
        const double miss_m = felt_m - (middle_m(shape) + depth_m - u_m(k));
        sum += miss_m;
        squares += miss_m * miss_m;
    }
    const double n = static_cast<double>(u_m.size());
    const double mean_m = shape.options.zero == PinZero::top ? sum / n : 0.0;
    return std::sqrt(std::max(0.0, squares / n - mean_m * mean_m));
}

void round_to_steps_m(const PinShape& shape, Eigen::Ref<Eigen::VectorXd> carried_m,
                      Eigen::Ref<Eigen::VectorXd> height_m) {
    const double step_m = shape.grid.step_m;
    const double most = std::floor(shape.grid.stroke_m / step_m + 1e-9);
    for (Index k = 0; k < height_m.size(); ++k) {
        const double wanted_m = height_m(k) + (shape.options.dither ? carried_m(k) : 0.0);
        height_m(k) = step_m * std::clamp(std::round(wanted_m / step_m), 0.0, most);
        if (shape.options.dither) carried_m(k) = std::clamp(wanted_m - height_m(k), -0.5 * step_m, 0.5 * step_m);
    }
}

void slew_pins_m(const PinGrid& grid, double dt_s, const Eigen::Ref<const Eigen::VectorXd>& target_m,
                 Eigen::Ref<Eigen::VectorXd> height_m) {
    const double most_m = grid.speed_m_per_s * dt_s;
    for (Index k = 0; k < height_m.size(); ++k) {
        if (!std::isfinite(target_m(k))) continue;
        height_m(k) += std::clamp(target_m(k) - height_m(k), -most_m, most_m);
    }
}

double stroke_used_up_at_N(const PinShape& shape, double depth_m_per_N,
                           const Eigen::Ref<const Eigen::VectorXd>& sink_m_per_N) {
    const double low = depth_m_per_N - sink_m_per_N.maxCoeff();
    const double high = depth_m_per_N - sink_m_per_N.minCoeff();
    const double room_m = middle_m(shape);
    const double stroke_m = shape.grid.stroke_m;
    double force_N = std::numeric_limits<double>::infinity();
    if (shape.options.zero == PinZero::top) return high > low ? stroke_m / (high - low) : force_N;
    if (low < 0.0) force_N = std::min(force_N, room_m / -low);
    if (high > 0.0) force_N = std::min(force_N, (stroke_m - room_m) / high);
    return force_N;
}

}  // namespace palpa::mechanics
