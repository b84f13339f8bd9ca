#include "stiffnessmaps/import/surface.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "files/input_error.h"
#include "files/text.h"
#include "stiffnessmaps/import/robust.h"

namespace palpa::stiffnessmaps {
namespace {

using Eigen::Index;

constexpr std::size_t kMostSamples = 100'000;  // enough for the fit
constexpr std::size_t kMostNodes = 4'000;

struct Corner {
    std::array<std::size_t, 4> node;
    std::array<double, 4> weight;
};

Corner corner_of(const Surface& surface, double x_m, double y_m) {
    const auto split = [](double place, std::size_t n, double& rest) {
        if (n < 2) {
            rest = 0.0;
            return std::size_t{0};
        }
        const double at = std::clamp(place, 0.0, static_cast<double>(n - 1));
        const auto i = std::min(static_cast<std::size_t>(at), n - 2);
        rest = at - static_cast<double>(i);
        return i;
    };
    double a = 0.0;
    double b = 0.0;
    const std::size_t i = split((x_m - surface.origin_m[0]) / surface.node_m, surface.n_x, a);
    const std::size_t j = split((y_m - surface.origin_m[1]) / surface.node_m, surface.n_y, b);
    const std::size_t right = surface.n_x > 1 ? 1 : 0;
    const std::size_t up = surface.n_y > 1 ? surface.n_x : 0;
    const std::size_t at = j * surface.n_x + i;
    return {{at, at + right, at + up, at + up + right}, {(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b}};
}

struct Fit {
    std::vector<double> height_m;
    std::vector<double> compliance_m;  // depth under the typical force
    double deviation_m = 0.0;
};

struct Chosen {
    std::vector<std::size_t> sample;
    std::vector<double> push;  // (F / typical)^m
    std::vector<double> n_z;
    std::vector<double> weight;
};

void add_smoothness(const Surface& surface, double weight_s, double weight_c,
                    std::vector<Eigen::Triplet<double>>& out) {
    const auto n = static_cast<Index>(surface.n_x * surface.n_y);
    const auto add = [&](Index first, Index second, Index third) {
        const std::array<Index, 3> node{first, second, third};
        const std::array<double, 3> d{1.0, -2.0, 1.0};
        for (std::size_t p = 0; p < 3; ++p) {
            for (std::size_t q = 0; q < 3; ++q) {
                out.emplace_back(node[p], node[q], weight_s * d[p] * d[q]);
                out.emplace_back(n + node[p], n + node[q], weight_c * d[p] * d[q]);
            }
        }
    };
    const auto n_x = static_cast<Index>(surface.n_x);
    for (Index i = 0; i < n; ++i) {
        const Index x = i % n_x;
        const Index y = i / n_x;
        if (x > 0 && x + 1 < n_x) add(i - 1, i, i + 1);
        if (y > 0 && y + 1 < static_cast<Index>(surface.n_y)) add(i - n_x, i, i + n_x);
        out.emplace_back(i, i, 1e-9 * weight_s);
        out.emplace_back(n + i, n + i, 1e-6 * weight_c);
    }
}

// Returns one weighted least-squares solution with the robust deviation of its residuals; empty if the matrix cannot be
// factored.
Fit solve(const Surface& surface, const SurfaceSamples& samples, const Chosen& chosen,
          std::vector<double>& residual_m) {
    const std::size_t n = surface.n_x * surface.n_y;
    const std::size_t n_m = chosen.sample.size();
    // sums for each square of four nodes, which then go into the matrix
    std::vector<std::array<double, 64>> blocks(n);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(static_cast<Index>(2 * n));
    std::vector<std::size_t> touched(n, 0);
    for (std::size_t m = 0; m < n_m; ++m) {
        const std::size_t s = chosen.sample[m];
        const Corner corner = corner_of(surface, samples.x_m[s], samples.y_m[s]);
        std::array<double, 8> row;
        for (std::size_t c = 0; c < 4; ++c) {
            row[c] = corner.weight[c] * chosen.n_z[m];
            row[4 + c] = -corner.weight[c] * chosen.push[m];
        }
        const double value = chosen.n_z[m] * samples.z_m[s];
        std::array<double, 64>& block = blocks[corner.node[0]];
        if (touched[corner.node[0]]++ == 0) block.fill(0.0);
        for (std::size_t p = 0; p < 8; ++p) {
            const double wp = chosen.weight[m] * row[p];
            for (std::size_t q = 0; q < 8; ++q) block[8 * p + q] += wp * row[q];
            right(static_cast<Index>((p < 4 ? 0 : n) + corner.node[p % 4])) += wp * value;
        }
    }
    std::vector<Eigen::Triplet<double>> entries;
    const std::size_t right_of = surface.n_x > 1 ? 1 : 0;
    const std::size_t above = surface.n_y > 1 ? surface.n_x : 0;
    for (std::size_t i = 0; i < n; ++i) {
        if (touched[i] == 0) continue;
        const std::array<std::size_t, 4> node{i, i + right_of, i + above, i + above + right_of};
        for (std::size_t p = 0; p < 8; ++p) {
            for (std::size_t q = 0; q < 8; ++q) {
                entries.emplace_back(static_cast<Index>((p < 4 ? 0 : n) + node[p % 4]),
                                     static_cast<Index>((q < 4 ? 0 : n) + node[q % 4]), blocks[i][8 * p + q]);
            }
        }
    }
    const double per_node = static_cast<double>(n_m) / static_cast<double>(n);
    // weights of the smoothness, as shares of the samples per node; found on two recordings and a raster over a lump
    // with a known answer, 2026-11: the residual changes by a tenth from 0.3 to 0.01, and a compliance held stiffer
    // than the surface bends the surface instead
    constexpr double kSurface = 0.1;
    constexpr double kCompliance = 0.03;
    add_smoothness(surface, kSurface * per_node, kCompliance * per_node, entries);
    Eigen::SparseMatrix<double> A(static_cast<Index>(2 * n), static_cast<Index>(2 * n));
    A.setFromTriplets(entries.begin(), entries.end());
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(A);
    Fit fit;
    if (solver.info() != Eigen::Success) return fit;
    const Eigen::VectorXd x = solver.solve(right);
    fit.height_m.assign(x.data(), x.data() + n);
    fit.compliance_m.assign(x.data() + n, x.data() + 2 * n);
    residual_m.resize(n_m);
    for (std::size_t m = 0; m < n_m; ++m) {
        const std::size_t s = chosen.sample[m];
        const Corner corner = corner_of(surface, samples.x_m[s], samples.y_m[s]);
        double height = 0.0;
        double compliance = 0.0;
        for (std::size_t c = 0; c < 4; ++c) {
            height += corner.weight[c] * fit.height_m[corner.node[c]];
            compliance += corner.weight[c] * fit.compliance_m[corner.node[c]];
        }
        residual_m[m] = chosen.n_z[m] * (height - samples.z_m[s]) - chosen.push[m] * compliance;
    }
    fit.deviation_m = robust_deviation(residual_m);
    return fit;
}

// Returns the interquartile range of the push over its median in each square, and of these the median.
double force_variety(const Surface& surface, const SurfaceSamples& samples, const Chosen& chosen) {
    std::vector<std::vector<double>> pushes(surface.n_x * surface.n_y);
    for (std::size_t m = 0; m < chosen.sample.size(); ++m) {
        const std::size_t s = chosen.sample[m];
        pushes[corner_of(surface, samples.x_m[s], samples.y_m[s]).node[0]].push_back(chosen.push[m]);
    }
    std::vector<double> variety;
    for (auto& p : pushes) {
        if (p.size() < 4) continue;
        const double low = quantile(p, 0.25);
        const double high = quantile(p, 0.75);
        const double middle = quantile(p, 0.5);
        if (middle > 0.0) variety.push_back((high - low) / middle);
    }
    return median(std::move(variety));
}

void take_normals(const Surface& surface, const SurfaceSamples& samples, double exponent, double typical_N,
                  Chosen& chosen) {
    for (std::size_t m = 0; m < chosen.sample.size(); ++m) {
        const std::size_t s = chosen.sample[m];
        const SurfacePoint p = surface_at(surface, samples.x_m[s], samples.y_m[s]);
        double force_N = 0.0;
        for (std::size_t a = 0; a < 3; ++a) force_N += p.normal[a] * static_cast<double>(samples.force_N[a][s]);
        chosen.n_z[m] = p.normal[2];
        chosen.push[m] = std::pow(std::max(force_N, 0.0) / typical_N, exponent);
    }
}

// Robust least squares, repeated with the normals of the last solution.
Fit fit_robustly(Surface surface, const SurfaceSamples& samples, Chosen chosen, double exponent, double typical_N) {
    Fit fit;
    std::vector<double> residual_m;
    constexpr int kRounds = 5;
    constexpr double kHuber = 2.0;  // deviations
    for (int round = 0; round < kRounds; ++round) {
        take_normals(surface, samples, exponent, typical_N, chosen);
        fit = solve(surface, samples, chosen, residual_m);
        if (fit.height_m.empty()) return fit;
        for (std::size_t m = 0; m < residual_m.size(); ++m) {
            const double off = std::abs(residual_m[m]) / std::max(kHuber * fit.deviation_m, 1e-9);
            chosen.weight[m] = off > 1.0 ? 1.0 / off : 1.0;
        }
        surface.height_m = fit.height_m;
    }
    return fit;
}

// 1 or 2/3, unless another exponent leaves clearly less: noisy recordings hardly tell one from the next. Where they do, the
// height of the surface would take up the difference, 0.25 mm at 1/1.3 under forces up to 1.3 N.
Fit fit_best_exponent(const Surface& surface, const SurfaceSamples& samples, const Chosen& chosen, double typical_N,
                      double& exponent) {
    const auto fit = [&](double m) { return fit_robustly(surface, samples, chosen, m, typical_N); };
    const auto deviation = [](const Fit& one) {
        return one.height_m.empty() ? std::numeric_limits<double>::infinity() : one.deviation_m;
    };
    constexpr std::array kExponents{1.0, 0.9, 0.8, 0.7, 0.6, 0.5};
    std::array<Fit, kExponents.size()> fits;
    std::size_t best = 0;
    for (std::size_t i = 0; i < fits.size(); ++i) {
        fits[i] = fit(kExponents[i]);
        if (deviation(fits[i]) < deviation(fits[best])) best = i;
    }
    double other_m = kExponents[best];
    if (best > 0 && best + 1 < fits.size()) {  // refined by a parabola
        const double low = deviation(fits[best - 1]), middle = deviation(fits[best]), high = deviation(fits[best + 1]);
        const double bend = low - 2.0 * middle + high;
        if (std::isfinite(bend) && bend > 0.0) other_m -= 0.05 * (low - high) / bend;
    }
    Fit other = fit(other_m), hertz = fit(2.0 / 3.0);
    Fit& usual = deviation(hertz) < deviation(fits[0]) ? hertz : fits[0];
    constexpr double kClearly = 0.96;
    const bool clearly = deviation(other) < kClearly * deviation(usual);
    exponent = clearly ? other_m : &usual == &hertz ? 2.0 / 3.0 : 1.0;
    return clearly ? std::move(other) : std::move(usual);
}

// Two heights of the tool fit any power of the force: then noise would choose the surface.
void check_heights(const std::string& file, const SurfaceSamples& samples, const Chosen& chosen) {
    constexpr double kTight = 0.1;  // of the range
    std::vector<double> z_m;
    for (const std::size_t s : chosen.sample) z_m.push_back(samples.z_m[s]);
    const auto [low, high] = std::minmax_element(z_m.begin(), z_m.end());
    const double low_m = *low, high_m = *high, tight_m = kTight * (high_m - low_m);
    const auto at_an_end = [&](double z) { return z - low_m <= tight_m || high_m - z <= tight_m; };
    if (!std::all_of(z_m.begin(), z_m.end(), at_an_end)) return;
    throw files::bad_input(
        file, "", "a tool that presses at one or two heights, which fit any power of the force",
        "three depths or more, to tell the surface; or its height by --surface-z-mm; or the depth of "
        "each file by --at-depth-mm");
}

void measure_tilt(Surface& surface) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < surface.height_m.size(); ++i) {
        const Eigen::Vector3d row(1.0, surface.node_m * static_cast<double>(i % surface.n_x),
                                  surface.node_m * static_cast<double>(i / surface.n_x));
        A += row * row.transpose();
        b += row * surface.height_m[i];
    }
    A.diagonal().tail<2>().array() += 1e-12;
    const Eigen::Vector3d plane = A.ldlt().solve(b);
    surface.tilt_deg = std::atan(std::hypot(plane[1], plane[2])) * 180.0 / std::numbers::pi;
}

}  // namespace

SurfacePoint surface_at(const Surface& surface, double x_m, double y_m) {
    SurfacePoint out;
    if (surface.height_m.empty()) return out;
    const Corner c = corner_of(surface, x_m, y_m);
    const auto& s = surface.height_m;
    for (std::size_t k = 0; k < 4; ++k) out.height_m += c.weight[k] * s[c.node[k]];
    const double b = c.weight[2] + c.weight[3];
    const double a = c.weight[1] + c.weight[3];
    const double along_x =
        ((1 - b) * (s[c.node[1]] - s[c.node[0]]) + b * (s[c.node[3]] - s[c.node[2]])) / surface.node_m;
    const double along_y =
        ((1 - a) * (s[c.node[2]] - s[c.node[0]]) + a * (s[c.node[3]] - s[c.node[1]])) / surface.node_m;
    const double length = std::sqrt(1.0 + along_x * along_x + along_y * along_y);
    out.normal[0] = -along_x / length;
    out.normal[1] = -along_y / length;
    out.normal[2] = 1.0 / length;
    return out;
}

Indentation indentation_of(const Surface& surface, const SurfaceSamples& samples, std::size_t i) {
    const SurfacePoint p = surface_at(surface, samples.x_m[i], samples.y_m[i]);
    Indentation out;
    out.depth_m = p.normal[2] * (p.height_m - samples.z_m[i]);
    for (std::size_t a = 0; a < 3; ++a) out.force_N += p.normal[a] * static_cast<double>(samples.force_N[a][i]);
    return out;
}

Surface fit_surface(const SurfaceSamples& samples, double node_m, const std::string& file) {
    Surface surface;
    const auto [x_low, x_high] = std::minmax_element(samples.x_m.begin(), samples.x_m.end());
    const auto [y_low, y_high] = std::minmax_element(samples.y_m.begin(), samples.y_m.end());
    surface.origin_m[0] = *x_low;
    surface.origin_m[1] = *y_low;
    const double area = (*x_high - *x_low + node_m) * (*y_high - *y_low + node_m);
    const double most_nodes =
        std::min(static_cast<double>(kMostNodes), 1.0 + static_cast<double>(samples.size()) / 8.0);
    surface.node_m = std::max(node_m, std::sqrt(area / most_nodes));
    surface.n_x = 1 + static_cast<std::size_t>(std::ceil((*x_high - *x_low) / surface.node_m));
    surface.n_y = 1 + static_cast<std::size_t>(std::ceil((*y_high - *y_low) / surface.node_m));

    std::vector<double> forces_N;
    const std::size_t step = 1 + samples.size() / kMostSamples;
    for (std::size_t s = 0; s < samples.size(); s += step)
        forces_N.push_back(static_cast<double>(samples.force_N[2][s]));
    const double great_N = quantile(forces_N, 0.95);
    constexpr double kTouching = 0.02;  // share of a great force below which there is no contact
    Chosen chosen;
    for (std::size_t s = 0; s < samples.size(); s += step) {
        if (static_cast<double>(samples.force_N[2][s]) > kTouching * great_N) chosen.sample.push_back(s);
    }
    if (!(great_N > 0.0) || chosen.sample.size() < 16) {
        throw files::bad_input(
            file, "", "a 95th percentile of the force along z of " + files::short_number(great_N) + " N",
            "a tool that presses, with a positive force along z (the other sign: with --negate-force, or without)");
    }
    chosen.push.resize(chosen.sample.size());
    chosen.n_z.resize(chosen.sample.size());
    chosen.weight.assign(chosen.sample.size(), 1.0);

    take_normals(surface, samples, 1.0, great_N, chosen);
    constexpr double kLeastVariety = 0.2;
    if (const double variety = force_variety(surface, samples, chosen); variety < kLeastVariety) {
        throw files::bad_input(
            file, "",
            "a force that hardly changes from pass to pass (by " + files::short_number(100.0 * variety) + " %)",
            "forces from light to strong, to tell the surface; or its height by --surface-z-mm; or the depth "
            "of "
            "each file by --at-depth-mm");
    }
    check_heights(file, samples, chosen);
    Fit best = fit_best_exponent(surface, samples, chosen, great_N, surface.exponent);
    if (best.height_m.empty())
        throw files::bad_input(file, "", "no surface through the samples", "places that extend along x and y");
    surface.height_m = std::move(best.height_m);
    surface.deviation_m = best.deviation_m;
    measure_tilt(surface);
    return surface;
}

}  // namespace palpa::stiffnessmaps
