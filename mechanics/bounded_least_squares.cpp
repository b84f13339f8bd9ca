#include "mechanics/bounded_least_squares.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace palpa::mechanics {
namespace {

constexpr int kMostRows = kMostResiduals + 2 * kMostUnknowns;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostRows, kMostUnknowns>;
using Right = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostRows, 1>;

enum class BoundSide { free, lower, upper };

// The problem with scaled unknowns z_j = scale_j x_j: minimise |A z - b|.
struct Scaled {
    Rows A;
    Right b;
    SmallVector lower, upper, scale;
};

struct ActiveSet {
    SmallVector z;
    std::array<BoundSide, kMostUnknowns> side{};
    std::array<bool, kMostUnknowns> refused{};  // freed in vain since the last move
    int iterations = 0;
};

double largest(const SmallVector& values) { return values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0.0; }

Scaled scaled_of(const BoundedProblem& p) {
    const Eigen::Index m = p.W.rows();
    const Eigen::Index n = p.W.cols();
    const bool rate = p.rate.size() > 0;
    Scaled out;
    out.scale.resize(n);
    for (Eigen::Index j = 0; j < n; ++j) {
        const double pull = rate ? p.rate(j) : 0.0;
        const double length = std::hypot(p.W.col(j).norm() * std::sqrt(1.0 + p.tikhonov), pull);
        out.scale(j) = length > 0.0 ? length : 1.0;
    }
    out.A.setZero(m + (rate ? 2 : 1) * n, n);
    out.b.setZero(out.A.rows());
    out.b.head(m) = -p.d;
    for (Eigen::Index j = 0; j < n; ++j) {
        out.A.col(j).head(m) = p.W.col(j) / out.scale(j);
        out.A(m + j, j) = std::sqrt(p.tikhonov) * p.W.col(j).norm() / out.scale(j);
        if (!rate) continue;
        out.A(m + n + j, j) = p.rate(j) / out.scale(j);
        out.b(m + n + j) = p.rate(j) * p.before(j);
    }
    out.lower = p.lower.cwiseProduct(out.scale);
    out.upper = p.upper.cwiseProduct(out.scale);
    return out;
}

// Minimises over the free unknowns, the others held. The least change from z where they are not unique.
SmallVector minimum_over_free(const Scaled& s, const ActiveSet& set) {
    std::array<Eigen::Index, kMostUnknowns> column{};
    Eigen::Index count = 0;
    for (Eigen::Index j = 0; j < set.z.size(); ++j) {
        if (set.side[static_cast<std::size_t>(j)] == BoundSide::free) column[static_cast<std::size_t>(count++)] = j;
    }
    if (count == 0) return set.z;
    Rows A(s.A.rows(), count);
    for (Eigen::Index k = 0; k < count; ++k) A.col(k) = s.A.col(column[static_cast<std::size_t>(k)]);
    const Right left = s.b - s.A * set.z;
    Eigen::ColPivHouseholderQR<Rows> qr(A.rows(), A.cols());
    qr.setThreshold(1e-13);
    qr.compute(A);
    const SmallVector change = qr.solve(left);
    SmallVector out = set.z;
    for (Eigen::Index k = 0; k < count; ++k) out(column[static_cast<std::size_t>(k)]) += change(k);
    return out;
}

// The unknown at a bound whose freeing lowers the sum most, or -1.
Eigen::Index to_free(const Scaled& s, const ActiveSet& set, double tolerance) {
    const SmallVector slope = s.A.transpose() * (s.A * set.z - s.b);
    Eigen::Index best = -1;
    double most = tolerance;
    for (Eigen::Index j = 0; j < set.z.size(); ++j) {
        const auto at = static_cast<std::size_t>(j);
        if (set.side[at] == BoundSide::free || set.refused[at] || s.lower(j) == s.upper(j)) continue;
        const double gain = set.side[at] == BoundSide::lower ? -slope(j) : slope(j);
        if (gain <= most) continue;
        most = gain;
        best = j;
    }
    return best;
}

// Goes to the minimum over the free unknowns, stopping at bounds on the way, until none is in the way. False if the
// newly freed one would go outwards: round-off made it look worth freeing.
bool settle(const Scaled& s, ActiveSet& set, Eigen::Index freed, BoundSide was, int most_iterations) {
    bool first = true;
    while (set.iterations < most_iterations) {
        ++set.iterations;
        const SmallVector goal = minimum_over_free(s, set);
        if (first && freed >= 0 &&
            (was == BoundSide::lower ? goal(freed) <= set.z(freed) : goal(freed) >= set.z(freed)))
            return false;
        first = false;
        double share = 1.0;
        Eigen::Index blocked = -1;
        for (Eigen::Index j = 0; j < set.z.size(); ++j) {
            if (set.side[static_cast<std::size_t>(j)] != BoundSide::free) continue;
            const double bound = goal(j) < s.lower(j) ? s.lower(j) : s.upper(j);
            if (goal(j) >= s.lower(j) && goal(j) <= s.upper(j)) continue;
            const double part = (bound - set.z(j)) / (goal(j) - set.z(j));
            if (blocked >= 0 && part >= share) continue;
            share = std::clamp(part, 0.0, 1.0);
            blocked = j;
        }
        if (blocked < 0) {
            set.z = goal;
            return true;
        }
        const bool low = goal(blocked) < s.lower(blocked);
        set.z += share * (goal - set.z);
        set.z = set.z.cwiseMax(s.lower).cwiseMin(s.upper);
        set.z(blocked) = low ? s.lower(blocked) : s.upper(blocked);
        set.side[static_cast<std::size_t>(blocked)] = low ? BoundSide::lower : BoundSide::upper;
    }
    return true;
}

// Each unknown begins at the bound nearest to where it was, or to 0; free only where it has no bound there.
ActiveSet beginning(const Scaled& s, const SmallVector& from) {
    ActiveSet set;
    set.z = from.cwiseMax(s.lower).cwiseMin(s.upper);
    for (Eigen::Index j = 0; j < set.z.size(); ++j) {
        BoundSide& side = set.side[static_cast<std::size_t>(j)];
        side = set.z(j) == s.lower(j) ? BoundSide::lower : set.z(j) == s.upper(j) ? BoundSide::upper : BoundSide::free;
    }
    return set;
}

// Runs the active set to its end. False if the iterations run out.
bool run(const Scaled& s, ActiveSet& set) {
    const int most = 50 * static_cast<int>(set.z.size()) + 50;
    // slopes below this are round-off
    const double tolerance = 1e-14 * (s.b.norm() + largest(set.z));
    settle(s, set, -1, BoundSide::free, most);
    while (set.iterations < most) {
        const Eigen::Index j = to_free(s, set, tolerance);
        if (j < 0) return true;
        BoundSide& side = set.side[static_cast<std::size_t>(j)];
        const BoundSide was = side;
        side = BoundSide::free;
        if (settle(s, set, j, was, most)) {
            set.refused.fill(false);
        } else {
            side = was;
            set.refused[static_cast<std::size_t>(j)] = true;
        }
    }
    return false;
}

int rank_of(const SmallRows& W) {
    if (W.size() == 0) return 0;
    SmallRows unit = W;
    for (Eigen::Index j = 0; j < W.cols(); ++j) {
        const double length = W.col(j).norm();
        if (length > 0.0) unit.col(j) /= length;
    }
    Eigen::ColPivHouseholderQR<SmallRows> qr(unit.rows(), unit.cols());
    qr.setThreshold(1e-10);
    qr.compute(unit);
    return static_cast<int>(qr.rank());
}

void describe(const Scaled& s, const ActiveSet& set, BoundedSolution& out) {
    const SmallVector slope = s.A.transpose() * (s.A * set.z - s.b);
    const SmallVector moved = (set.z - slope).cwiseMax(s.lower).cwiseMin(s.upper);
    const double size = s.b.norm();
    out.kkt = largest(set.z - moved) / (size > 0.0 ? size : 1.0);
    double most = 1e-9 * size;
    for (Eigen::Index j = 0; j < set.z.size(); ++j) {
        if (set.side[static_cast<std::size_t>(j)] == BoundSide::free) continue;
        out.active |= 1U << j;
        if (std::abs(slope(j)) <= most) continue;
        most = std::abs(slope(j));
        out.limiting = static_cast<int>(j);
    }
}

bool finite(const BoundedProblem& p) {
    return p.W.allFinite() && p.d.allFinite() && p.rate.allFinite() && p.before.allFinite() &&
           std::isfinite(p.tikhonov) && !p.lower.hasNaN() && !p.upper.hasNaN();
}

}  // namespace

BoundedSolution solve_bounded(const BoundedProblem& p) noexcept {
    assert(p.d.size() == p.W.rows() && p.lower.size() == p.W.cols() && p.upper.size() == p.W.cols());
    assert(p.rate.size() == 0 || (p.rate.size() == p.W.cols() && p.before.size() == p.W.cols()));
    BoundedSolution out;
    out.x.setZero(p.W.cols());
    if (!finite(p)) return out;
    const SmallVector from = p.before.size() > 0 ? p.before : SmallVector(SmallVector::Zero(p.W.cols()));
    for (Eigen::Index j = 0; j < p.W.cols(); ++j) {
        out.x(j) = std::max(p.lower(j), std::min(p.upper(j), from(j)));
        if (p.lower(j) > p.upper(j) && out.infeasible < 0) out.infeasible = static_cast<int>(j);
    }
    out.residual = p.W * out.x + p.d;
    out.status = BoundedStatus::infeasible;
    if (out.infeasible >= 0) return out;

    const Scaled s = scaled_of(p);
    ActiveSet set = beginning(s, from.cwiseProduct(s.scale));
    out.status = run(s, set) ? BoundedStatus::solved : BoundedStatus::stopped;
    out.iterations = set.iterations;
    out.x = set.z.cwiseQuotient(s.scale).cwiseMax(p.lower).cwiseMin(p.upper);
    out.residual = p.W * out.x + p.d;
    out.rank = rank_of(p.W);
    describe(s, set, out);
    return out;
}

}  // namespace palpa::mechanics
