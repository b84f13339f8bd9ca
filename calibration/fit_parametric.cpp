// Fits of exponential, exponential with offset, and power. All three are F = A exp(theta z) + c with
//
//   exponential, exponential_offset   z = x / scale - 1   (0 at full scale: nothing overflows)
//   power                             z = log(x / scale)
//
// and c = 0 except for the offset. For a given theta, A and c are a linear problem: variable projection (Golub &
// Pereyra, SIAM J. Numer. Anal. 10, 1973). theta is searched over its whole sensible range, so that no start can miss
// it. Then all parameters are refined together by damped Gauss-Newton, whose fixed point does not depend on where it
// began.

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "calibration/fit.h"
#include "files/quantile.h"

namespace palpa::calibration {
namespace {

bool has_offset(const FitOptions& options) { return options.model == CurveModel::exponential_offset; }

// In log space without an offset the model is log F = p0 + theta z, and p0 = log A is the parameter.
bool log_line(const FitOptions& options) { return options.error == ErrorModel::log && !has_offset(options); }

// Writes the residuals at p = (A or log A, theta, c) into work.residual and returns the cost with the present weights;
// infinity if the logarithm of the model does not exist.
double residuals(const FitPoints& points, const FitOptions& options, const Eigen::Vector3d& p, FitWorkspace& work) {
    if (log_line(options)) {
        work.residual = work.log_force - p(0) - p(1) * work.z;
    } else {
        work.wave = (p(1) * work.z).exp();
        work.residual = points.force_N - p(0) * work.wave - p(2);
        if (options.error == ErrorModel::log) {
            // F = f - r must be above 0 at every point that counts
            work.jacobian.col(2) = (points.force_N - work.residual).matrix();
            if (((work.jacobian.col(2).array() <= 0.0) && (work.weight > 0.0)).any()) return kInfinity;
            work.residual = work.log_force - work.jacobian.col(2).array().max(1e-300).log();
        }
    }
    return (work.weight * work.residual.square()).sum();
}

// Computes d(model)/dp; to be called after residuals() at the same p.
void jacobian(const FitOptions& options, const Eigen::Vector3d& p, FitWorkspace& work) {
    if (log_line(options)) {
        work.jacobian.col(0).setOnes();
        work.jacobian.col(1) = work.z.matrix();
        return;
    }
    if (options.error == ErrorModel::log) {  // column 2 holds F
        work.jacobian.col(2) = work.jacobian.col(2).cwiseInverse();
        work.jacobian.col(0) = (work.wave * work.jacobian.col(2).array()).matrix();
    } else {
        work.jacobian.col(0) = work.wave.matrix();
        work.jacobian.col(2).setOnes();
    }
    work.jacobian.col(1) = (p(0) * work.z * work.jacobian.col(0).array()).matrix();
}

// Damped Gauss-Newton on all parameters with fixed weights. Returns false if the result is no rising curve.
bool polish(const FitPoints& points, const FitOptions& options, int steps, FitWorkspace& work, Eigen::Vector3d& p) {
    const Eigen::Index k = has_offset(options) ? 3 : 2;
    double cost = residuals(points, options, p, work);
    double damping = 0.0;
    for (int step = 0; step < steps && std::isfinite(cost); ++step) {
        jacobian(options, p, work);
        const auto J = work.jacobian.leftCols(k);
        const Eigen::MatrixXd weighted = (J.array().colwise() * work.weight).matrix();
        const Eigen::MatrixXd normal = J.transpose() * weighted;
        const Eigen::VectorXd gradient = weighted.transpose() * work.residual.matrix();
        const Eigen::VectorXd unit = normal.diagonal().array().sqrt().max(1e-300).inverse();
        Eigen::MatrixXd scaled = unit.asDiagonal() * normal * unit.asDiagonal();
        bool better = false;
        Eigen::Vector3d change = Eigen::Vector3d::Zero();
        for (int attempt = 0; attempt < 12 && !better; ++attempt) {
            Eigen::MatrixXd damped = scaled;
            damped.diagonal().array() += damping;
            change.head(k) = unit.asDiagonal() * damped.ldlt().solve(unit.asDiagonal() * gradient);
            const Eigen::Vector3d next = p + change;
            const double next_cost = residuals(points, options, next, work);
            better = next_cost <= cost * (1.0 + 1e-12);
            if (better) {
                p = next;
                cost = next_cost;
                damping *= 0.1;
                if (damping < 1e-9) damping = 0.0;
            } else {
                damping = std::max(10.0 * damping, 1e-4);
            }
        }
        if (!better) {
            cost = residuals(points, options, p, work);
            break;
        }
        if ((change.array().abs() <= 1e-14 * p.array().abs().max(1e-300)).all()) break;
    }
    const double A = log_line(options) ? 1.0 : p(0);
    return std::isfinite(cost) && p.allFinite() && A * p(1) > 0.0;
}

// Computes the best A (and c) for one theta and returns the cost. With a log error, weights 1/f^2 replace the
// logarithm.
double project(const FitPoints& points, const FitOptions& options, double theta, const Eigen::ArrayXd& w,
               FitWorkspace& work, Eigen::Vector3d& p) {
    work.wave = (theta * work.z).exp();
    const double ss = (w * work.wave.square()).sum();
    const double sf = (w * work.wave * points.force_N).sum();
    p = {sf / ss, theta, 0.0};
    if (has_offset(options)) {
        const double n = w.sum();
        const double mean_s = (w * work.wave).sum() / n;
        const double mean_f = (w * points.force_N).sum() / n;
        const double var = (w * (work.wave - mean_s).square()).sum();
        p(0) = (w * (work.wave - mean_s) * (points.force_N - mean_f)).sum() / var;
        p(2) = mean_f - p(0) * mean_s;
    }
    if (!(p(0) * theta > 0.0) || !p.allFinite()) return kInfinity;
    return (w * (points.force_N - p(0) * work.wave - p(2)).square()).sum();
}

// Searches theta over its whole range: a grid and the start, then golden sections between the neighbours of the best.
bool search(const FitPoints& points, const FitOptions& options, FitWorkspace& work, Eigen::Vector3d& best) {
    Eigen::ArrayXd w = work.weight;
    if (options.error == ErrorModel::log) w = (w > 0.0).select(w / points.force_N.max(1e-300).square(), 0.0);
    std::vector<double> thetas;
    constexpr int kGrid = 40;  // a factor of 1.26 between neighbours, from nearly straight to 1 : e^60
    for (int i = 0; i <= kGrid; ++i) thetas.push_back(5e-3 * std::pow(60.0 / 5e-3, static_cast<double>(i) / kGrid));
    if (std::isfinite(options.start_b) && std::abs(options.start_b * options.level_scale) < 60.0) {
        thetas.push_back(options.start_b * (options.model == CurveModel::power ? 1.0 : options.level_scale));
    }
    if (has_offset(options)) {
        for (int i = 0; i <= kGrid; ++i) thetas.push_back(-thetas[static_cast<std::size_t>(i)]);
    }
    std::sort(thetas.begin(), thetas.end());
    double best_cost = kInfinity;
    std::size_t at = 0;
    Eigen::Vector3d p;
    for (std::size_t i = 0; i < thetas.size(); ++i) {
        const double cost = project(points, options, thetas[i], w, work, p);
        if (!(cost < best_cost)) continue;
        best_cost = cost;
        best = p;
        at = i;
    }
    if (!std::isfinite(best_cost)) return false;
    double low = thetas[at > 0 ? at - 1 : 0];
    double high = thetas[std::min(at + 1, thetas.size() - 1)];
    for (int i = 0; i < 40 && high - low > 1e-6 * (std::abs(low) + std::abs(high)); ++i) {
        constexpr double kGolden = 0.3819660112501051;
        const double left = low + kGolden * (high - low);
        const double right = high - kGolden * (high - low);
        Eigen::Vector3d p_left, p_right;
        const double cost_left = project(points, options, left, w, work, p_left);
        const double cost_right = project(points, options, right, w, work, p_right);
        (cost_left < cost_right ? high : low) = cost_left < cost_right ? right : left;
        if (std::min(cost_left, cost_right) < best_cost) {
            best_cost = std::min(cost_left, cost_right);
            best = cost_left < cost_right ? p_left : p_right;
        }
    }
    return true;
}

// Returns every k-th of many points, which suffice to find the right valley.
FitPoints thinned(const FitPoints& points, Eigen::Index every) {
    const Eigen::Index n = (points.level.size() + every - 1) / every;
    FitPoints few;
    few.level = Eigen::ArrayXd::NullaryExpr(n, [&](Eigen::Index i) { return points.level(i * every); });
    few.force_N = Eigen::ArrayXd::NullaryExpr(n, [&](Eigen::Index i) { return points.force_N(i * every); });
    return few;
}

void prepare(const FitPoints& points, const FitOptions& options, FitWorkspace& work) {
    const Eigen::Index n = points.level.size();
    work.log_force = points.force_N.max(1e-300).log();
    if (options.model == CurveModel::power) {
        work.z = (points.level / options.level_scale).max(1e-300).log();
    } else {
        work.z = points.level / options.level_scale - 1.0;
    }
    work.jacobian.resize(n, 3);
    // points that cannot enter the fit have weight 0: no logarithm of 0, no power law at level 0
    work.weight = Eigen::ArrayXd::Ones(n);
    if (options.error == ErrorModel::log) work.weight = (points.force_N > 0.0).select(work.weight, 0.0);
    if (options.model == CurveModel::power) work.weight = (points.level > 0.0).select(work.weight, 0.0);
}

// Returns 1.4826 times the median of |residual|: the standard deviation for normal residuals, not affected by slips.
double residual_scale(FitWorkspace& work, double force_scale_N, ErrorModel error) {
    Eigen::Index n = 0;
    work.sorted.resize(work.residual.size());
    for (Eigen::Index i = 0; i < work.residual.size(); ++i) {
        if (work.weight(i) > 0.0) work.sorted(n++) = std::abs(work.residual(i));
    }
    if (n == 0) return 1.0;
    const std::span<double> sizes(work.sorted.data(), static_cast<std::size_t>(n));
    const double median = files::reordered_quantile(sizes, 0.5, files::QuantileType::nearest);
    return std::max(1.4826 * median, 1e-9 * (error == ErrorModel::newton ? force_scale_N : 1.0));
}

// Applies robust weights. Huber: full weight up to 1.345 scales, then as 1/|r| (95 % efficient). Tukey: none beyond
// 4.685 scales.
void believe(const FitOptions& options, double scale, FitWorkspace& work) {
    if (options.robust == Robust::huber) {
        work.weight *= (1.345 * scale / work.residual.abs().max(1e-300)).min(1.0);
    } else if (options.robust == Robust::tukey) {
        work.weight *= (1.0 - (work.residual / (4.685 * scale)).square()).max(0.0).square();
    }
}

// One Gauss-Newton step with the weights of the present residuals, in one pass over the points, block by block: refits
// to resampled points spend most of their time here. Returns the greatest relative change, infinity if the step fails.
double reweighted_step(const FitPoints& points, const FitOptions& options, const Eigen::ArrayXd& count, double scale,
                       FitWorkspace& work, Eigen::Vector3d& p) {
    constexpr Eigen::Index kBlock = 512;
    using Block = Eigen::Array<double, Eigen::Dynamic, 1, 0, kBlock, 1>;  // on the stack
    const bool line = log_line(options);
    const bool log_error = options.error == ErrorModel::log;
    const Eigen::Index k = has_offset(options) ? 3 : 2;
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (Eigen::Index from = 0; from < points.level.size(); from += kBlock) {
        const Eigen::Index n = std::min(kBlock, points.level.size() - from);
        const auto z = work.z.segment(from, n);
        Block j0 = Block::Ones(n);
        Block j1 = z;
        Block j2 = Block::Ones(n);
        Block r;
        if (line) {
            r = work.log_force.segment(from, n) - p(0) - p(1) * z;
        } else {
            j0 = (p(1) * z).exp();
            const Block F = p(0) * j0 + p(2);
            if (log_error) {
                if ((F <= 0.0).any()) return kInfinity;
                j2 = F.inverse();
                j0 *= j2;
                r = work.log_force.segment(from, n) - F.log();
            } else {
                r = points.force_N.segment(from, n) - F;
            }
            j1 = p(0) * z * j0;
        }
        Block w = work.weight.segment(from, n);
        if (count.size() > 0) w *= count.segment(from, n);
        if (options.robust == Robust::huber) w *= (1.345 * scale / r.abs().max(1e-300)).min(1.0);
        if (options.robust == Robust::tukey) w *= (1.0 - (r / (4.685 * scale)).square()).max(0.0).square();
        const Block w0 = w * j0;
        const Block w1 = w * j1;
        normal(0, 0) += (w0 * j0).sum();
        normal(0, 1) += (w0 * j1).sum();
        normal(1, 1) += (w1 * j1).sum();
        gradient(0) += (w0 * r).sum();
        gradient(1) += (w1 * r).sum();
        if (k == 3) {
            const Block w2 = w * j2;
            normal(0, 2) += (w0 * j2).sum();
            normal(1, 2) += (w1 * j2).sum();
            normal(2, 2) += (w2 * j2).sum();
            gradient(2) += (w2 * r).sum();
        }
    }
    if (k == 2) normal(2, 2) = 1.0;
    const Eigen::Vector3d unit = normal.diagonal().array().sqrt().max(1e-300).inverse();
    const Eigen::Matrix3d scaled =
        unit.asDiagonal() * Eigen::Matrix3d(normal.selfadjointView<Eigen::Upper>()) * unit.asDiagonal();
    const Eigen::Vector3d change = unit.asDiagonal() * scaled.ldlt().solve(unit.asDiagonal() * gradient);
    p += change;
    const bool rises = (line || p(0) > 0.0 || has_offset(options)) && (line ? 1.0 : p(0)) * p(1) > 0.0;
    if (!p.allFinite() || !rises) return kInfinity;
    return (change.array().abs() / p.array().abs().max(1e-300)).maxCoeff();
}

// Reweighted least squares until the parameters no longer change.
bool reweighted(const FitPoints& points, const FitOptions& options, FitWorkspace& work, FitStart& start) {
    constexpr int kScaleRounds = 8;  // then the scale is kept, or it and the weights might alternate for ever
    constexpr int kMostRounds = 200;
    const FitStart before = start;
    for (int round = 0; round < kMostRounds; ++round) {
        if (round < kScaleRounds) {
            if (!std::isfinite(residuals(points, options, start.p, work))) break;
            start.scale = residual_scale(work, points.force_N.maxCoeff(), options.error);
        }
        const double change = reweighted_step(points, options, {}, start.scale, work, start.p);
        if (!std::isfinite(change)) break;
        if (round >= kScaleRounds && change < 1e-13) return true;
    }
    // Not converged: start again from the parameters before, with damped steps for each set of weights.
    start = before;
    const Eigen::ArrayXd count = work.weight;
    for (int round = 0; round < kMostRounds; ++round) {
        const Eigen::Vector3d last = start.p;
        work.weight = count;
        if (!std::isfinite(residuals(points, options, start.p, work))) return false;
        if (round < kScaleRounds) start.scale = residual_scale(work, points.force_N.maxCoeff(), options.error);
        believe(options, start.scale, work);
        if (!polish(points, options, 5, work, start.p)) return false;
        if (((start.p - last).array().abs() <= 1e-10 * start.p.array().abs()).all()) break;
    }
    work.weight = count;
    return true;
}

// Straight points would give an exponential with offset parameters without bound, A = -c. The curve that has the same
// values at both ends and is bent by the least that is sensible stays within 2e-4 of its rise.
Eigen::Vector3d bent_enough(const FitOptions& options, const Eigen::Vector3d& p) {
    constexpr double kLeastBend = 1e-3;
    if (!has_offset(options) || std::abs(p(1)) >= kLeastBend) return p;
    const double theta = std::copysign(kLeastBend, p(1));
    const double A = p(0) * std::expm1(-p(1)) / std::expm1(-theta);
    return {A, theta, p(0) + p(2) - A};
}

std::optional<Curve> curve_of(const FitOptions& options, const Eigen::Vector3d& found) {
    const Eigen::Vector3d p = bent_enough(options, found);
    const double A = log_line(options) ? std::exp(p(0)) : p(0);
    Curve curve;
    curve.model = options.model;
    if (options.model == CurveModel::power) {
        curve.a_N = A * std::pow(options.level_scale, -p(1));
        curve.b = p(1);
    } else {
        curve.a_N = A * std::exp(-p(1));
        curve.b = p(1) / options.level_scale;
        curve.offset_N = has_offset(options) ? p(2) : 0.0;
    }
    const bool usable = std::isfinite(curve.a_N) && std::isfinite(curve.b) && std::isfinite(curve.offset_N) &&
                        curve.a_N * curve.b > 0.0;
    return usable ? std::optional(curve) : std::nullopt;
}

}  // namespace

bool start_fit(const FitPoints& points, const FitOptions& options, FitWorkspace& work, FitStart& start) {
    constexpr Eigen::Index kEnough = 400;
    const Eigen::Index n = points.level.size();
    const FitPoints few = n > 2 * kEnough ? thinned(points, n / kEnough) : points;
    prepare(few, options, work);
    if ((work.weight > 0.0).count() < parameter_count(options.model)) return false;
    if (!search(few, options, work, start.p)) return false;
    prepare(points, options, work);
    if (log_line(options)) start.p(0) = std::log(std::max(start.p(0), 1e-300));
    if (!polish(points, options, 100, work, start.p)) return false;
    if (options.robust == Robust::none) return true;
    FitOptions huber = options;  // convex, and a safe start for Tukey's weights
    huber.robust = Robust::huber;
    if (!reweighted(points, huber, work, start)) return false;
    return options.robust == Robust::huber || reweighted(points, options, work, start);
}

std::optional<Curve> curve_at(const FitOptions& options, const FitStart& start) { return curve_of(options, start.p); }

std::optional<Curve> refit(const FitPoints& points, const FitOptions& options, const Eigen::ArrayXd& count,
                           const FitStart& start, FitWorkspace& work) {
    // So close to the solution, three steps leave less than a hundredth of the spread that is estimated.
    FitStart here = start;
    for (int step = 0; step < 3; ++step) {
        if (!std::isfinite(reweighted_step(points, options, count, start.scale, work, here.p))) return std::nullopt;
    }
    return curve_of(options, here.p);
}

}  // namespace palpa::calibration
