#include "stiffnessmaps/import/detect_ground.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "files/quantile.h"
#include "stiffnessmaps/stiffness.h"

namespace palpa::stiffnessmaps {

double part_of(std::vector<double>& values, double share) {
    return files::reordered_quantile(values, share, files::QuantileType::lower);
}

TwoSidedSpread two_sided_spread(std::vector<double> values) {
    const double middle = part_of(values, 0.5);
    return {(middle - part_of(values, 0.25)) / kOfNormal, (part_of(values, 0.75) - middle) / kOfNormal};
}

std::vector<double> values_in(const cv::Mat1d& values, const cv::Mat1b& mask) {
    std::vector<double> out;
    for (int j = 0; j < values.rows; ++j) {
        for (int i = 0; i < values.cols; ++i) {
            if (mask(j, i) != 0) out.push_back(values(j, i));
        }
    }
    return out;
}

cv::Mat1b both(const cv::Mat1b& a, const cv::Mat1b& b) {
    cv::Mat1b out;
    cv::bitwise_and(a, b, out);
    return out;
}

cv::Mat1b without(const cv::Mat1b& mask, const cv::Mat1b& left_out) {
    cv::Mat1b out = mask.clone();
    out.setTo(0, left_out);
    return out;
}

namespace {

// Gaussian smoothing, normalised over the measured cells. Sigmas in cells.
cv::Mat1d smoothed(const cv::Mat1d& values, const cv::Mat1b& there, double sigma_x, double sigma_y) {
    cv::Mat1d weight(values.size(), 0.0);
    weight.setTo(1.0, there);
    cv::Mat1d sum = values.clone();
    sum.setTo(0.0, there == 0);
    if (sigma_x > 0.0 && sigma_y > 0.0) {
        cv::GaussianBlur(sum, sum, cv::Size(), sigma_x, sigma_y, cv::BORDER_CONSTANT);
        cv::GaussianBlur(weight, weight, cv::Size(), sigma_x, sigma_y, cv::BORDER_CONSTANT);
    }
    for (int j = 0; j < values.rows; ++j) {
        for (int i = 0; i < values.cols; ++i) sum(j, i) = there(j, i) != 0 ? sum(j, i) / weight(j, i) : 0.0;
    }
    return sum;
}

// Fits z = a + b u + c v to the measured cells by iteratively reweighted least squares, with Tukey's biweight at 4.685
// spreads (95 % efficient for normal noise). u and v run from about -1 to 1 over the grid.
cv::Mat1d robust_plane(const StiffnessGrid& grid) {
    const auto u_of = [&](int i) { return (2.0 * i - (grid.n_x - 1)) / std::max(1, grid.n_x); };
    const auto v_of = [&](int j) { return (2.0 * j - (grid.n_y - 1)) / std::max(1, grid.n_y); };
    Eigen::Vector3d plane(files::upper_median(values_in(grid.stiffness, without(grid.there, grid.known))), 0.0, 0.0);
    for (int round = 0; round < 20; ++round) {
        std::vector<double> off;
        for (int j = 0; j < grid.n_y; ++j) {
            for (int i = 0; i < grid.n_x; ++i) {
                if (grid.there(j, i) != 0 && grid.known(j, i) == 0)
                    off.push_back(std::abs(grid.stiffness(j, i) - plane.dot(Eigen::Vector3d(1.0, u_of(i), v_of(j)))));
            }
        }
        const double reach = 4.685 * files::upper_median(off) / kOfNormal;
        if (!(reach > 0.0)) break;
        Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
        Eigen::Vector3d right = Eigen::Vector3d::Zero();
        for (int j = 0; j < grid.n_y; ++j) {
            for (int i = 0; i < grid.n_x; ++i) {
                if (grid.there(j, i) == 0 || grid.known(j, i) != 0) continue;
                const Eigen::Vector3d p(1.0, u_of(i), v_of(j));
                const double e = (grid.stiffness(j, i) - plane.dot(p)) / reach;
                if (std::abs(e) >= 1.0) continue;
                const double w = (1.0 - e * e) * (1.0 - e * e);
                normal += w * p * p.transpose();
                right += w * grid.stiffness(j, i) * p;
            }
        }
        // the solution of least norm, so that a single row of cells has a plane too
        plane = normal.completeOrthogonalDecomposition().solve(right);
    }
    cv::Mat1d out(grid.n_y, grid.n_x);
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) out(j, i) = plane.dot(Eigen::Vector3d(1.0, u_of(i), v_of(j)));
    }
    return out;
}

// Returns the median of the plain cells within a disc around each cell. Fine grids are sampled in strides, so that the
// disc is at most some 40 samples wide.
cv::Mat1d window_median(const cv::Mat1d& values, const StiffnessGrid& grid, double radius_m) {
    const auto reach = [&](double pitch_m, int n) {
        return static_cast<int>(std::min(radius_m / pitch_m, static_cast<double>(n)));
    };
    const int reach_x = reach(grid.dx_m, grid.n_x);
    const int reach_y = reach(grid.dy_m, grid.n_y);
    const int stride_x = std::max(1, reach_x / 20);
    const int stride_y = std::max(1, reach_y / 20);
    cv::Mat1d out(grid.n_y, grid.n_x, 0.0);
    std::vector<double> window;
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) {
            if (grid.there(j, i) == 0) continue;
            window.clear();
            for (int b = j - reach_y / stride_y * stride_y; b <= j + reach_y; b += stride_y) {
                for (int a = i - reach_x / stride_x * stride_x; a <= i + reach_x; a += stride_x) {
                    if (b < 0 || b >= grid.n_y || a < 0 || a >= grid.n_x || grid.plain(b, a) == 0) continue;
                    if (std::hypot((a - i) * grid.dx_m, (b - j) * grid.dy_m) <= radius_m)
                        window.push_back(values(b, a));
                }
            }
            out(j, i) = window.empty() ? values(j, i) : part_of(window, 0.5);
        }
    }
    return out;
}

}  // namespace

StiffnessGrid make_grid(const Map& map, const std::vector<double>& raw_N_per_m, const DetectOptions& options) {
    StiffnessGrid grid;
    grid.n_x = static_cast<int>(map.n_x);
    grid.n_y = static_cast<int>(map.n_y);
    grid.dx_m = map.spacing_m[0];
    grid.dy_m = map.spacing_m[1];
    cv::Mat1d stiffness(grid.n_y, grid.n_x, 0.0);
    grid.there = cv::Mat1b(grid.n_y, grid.n_x, static_cast<unsigned char>(0));
    for (int j = 0; j < grid.n_y; ++j) {
        for (int i = 0; i < grid.n_x; ++i) {
            const double k = raw_N_per_m[static_cast<std::size_t>(j) * map.n_x + static_cast<std::size_t>(i)];
            if (std::isnan(k)) continue;
            stiffness(j, i) = k;
            grid.there(j, i) = 255;
        }
    }
    const double sigma_m = *options.smoothing_m;
    grid.stiffness = smoothed(stiffness, grid.there, sigma_m / grid.dx_m, sigma_m / grid.dy_m);
    cv::Mat1b missing;
    cv::copyMakeBorder(grid.there == 0, missing, 1, 1, 1, 1, cv::BORDER_CONSTANT, 255);
    cv::dilate(missing, missing, cv::Mat::ones(3, 3, CV_8U));
    grid.edge = missing(cv::Rect(1, 1, grid.n_x, grid.n_y)) & grid.there;
    grid.known = cv::Mat1b(grid.n_y, grid.n_x, static_cast<unsigned char>(0));
    return grid;
}

void take_background(const DetectOptions& options, StiffnessGrid& grid) {
    const cv::Mat1d plane = robust_plane(grid);
    cv::Mat1d rest;
    cv::subtract(grid.stiffness, plane, rest);
    const auto spread = [&] {
        const TwoSidedSpread both = two_sided_spread(values_in(grid.excess, grid.plain));
        return std::min(both.lower, both.upper);
    };
    grid.plain = without(grid.there, grid.known);
    for (int pass = 0; pass < 3; ++pass) {
        // soft outliers leave the windows, since a free edge would lower the median over a window's width
        cv::add(plane, window_median(rest, grid, options.window_m), grid.background);
        cv::subtract(grid.stiffness, grid.background, grid.excess);
        grid.excess.setTo(0.0, grid.there == 0);
        cv::Mat1b soft;
        cv::compare(grid.excess, -kSpreads * spread(), soft, cv::CMP_LT);
        grid.plain.setTo(0, soft);
    }
    grid.spread_N_per_m = spread();
}

}  // namespace palpa::stiffnessmaps
