// Answers read from a table.

#include "tactile/table.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpa::tactile {
namespace {

// Cubic convolution with a = -1/2 between places 1 and 2 of four; beside the grid, a place is extrapolated by a parabola
// (Keys 1981), whose weights fall on the three next to it. `first` is the first of the four places that remain.
void convolve(double at, int count, int& first, double (&weight)[4]) {
    const int cell = std::clamp(static_cast<int>(std::floor(at)), 0, count - 2);
    const double t = at - cell;
    const double w[4] = {0.5 * t * (-1.0 + t * (2.0 - t)), 1.0 + t * t * (-2.5 + 1.5 * t),
                         0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0)};
    first = std::clamp(cell - 1, 0, count - 4);
    if (cell == 0) {
        weight[0] = w[1] + 3.0 * w[0];
        weight[1] = w[2] - 3.0 * w[0];
        weight[2] = w[3] + w[0];
        weight[3] = 0.0;
    } else if (cell == count - 2) {
        weight[0] = 0.0;
        weight[1] = w[0] + w[3];
        weight[2] = w[1] - 3.0 * w[3];
        weight[3] = w[2] + 3.0 * w[3];
    } else {
        std::copy(w, w + 4, weight);
    }
}

std::size_t entry(const Table& table, int force, int y, int x) {
    return (static_cast<std::size_t>(force) * static_cast<std::size_t>(table.count[1]) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(table.count[0]) +
           static_cast<std::size_t>(x);
}

double blend(const Table& table, const std::vector<float>& values, const TablePlace& at, int force) {
    double sum = 0.0;
    for (int b = 0; b < 4; ++b) {
        const float* row = values.data() + entry(table, force, at.first[1] + b, at.first[0]);
        double along_x = 0.0;
        for (int a = 0; a < 4; ++a) along_x += at.weight[0][a] * static_cast<double>(row[a]);
        sum += at.weight[1][b] * along_x;
    }
    return sum;
}

// Sets the forces' part for a force between those of `force - 1` (0 if there is none) and `force`.
void set_share(const Table& table, int force, double force_N, TablePlace& at) {
    const auto k = static_cast<std::size_t>(force);
    const double below_N = force > 0 ? table.force_N[k - 1] : 0.0;
    at.force = force;
    at.share[0] = (force_N - below_N) / (table.force_N[k] - below_N);
    at.share[1] = force > 0 ? 1.0 - at.share[0] : 0.0;
}

}  // namespace

bool find_place(const Table& table, const Eigen::Vector2d& place_m, TablePlace& at) {
    for (int axis = 0; axis < 2; ++axis) {
        const double place = (place_m(axis) - table.first_m[axis]) / table.spacing_m[axis];
        if (!(place >= 0.0) || !(place <= table.count[axis] - 1)) return false;
        convolve(place, table.count[axis], at.first[axis], at.weight[axis]);
    }
    return true;
}

double table_force_N(const Table& table, double depth_m, TablePlace& at) {
    // the first force whose depth is not less
    int low = 0;
    int high = static_cast<int>(table.force_N.size());
    double below_m = 0.0;  // depth at low - 1
    double above_m = 0.0;  // depth at high
    while (low < high) {
        const int middle = (low + high) / 2;
        const double middle_m = blend(table, table.depth_m, at, middle);
        if (middle_m >= depth_m) {
            high = middle;
            above_m = middle_m;
        } else {
            low = middle + 1;
            below_m = middle_m;
        }
    }
    const auto n = static_cast<int>(table.force_N.size());
    if (table.linear) {
        const double last_m = high < n ? above_m : below_m;
        const double force_N = last_m > 0.0 ? depth_m / last_m * table.force_N[0] : 0.0;
        set_share(table, 0, force_N, at);
        return force_N;
    }
    if (high == n) return std::numeric_limits<double>::quiet_NaN();
    const auto k = static_cast<std::size_t>(high);
    const double below_N = high > 0 ? table.force_N[k - 1] : 0.0;
    const double share = above_m > below_m ? std::clamp((depth_m - below_m) / (above_m - below_m), 0.0, 1.0) : 1.0;
    const double force_N = below_N + share * (table.force_N[k] - below_N);
    set_share(table, high, force_N, at);
    return force_N;
}

double table_depth_m(const Table& table, double force_N, TablePlace& at) {
    const auto above = std::lower_bound(table.force_N.begin(), table.force_N.end() - 1, force_N);
    const int force = table.linear ? 0 : static_cast<int>(above - table.force_N.begin());
    set_share(table, force, force_N, at);
    double depth_m = at.share[0] * blend(table, table.depth_m, at, force);
    if (at.share[1] != 0.0) depth_m += at.share[1] * blend(table, table.depth_m, at, force - 1);
    return depth_m;
}

double table_linearity(const Table& table, const TablePlace& at) {
    double ratio = at.share[0] * blend(table, table.linearity, at, at.force);
    if (at.share[1] != 0.0) ratio += at.share[1] * blend(table, table.linearity, at, at.force - 1);
    return std::max(0.0, ratio);
}

void table_shape_m(const Table& table, const TablePlace& at, Eigen::Ref<Eigen::VectorXd> out_m) {
    out_m.setZero();
    for (int which = 0; which < 2; ++which) {
        const double share = at.share[which];
        if (share == 0.0) continue;
        for (int b = 0; b < 4; ++b) {
            for (int a = 0; a < 4; ++a) {
                const std::size_t k = entry(table, at.force - which, at.first[1] + b, at.first[0] + a);
                const double weight = share * at.weight[1][b] * at.weight[0][a];
                const Eigen::Map<const Eigen::VectorXf> values(
                    table.value_m.data() + k * static_cast<std::size_t>(table.observed), table.observed);
                out_m += weight * values.cast<double>();
            }
        }
    }
}

}  // namespace palpa::tactile
