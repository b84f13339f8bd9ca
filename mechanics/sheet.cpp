#include "mechanics/sheet.h"

#include <algorithm>
#include <cmath>
#include <math.h>  // j0: POSIX; std::cyl_bessel_j is missing from libc++
#include <numbers>
#include <vector>

namespace palpa::mechanics {
namespace {

using Eigen::Index;

constexpr double kReach = 6.0;   // of the kernel, in thicknesses
constexpr double kStep = 0.02;   // of its table, in thicknesses
constexpr double kSixths = 6.0;  // lattice points per thickness or pitch

// h^2 g(r) at r = s h, s = 0, kStep, ... kReach.
std::vector<double> kernel_table(Sheet sheet) {
    std::vector<double> out;
    for (double s = 0.0; s <= kReach + 1.5 * kStep; s += kStep) {
        if (sheet == Sheet::backed) {
            out.push_back(1.5 / std::numbers::pi * std::pow(1.0 + s * s, -2.5));
            continue;
        }
        constexpr int kPanels = 2000;
        constexpr double kWidth = 40.0 / kPanels;
        double sum = 0.0;
        for (int k = 1; k <= kPanels; ++k) {
            const double x = k * kWidth;
            const double weight = k == kPanels ? 1.0 : (k % 2 == 1 ? 4.0 : 2.0);
            sum += weight * sheet_transfer(sheet, x) * ::j0(x * s) * x;
        }
        out.push_back(sum * kWidth / 3.0 / (2.0 * std::numbers::pi));
    }
    return out;
}

// Where a coordinate stands among the pins of a row: between pin `first` and the next, `share` of the way.
struct Between {
    int first = 0;
    double share = 0.0;
};
Between between_pins(double at_m, int pins, double pitch_m) {
    if (pins == 1) return {};
    const double place = std::clamp(at_m / pitch_m + 0.5 * (pins - 1), 0.0, static_cast<double>(pins - 1));
    const int first = std::min(static_cast<int>(place), pins - 2);
    return {first, place - first};
}

// Adds a weight at a place of the underside to the pins around it.
template <class Row>
void spread(const PinGrid& grid, double x_m, double y_m, double weight, Row&& row) {
    const Between x = between_pins(x_m, grid.columns, grid.pitch_m);
    const Between y = between_pins(y_m, grid.rows, grid.pitch_m);
    const auto add = [&](int i, int j, double part) {
        if (part != 0.0) row(i * grid.columns + j) += weight * part;
    };
    add(y.first, x.first, (1.0 - y.share) * (1.0 - x.share));
    add(y.first, x.first + 1, (1.0 - y.share) * x.share);
    add(y.first + 1, x.first, y.share * (1.0 - x.share));
    add(y.first + 1, x.first + 1, y.share * x.share);
}

}  // namespace

double sheet_transfer(Sheet sheet, double x) {
    if (sheet == Sheet::off) return 1.0;
    if (sheet == Sheet::backed) return (1.0 + x) * std::exp(-x);
    const double e = std::exp(-x);  // numerator and denominator scaled so that nothing overflows
    const double cosh_e = 0.5 * (1.0 + e * e);
    const double sinh_e = 0.5 * (1.0 - e * e);
    return (cosh_e + x * sinh_e) * e / (cosh_e * cosh_e + x * x * e * e);
}

Eigen::MatrixXd sheet_forward(const PinGrid& grid, Sheet sheet, double thickness_m, const Eigen::Matrix2Xd& sample_m) {
    const std::vector<double> kernel = kernel_table(sheet);
    const double cell_m = std::min(thickness_m, grid.pitch_m) / kSixths;
    const int reach = static_cast<int>(std::ceil(kReach * thickness_m / cell_m));
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(sample_m.cols(), pin_count(grid));
    for (int b = -reach; b <= reach; ++b) {
        for (int a = -reach; a <= reach; ++a) {
            const double s = std::hypot(a * cell_m, b * cell_m) / thickness_m;
            if (s > kReach) continue;
            const auto k = static_cast<std::size_t>(s / kStep);
            const double share = s / kStep - static_cast<double>(k);
            const double weight = (1.0 - share) * kernel[k] + share * kernel[k + 1];
            for (Index n = 0; n < sample_m.cols(); ++n)
                spread(grid, sample_m(0, n) + a * cell_m, sample_m(1, n) + b * cell_m, weight, out.row(n));
        }
    }
    for (Index n = 0; n < out.rows(); ++n) out.row(n) /= out.row(n).sum();
    return out;
}

}  // namespace palpa::mechanics
