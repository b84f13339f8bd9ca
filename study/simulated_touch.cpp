#include "study/simulated_touch.h"

#include <algorithm>
#include <cmath>

namespace palpa::study {
namespace {

constexpr double kGrowing = 0.9;        // share of the greatest shape up to which the shape counts as growing
constexpr double kLeastShape_m = 5e-5;  // half a step of the paper's pins
constexpr double kLeastDepth_m = 1e-6;
constexpr double kLeastForce_N = 1e-3;

bool is_finite(const FeltMoment& moment) {
    return std::isfinite(moment.force_N + moment.depth_m + moment.shape_m + moment.own_shape_m);
}

// Slope of y over x through the origin.
struct Slope {
    double xy = 0.0;
    double xx = 0.0;
    void add(double x, double y) {
        xy += x * y;
        xx += x * x;
    }
    double value() const { return xx > 0.0 ? xy / xx : 0.0; }
};

// ln(N/m), or NaN.
double ln_force_over_depth(std::span<const FeltMoment> press) {
    Slope slope;
    double deepest_m = 0.0;
    for (const FeltMoment& moment : press) {
        if (!is_finite(moment)) continue;
        slope.add(moment.depth_m, moment.force_N);
        deepest_m = std::max(deepest_m, moment.depth_m);
    }
    const bool felt = deepest_m > kLeastDepth_m && slope.value() > 0.0;
    return felt ? std::log(slope.value()) : std::numeric_limits<double>::quiet_NaN();
}

double ln_force_over_shape(std::span<const FeltMoment> press) {
    double greatest_m = 0.0;
    for (const FeltMoment& moment : press) {
        if (is_finite(moment)) greatest_m = std::max(greatest_m, moment.shape_m);
    }
    if (greatest_m < kLeastShape_m) return std::numeric_limits<double>::quiet_NaN();
    Slope shape, own;
    for (const FeltMoment& moment : press) {
        if (!is_finite(moment) || moment.depth_m < kLeastDepth_m || moment.force_N < kLeastForce_N) continue;
        own.add(moment.depth_m, moment.own_shape_m);
        if (moment.shape_m < kGrowing * greatest_m) shape.add(moment.shape_m, moment.force_N);
    }
    const bool felt = shape.value() > 0.0 && own.value() > 0.0;
    return felt ? std::log(own.value() * shape.value()) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

FeltStiffness feel_by_hand(std::span<const FeltMoment> press) {
    FeltStiffness felt;
    felt.by(Sense::hand) = ln_force_over_depth(press);
    felt.by(Sense::fingertip) = ln_force_over_shape(press);
    return felt;
}

FeltStiffness feel_soft_surface(std::span<const FeltMoment> press) {
    FeltStiffness felt;
    felt.by(Sense::hand) = felt.by(Sense::fingertip) = ln_force_over_depth(press);
    return felt;
}

FeltStiffness feel_by_eye(std::span<const FeltMoment> press) {
    FeltStiffness felt;
    felt.by(Sense::eye) = ln_force_over_depth(press);
    return felt;
}

double perceived_ln(const FeltStiffness& felt, const TouchNoise& noise, Random& random) {
    double sum = 0.0, weights = 0.0, guess = 0.0;
    for (std::size_t k = 0; k < kSenses; ++k) {
        const double error = noise.sd[k] * random.normal();
        if (k == static_cast<std::size_t>(Sense::hand)) guess = error;
        if (!std::isfinite(felt.ln_N_per_m[k])) continue;
        const double weight = 1.0 / (noise.sd[k] * noise.sd[k]);
        sum += weight * (felt.ln_N_per_m[k] + error);
        weights += weight;
    }
    return weights > 0.0 ? sum / weights : guess;
}

double joined_ln(const FeltStiffness& felt, const TouchNoise& noise) {
    double sum = 0.0, weights = 0.0;
    for (std::size_t k = 0; k < kSenses; ++k) {
        if (!std::isfinite(felt.ln_N_per_m[k])) continue;
        const double weight = 1.0 / (noise.sd[k] * noise.sd[k]);
        sum += weight * felt.ln_N_per_m[k];
        weights += weight;
    }
    return weights > 0.0 ? sum / weights : std::numeric_limits<double>::quiet_NaN();
}

double perceived_sd(const FeltStiffness& felt, const TouchNoise& noise) {
    double weights = 0.0;
    for (std::size_t k = 0; k < kSenses; ++k) {
        if (std::isfinite(felt.ln_N_per_m[k])) weights += 1.0 / (noise.sd[k] * noise.sd[k]);
    }
    return weights > 0.0 ? 1.0 / std::sqrt(weights) : noise.sd[static_cast<std::size_t>(Sense::hand)];
}

}  // namespace palpa::study
