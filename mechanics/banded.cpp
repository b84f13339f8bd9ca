#include "mechanics/banded.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <numeric>

#include "mechanics/blas_memory.h"
#include "mechanics/error.h"
#include "mechanics/index.h"

namespace palpa::mechanics {
namespace {

// For each equation all others that it is coupled with: near[start[i]] to near[start[i + 1] - 1].
struct Coupling {
    std::vector<int> start;
    std::vector<int> near;
    int degree(int i) const { return start[at(i) + 1] - start[at(i)]; }
};

Coupling coupling_of(const LowerMatrix& A) {
    const auto n = static_cast<std::size_t>(A.cols());
    Coupling out;
    out.start.assign(n + 1, 0);
    const auto each_pair = [&](auto&& take) {
        for (int j = 0; j < static_cast<int>(n); ++j) {
            for (LowerMatrix::InnerIterator it(A, j); it; ++it) {
                if (it.row() != j) take(static_cast<int>(it.row()), j);
            }
        }
    };
    each_pair([&](int i, int j) { ++out.start[at(i) + 1], ++out.start[at(j) + 1]; });
    std::partial_sum(out.start.begin(), out.start.end(), out.start.begin());
    out.near.resize(static_cast<std::size_t>(out.start.back()));
    std::vector<int> fill(out.start.begin(), out.start.end() - 1);
    each_pair([&](int i, int j) {
        out.near[at(fill[at(i)]++)] = j;
        out.near[at(fill[at(j)]++)] = i;
    });
    return out;
}

// Appends the equations that are reached from `first`, in Cuthill and McKee's order: level by level, those of few
// couplings first. `last` receives the last level. Returns how many levels there are.
int append_levels(const Coupling& graph, const std::vector<int>& first, std::vector<int>& order,
                  std::vector<bool>& seen, std::vector<int>& last) {
    std::size_t head = order.size();
    std::size_t level = head;
    order.insert(order.end(), first.begin(), first.end());
    for (const int i : first) seen[at(i)] = true;
    std::size_t level_end = order.size();
    int levels = 1;
    for (; head < order.size(); ++head) {
        if (head == level_end) {
            level = head;
            level_end = order.size();
            ++levels;
        }
        const auto begin = static_cast<std::ptrdiff_t>(order.size());
        const int i = order[head];
        for (int k = graph.start[at(i)]; k < graph.start[at(i) + 1]; ++k) {
            const int j = graph.near[at(k)];
            if (seen[at(j)]) continue;
            seen[at(j)] = true;
            order.push_back(j);
        }
        std::sort(order.begin() + begin, order.end(), [&](int p, int q) {
            return graph.degree(p) != graph.degree(q) ? graph.degree(p) < graph.degree(q) : p < q;
        });
    }
    last.assign(order.begin() + static_cast<std::ptrdiff_t>(level), order.end());
    return levels;
}

// Appends one connected part of the graph, from an end of it.
void append_part(const Coupling& graph, int any, std::vector<int>& order, std::vector<bool>& seen) {
    const std::size_t begin = order.size();
    const auto forget = [&] {
        for (std::size_t k = begin; k < order.size(); ++k) seen[at(order[k])] = false;
        order.resize(begin);
    };
    std::vector<int> last;
    int levels = 0;
    for (int start = any;;) {
        const int now = append_levels(graph, {start}, order, seen, last);
        forget();
        if (now <= levels) break;
        levels = now;
        start = *std::min_element(last.begin(), last.end(),
                                  [&](int p, int q) { return graph.degree(p) < graph.degree(q); });
    }
    const std::vector<int> end = last;
    append_levels(graph, end, order, seen, last);
}

int band_of(const LowerMatrix& A, const std::vector<int>& position) {
    int band = 0;
    for (int j = 0; j < static_cast<int>(A.cols()); ++j) {
        for (LowerMatrix::InnerIterator it(A, j); it; ++it)
            band = std::max(band, std::abs(position[at(static_cast<int>(it.row()))] - position[at(j)]));
    }
    return band;
}

}  // namespace

BandOrder band_order(const LowerMatrix& A) {
    const auto n = static_cast<std::size_t>(A.cols());
    const Coupling graph = coupling_of(A);
    std::vector<int> order;
    std::vector<bool> seen(n, false);
    for (int i = 0; i < static_cast<int>(n); ++i) {
        if (!seen[at(i)]) append_part(graph, i, order, seen);
    }
    BandOrder as_given{std::vector<int>(n), 0};
    std::iota(as_given.position.begin(), as_given.position.end(), 0);
    as_given.band = band_of(A, as_given.position);
    BandOrder out{std::vector<int>(n), 0};
    for (std::size_t k = 0; k < n; ++k) out.position[at(order[k])] = static_cast<int>(n - 1 - k);
    out.band = band_of(A, out.position);
    return out.band < as_given.band ? out : as_given;
}

void analyse(const LowerMatrix& A, BandedFactor& factor) {
    require_blas_memory();
    if (!banded_built_in()) throw SolverError("banded solver asked for, but this build has none; use eigen", 0);
    factor.order = band_order(A);
    const int rows = factor.order.band + 1;
    if (static_cast<double>(rows) * static_cast<double>(A.cols()) > 2e9)
        throw OutOfMemory("banded solver: the band is too wide; use mumps or eigen", 0);
    factor.matrix = band_matrix(A.cols(), factor.order.band);
    factor.permuted.resize(A.rows(), 1);
    factor.place.clear();
    for (int j = 0; j < static_cast<int>(A.cols()); ++j) {
        for (LowerMatrix::InnerIterator it(A, j); it; ++it) {
            const int a = factor.order.position[at(static_cast<int>(it.row()))];
            const int b = factor.order.position[at(j)];
            factor.place.push_back(std::min(a, b) * rows + std::abs(a - b));
        }
    }
    factor.factored = false;
}

#ifdef PALPA_HAS_MUMPS
bool banded_built_in() { return true; }
#else
bool banded_built_in() { return false; }
#endif

int try_factor(const LowerMatrix& A, BandedFactor& factor) {
    assert(static_cast<std::size_t>(A.nonZeros()) == factor.place.size());
    double* values = factor.matrix.values.data();
    factor.matrix.values.setZero();
    for (std::size_t k = 0; k < factor.place.size(); ++k) values[factor.place[k]] = A.valuePtr()[k];
    const int info = factor_in_place(factor.matrix);
    factor.factored = info == 0;
    return info;
}

void solve_in_place(const BandedFactor& factor, Eigen::Ref<Eigen::MatrixXd> block) {
    assert(factor.factored);
    const Eigen::Index n = factor.matrix.size();
    const Eigen::Index columns = block.cols();
    if (factor.permuted.cols() < columns) factor.permuted.resize(n, columns);
    for (Eigen::Index k = 0; k < columns; ++k) {
        for (Eigen::Index i = 0; i < n; ++i) factor.permuted(factor.order.position[at(i)], k) = block(i, k);
    }
    solve_in_place(factor.matrix, factor.permuted.leftCols(columns));
    for (Eigen::Index k = 0; k < columns; ++k) {
        for (Eigen::Index i = 0; i < n; ++i) block(i, k) = factor.permuted(factor.order.position[at(i)], k);
    }
}

}  // namespace palpa::mechanics
