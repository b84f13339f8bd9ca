#include "stiffnessmaps/import/robust.h"

#include <algorithm>
#include <cmath>

#include "files/quantile.h"
#include "stiffnessmaps/import/choices.h"

namespace palpa::stiffnessmaps {

double quantile(std::vector<double> values, double q) {
    const double value = files::quantile(std::move(values), q, files::QuantileType::nearest);
    return std::isnan(value) ? 0.0 : value;
}

double robust_deviation(std::vector<double> values) {
    constexpr double kNormal = 1.4826;
    const double middle = median(values);
    for (double& v : values) v = std::abs(v - middle);
    return kNormal * median(std::move(values));
}

std::vector<bool> lone_outliers(const std::vector<double>& values, double limit) {
    std::vector<bool> out(values.size(), false);
    const auto outside = [&](std::size_t i) {
        if (i == 0 || i + 1 >= values.size()) return 0.0;
        const double low = std::min(values[i - 1], values[i + 1]);
        const double high = std::max(values[i - 1], values[i + 1]);
        return std::max({0.0, values[i] - high, low - values[i]});
    };
    // on a slope, the good value beside a spike lies outside too, but less far
    for (std::size_t i = 1; i + 1 < values.size(); ++i) {
        const double here = outside(i);
        out[i] = here > limit && here >= outside(i - 1) && here >= outside(i + 1);
    }
    return out;
}

void add_fourth_differences(const std::vector<double>& values, std::vector<double>& differences) {
    for (std::size_t i = 2; i + 2 < values.size(); ++i) {
        const double* v = &values[i];
        differences.push_back(v[-2] - 4.0 * v[-1] + 6.0 * v[0] - 4.0 * v[1] + v[2]);
    }
}

double noise_of_fourth_differences(std::vector<double> differences) {
    return robust_deviation(std::move(differences)) / std::sqrt(70.0);
}

double choice_mm(double metres) { return std::round(metres * 1e9) / 1e6; }

std::vector<double> choice_mm(const std::vector<double>& metres) {
    std::vector<double> out;
    for (const double m : metres) out.push_back(choice_mm(m));
    return out;
}

}  // namespace palpa::stiffnessmaps
