#include "calibration/quality.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "files/quantile.h"

namespace palpa::calibration {
namespace {

double r2(const Eigen::ArrayXd& measured, const Eigen::ArrayXd& predicted) {
    if (measured.size() < 2) return platform::kMissing;
    const double scatter = (measured - measured.mean()).square().sum();
    return scatter > 0.0 ? 1.0 - (measured - predicted).square().sum() / scatter : platform::kMissing;
}

std::vector<double> relative_errors(const Eigen::ArrayXd& level, const Eigen::ArrayXd& measured_N,
                                    const Eigen::ArrayXd& predicted_N, double lowest, double from, double to) {
    std::vector<double> errors;
    for (Eigen::Index i = 0; i < level.size(); ++i) {
        if (!(level(i) > lowest && level(i) >= from && level(i) < to && measured_N(i) > 0.0)) continue;
        errors.push_back(std::abs(std::max(predicted_N(i), 0.0) - measured_N(i)) / measured_N(i));
    }
    return errors;
}

}  // namespace

FitQuality fit_quality(const Eigen::ArrayXd& measured_N, const Eigen::ArrayXd& predicted_N) {
    FitQuality quality;
    quality.r2_newton = r2(measured_N, predicted_N);
    quality.rmse_N = std::sqrt((measured_N - predicted_N).square().mean());
    Eigen::ArrayXd log_measured(measured_N.size());
    Eigen::ArrayXd log_predicted(measured_N.size());
    Eigen::Index n = 0;
    for (Eigen::Index i = 0; i < measured_N.size(); ++i) {
        if (!(measured_N(i) > 0.0 && predicted_N(i) > 0.0)) continue;
        log_measured(n) = std::log(measured_N(i));
        log_predicted(n++) = std::log(predicted_N(i));
    }
    quality.r2_log = r2(log_measured.head(n), log_predicted.head(n));
    return quality;
}

std::vector<ErrorBand> error_bands(const Eigen::ArrayXd& level, const Eigen::ArrayXd& measured_N,
                                   const Eigen::ArrayXd& predicted_N, LevelRange range) {
    constexpr int kBands = 5;
    std::vector<ErrorBand> bands;
    for (int i = 0; i < kBands; ++i) {
        ErrorBand band;
        band.from = range.lowest + (range.highest - range.lowest) * i / kBands;
        band.to = range.lowest + (range.highest - range.lowest) * (i + 1) / kBands;
        const bool last = i + 1 == kBands;
        auto errors = relative_errors(level, measured_N, predicted_N, range.lowest, band.from,
                                      last ? std::numeric_limits<double>::infinity() : band.to);
        band.n = errors.size();
        band.median = files::median(errors);
        band.p90 = files::quantile(errors, 0.9);
        bands.push_back(band);
    }
    return bands;
}

double median_relative_error(const Eigen::ArrayXd& level, const Eigen::ArrayXd& measured_N,
                             const Eigen::ArrayXd& predicted_N, LevelRange range) {
    auto errors = relative_errors(level, measured_N, predicted_N, range.lowest, range.lowest,
                                  std::numeric_limits<double>::infinity());
    return files::median(errors);
}

}  // namespace palpa::calibration
