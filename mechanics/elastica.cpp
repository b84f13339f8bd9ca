#include "mechanics/elastica.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpa::mechanics {
namespace {

constexpr double kQuarter = 1.5707963267948966;
constexpr double kNearly = 1e-3;  // rad: nearer to a quarter turn than this the end hangs along the force

struct ElasticaState {
    double phi = 0.0;     // a quarter turn less the slope
    double moment = 0.0;  // N m
    double x_m = 0.0;     // along the axis at rest, from the tip inwards
    double w_m = 0.0;     // along the force, from the tip inwards
};

// Slope of the state by the distance from the tip.
ElasticaState inward_rate(const ElasticaState& s, double force_N, double bending_N_m2) {
    const double c = std::sin(s.phi);
    return {s.moment / bending_N_m2, force_N * c, c, std::cos(s.phi)};
}

ElasticaState moved(const ElasticaState& s, double h_m, const ElasticaState& rate) {
    return {s.phi + h_m * rate.phi, s.moment + h_m * rate.moment, s.x_m + h_m * rate.x_m, s.w_m + h_m * rate.w_m};
}

void take_step(double h_m, double force_N, double D, ElasticaState& s) {
    const ElasticaState a = inward_rate(s, force_N, D);
    const ElasticaState b = inward_rate(moved(s, 0.5 * h_m, a), force_N, D);
    const ElasticaState c = inward_rate(moved(s, 0.5 * h_m, b), force_N, D);
    const ElasticaState d = inward_rate(moved(s, h_m, c), force_N, D);
    for (const auto& [weight, rate] : {std::pair{1.0, &a}, {2.0, &b}, {2.0, &c}, {1.0, &d}})
        s = moved(s, weight * h_m / 6.0, *rate);
}

// The state at the clamp, where phi must be a quarter turn; it grows with phi at the tip. Beyond half a turn it swings
// back, so that the way ends there.
ElasticaState at_clamp(std::span<const BeamPiece> pieces, bool clamped_low, double force_N, double tip_phi) {
    const double length_m = pieces.back().to_m - pieces.front().from_m;
    ElasticaState s;
    s.phi = tip_phi;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const BeamPiece& piece = pieces[clamped_low ? pieces.size() - 1 - i : i];
        const double piece_m = piece.to_m - piece.from_m;
        const int steps = std::max(1, static_cast<int>(std::ceil(200.0 * piece_m / length_m)));
        for (int k = 0; k < steps && s.phi < 2.0 * kQuarter; ++k)
            take_step(piece_m / steps, force_N, piece.section.bending_N_m2, s);
    }
    return s;
}

}  // namespace

ElasticaTip elastica_tip(std::span<const BeamPiece> pieces, bool clamped_low, double force_N) {
    if (pieces.empty() || !(std::abs(force_N) > 0.0)) return {};
    const auto stiff = [&](double phi) { return at_clamp(pieces, clamped_low, std::abs(force_N), phi).phi > kQuarter; };
    // near a quarter turn phi is halved on a logarithmic scale, else the slope itself
    const bool hangs = stiff(kNearly);
    double low = hangs ? std::log(1e-300) : kNearly, high = hangs ? std::log(kNearly) : kQuarter;
    for (int i = 0; i < 44; ++i) {
        const double middle = 0.5 * (low + high);
        (stiff(hangs ? std::exp(middle) : middle) ? high : low) = middle;
    }
    const double phi = hangs ? std::exp(high) : high;
    const ElasticaState clamp = at_clamp(pieces, clamped_low, std::abs(force_N), phi);
    const double length_m = pieces.back().to_m - pieces.front().from_m;
    const double sign = force_N > 0.0 ? 1.0 : -1.0;
    return {sign * clamp.w_m, length_m - clamp.x_m, sign * (kQuarter - phi)};
}

}  // namespace palpa::mechanics
