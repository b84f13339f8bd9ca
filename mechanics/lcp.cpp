#include "mechanics/lcp.h"

#include <cmath>

#include "mechanics/index.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;

// Cholesky of A on the set, into the lower triangle of work.factor. False if a pivot is not positive.
bool factor_set(const Eigen::Ref<const Eigen::MatrixXd>& A, LcpWork& work) {
    const auto n = static_cast<Index>(work.set.size());
    for (Index j = 0; j < n; ++j) {
        for (Index i = j; i < n; ++i) {
            double sum = A(work.set[at(i)], work.set[at(j)]);
            for (Index k = 0; k < j; ++k) sum -= work.factor(i, k) * work.factor(j, k);
            if (i == j) {
                if (!(sum > 0.0)) return false;
                work.factor(j, j) = std::sqrt(sum);
            } else {
                work.factor(i, j) = sum / work.factor(j, j);
            }
        }
    }
    return true;
}

void take_set(LcpWork& work) {
    work.set.clear();
    for (std::size_t i = 0; i < work.positive.size(); ++i) {
        if (work.positive[i]) work.set.push_back(static_cast<int>(i));
    }
}

// p on the set and w beside it; returns how many of either are negative, and the last of them.
int infeasible(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::VectorXd>& b, LcpWork& work,
               Eigen::Ref<Eigen::VectorXd> p, int& last) {
    work.solution = -b;
    solve_on_set(work, work.solution, p);
    work.w = b;
    for (const int j : work.set) work.w += p(j) * A.col(j);
    const double tolerance = 1e-14 * (b.cwiseAbs().maxCoeff() + 1e-300);
    int count = 0;
    for (Index i = 0; i < b.size(); ++i) {
        const bool bad = work.positive[at(i)] ? p(i) < 0.0 : work.w(i) < -tolerance;
        if (!bad) continue;
        ++count;
        last = static_cast<int>(i);
    }
    return count;
}

void exchange(const Eigen::Ref<const Eigen::VectorXd>& b, const Eigen::Ref<Eigen::VectorXd>& p, LcpWork& work) {
    const double tolerance = 1e-14 * (b.cwiseAbs().maxCoeff() + 1e-300);
    for (Index i = 0; i < b.size(); ++i) {
        char& positive = work.positive[at(i)];
        if (positive ? p(i) < 0.0 : work.w(i) < -tolerance) positive = positive ? 0 : 1;
    }
}

}  // namespace

LcpWork make_lcp_work(int n) {
    LcpWork work;
    work.positive.assign(at(n), 0);
    work.set.reserve(at(n));
    work.factor.setZero(n, n);
    work.solution.setZero(n);
    work.w.setZero(n);
    return work;
}

void solve_on_set(const LcpWork& work, const Eigen::Ref<const Eigen::VectorXd>& r,
                  Eigen::Ref<Eigen::VectorXd> x) noexcept {
    const auto n = static_cast<Index>(work.set.size());
    for (Index i = 0; i < x.size(); ++i) {
        if (!work.positive[at(i)]) x(i) = 0.0;
    }
    for (Index i = 0; i < n; ++i) {
        double sum = r(work.set[at(i)]);
        for (Index k = 0; k < i; ++k) sum -= work.factor(i, k) * x(work.set[at(k)]);
        x(work.set[at(i)]) = sum / work.factor(i, i);
    }
    for (Index i = n; i-- > 0;) {
        double sum = x(work.set[at(i)]);
        for (Index k = i + 1; k < n; ++k) sum -= work.factor(k, i) * x(work.set[at(k)]);
        x(work.set[at(i)]) = sum / work.factor(i, i);
    }
}

LcpStatus solve_lcp(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::VectorXd>& b,
                    LcpWork& work, Eigen::Ref<Eigen::VectorXd> p) noexcept {
    constexpr int kPatience = 5;  // exchanges of whole blocks that do not lower the count, as in the source
    const int n = static_cast<int>(b.size());
    if (!b.allFinite() || !A.allFinite()) return LcpStatus::not_settled;
    int fewest = n + 1;
    int patience = kPatience;
    for (int round = 0; round < 50 + 20 * n; ++round) {
        take_set(work);
        if (!factor_set(A, work)) break;
        int last = -1;
        const int count = infeasible(A, b, work, p, last);
        if (count == 0) return p.allFinite() ? LcpStatus::solved : LcpStatus::not_settled;
        if (count < fewest) {
            fewest = count;
            patience = kPatience;
        } else {
            --patience;
        }
        if (patience > 0)
            exchange(b, p, work);
        else
            work.positive[at(last)] = work.positive[at(last)] ? 0 : 1;
    }
    work.positive.assign(at(n), 0);
    return LcpStatus::not_settled;
}

}  // namespace palpa::mechanics
