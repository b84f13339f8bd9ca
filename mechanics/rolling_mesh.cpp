#include "mechanics/rolling_mesh.h"

#include <algorithm>
#include <cmath>

namespace palpa::mechanics {
namespace {

// Appends the cells of a gap between two fine zones. They grow from `first` at the left end and `last` at the right end
// (0 for an end without a zone) up to `most`, and are scaled to fill the gap exactly.
void fill_gap(double low_m, double high_m, double first_m, double last_m, double growth, double most_m,
              std::vector<double>& out) {
    std::vector<double> left, right;
    double filled = 0.0;
    double a = first_m > 0.0 ? std::min(first_m * growth, most_m) : most_m;
    double b = last_m > 0.0 ? std::min(last_m * growth, most_m) : most_m;
    const double gap_m = high_m - low_m;
    while (filled < gap_m * (1.0 - 1e-9)) {
        const bool from_left = first_m > 0.0 && (last_m <= 0.0 || a <= b);
        double& h = from_left ? a : b;
        (from_left ? left : right).push_back(h);
        filled += h;
        h = std::min(h * growth, most_m);
    }
    const double scale = gap_m / filled;
    double at = low_m;
    for (const double h : left) out.push_back(at += h * scale);
    for (auto h = right.rbegin(); h != right.rend(); ++h) out.push_back(at += *h * scale);
    if (!left.empty() || !right.empty()) out.back() = high_m;
}

}  // namespace

Eigen::VectorXd zoned_coordinates_m(double length_m, std::vector<FineZone> zones, double growth, double most_m) {
    // the interval is cut at the ends of all zones; each piece takes the finest zone that covers it
    const double least_m = 1e-6 * length_m;
    std::vector<double> ends{0.0, length_m};
    for (const FineZone& zone : zones) {
        ends.push_back(std::clamp(zone.low_m, 0.0, length_m));
        ends.push_back(std::clamp(zone.high_m, 0.0, length_m));
    }
    std::sort(ends.begin(), ends.end());
    std::vector<FineZone> pieces;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        if (ends[i + 1] - ends[i] < least_m) continue;
        const double middle_m = 0.5 * (ends[i] + ends[i + 1]);
        double cell_m = 0.0;
        for (const FineZone& zone : zones) {
            if (middle_m < zone.low_m || middle_m > zone.high_m) continue;
            cell_m = cell_m > 0.0 ? std::min(cell_m, zone.cell_m) : zone.cell_m;
        }
        if (!pieces.empty() && pieces.back().cell_m == cell_m) {
            pieces.back().high_m = ends[i + 1];
        } else {
            pieces.push_back({pieces.empty() ? 0.0 : pieces.back().high_m, ends[i + 1], cell_m});
        }
    }
    std::vector<double> out{0.0};
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const FineZone& piece = pieces[i];
        if (piece.cell_m > 0.0) {
            const int n = std::max(1, static_cast<int>(std::ceil((piece.high_m - piece.low_m) / piece.cell_m - 1e-6)));
            for (int k = 1; k <= n; ++k) out.push_back(piece.low_m + (piece.high_m - piece.low_m) * k / n);
        } else {
            const double before_m = i > 0 ? pieces[i - 1].cell_m : 0.0;
            const double after_m = i + 1 < pieces.size() ? pieces[i + 1].cell_m : 0.0;
            fill_gap(piece.low_m, piece.high_m, before_m, after_m, growth, most_m, out);
        }
    }
    return Eigen::Map<const Eigen::VectorXd>(out.data(), static_cast<Eigen::Index>(out.size()));
}

Eigen::VectorXd outward_coordinates_m(double cell_m, int n, double growth, double length_m) {
    return zoned_coordinates_m(length_m, {{0.0, n * cell_m, cell_m}}, growth, length_m);
}

Eigen::VectorXd heights_from_depths(const Eigen::VectorXd& depth_m, double thickness_m) {
    Eigen::VectorXd z_m = (thickness_m - depth_m.array()).reverse();
    z_m(0) = 0.0;
    return z_m;
}

Problem block_problem(const Eigen::VectorXd& x_m, const Eigen::VectorXd& y_m, const Eigen::VectorXd& z_m,
                      const Material& tissue, std::span<const Inclusion> inclusions) {
    constexpr int kSamplesPerEdge = 5;
    Problem problem;
    problem.mesh = hex_box(x_m, y_m, z_m);
    problem.materials.assign(static_cast<std::size_t>(problem.mesh.cells.cols()), tissue);
    for (const Inclusion& inclusion : inclusions) {
        mix_in(sphere_share(problem.mesh, inclusion.sphere, kSamplesPerEdge), inclusion.material, Mixing::between,
               problem.materials);
    }
    std::vector<int> bottom(static_cast<std::size_t>(x_m.size() * y_m.size()));
    for (std::size_t i = 0; i < bottom.size(); ++i) bottom[i] = static_cast<int>(i);
    fix(bottom, "xyz", 0.0, problem.supports);
    return problem;
}

int surface_node(const Eigen::VectorXd& x_m, const Eigen::VectorXd& y_m, const Eigen::VectorXd& z_m, int i, int j) {
    return static_cast<int>(((z_m.size() - 1) * y_m.size() + j) * x_m.size() + i);
}

}  // namespace palpa::mechanics
