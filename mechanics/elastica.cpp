#include "mechanics/elastica.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

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

// A cantilever from the tip inwards.
struct InwardPiece {
    double length_m = 0.0;
    double bending_N_m2 = 0.0;
    int steps = 1;
};

// The part that bends, at most 30 lengths sqrt(D / F) from the clamp; the rest of the beam hangs straight.
std::vector<InwardPiece> bending_part(std::span<const BeamPiece> pieces, bool clamped_low, double force_N) {
    constexpr double kBends = 30.0, kSteps = 40.0;
    const double length_m = pieces.back().to_m - pieces.front().from_m;
    std::vector<InwardPiece> out;
    double left = kBends;
    for (std::size_t i = 0; i < pieces.size() && left > 0.0; ++i) {  // from the clamp outwards
        const BeamPiece& piece = pieces[clamped_low ? i : pieces.size() - 1 - i];
        const double D = piece.section.bending_N_m2, decay_m = std::sqrt(D / force_N);
        const double piece_m = std::min(piece.to_m - piece.from_m, left * decay_m);
        const double steps = std::max(200.0 * piece_m / length_m, kSteps * piece_m / decay_m);
        out.push_back({piece_m, D, std::max(1, static_cast<int>(std::ceil(steps)))});
        left -= piece_m / decay_m;
    }
    std::reverse(out.begin(), out.end());
    return out;
}

// The state at the clamp, where phi must be a quarter turn; it grows with phi at the tip. Beyond half a turn it swings
// back, so that the way ends there.
ElasticaState at_clamp(const std::vector<InwardPiece>& pieces, double force_N, double tip_phi) {
    ElasticaState s;
    s.phi = tip_phi;
    for (const InwardPiece& piece : pieces) {
        for (int k = 0; k < piece.steps && s.phi < 2.0 * kQuarter; ++k)
            take_step(piece.length_m / piece.steps, force_N, piece.bending_N_m2, s);
    }
    return s;
}

ElasticaTip bent_tip(std::span<const BeamPiece> beam, bool clamped_low, double force_N) {
    const std::vector<InwardPiece> pieces = bending_part(beam, clamped_low, force_N);
    const auto stiff = [&](double phi) { return at_clamp(pieces, force_N, phi).phi > kQuarter; };
    // near a quarter turn phi is halved on a logarithmic scale, else the slope itself
    const bool hangs = stiff(kNearly);
    double low = hangs ? std::log(1e-300) : kNearly, high = hangs ? std::log(kNearly) : kQuarter;
    for (int i = 0; i < 44; ++i) {
        const double middle = 0.5 * (low + high);
        (stiff(hangs ? std::exp(middle) : middle) ? high : low) = middle;
    }
    const double phi = hangs ? std::exp(high) : high;
    const ElasticaState clamp = at_clamp(pieces, force_N, phi);
    const double length_m = beam.back().to_m - beam.front().from_m;
    double straight_m = length_m;
    for (const InwardPiece& piece : pieces) straight_m -= piece.length_m;
    return {clamp.w_m + std::max(0.0, straight_m), length_m - clamp.x_m, kQuarter - phi};
}

}  // namespace

ElasticaTip elastica_tip(std::span<const BeamPiece> pieces, bool clamped_low, double force_N) {
    if (pieces.empty() || !(std::abs(force_N) > 0.0) || !std::isfinite(force_N)) return {};
    constexpr double kLinear_rad = 1e-4;  // below it deflection and slope go with the force, to 1e-8
    const BeamTip linear = beam_tip(pieces, clamped_low, false);
    const double scale = std::min(1.0, std::abs(force_N) * linear.rad_per_N / kLinear_rad);
    const double sign = force_N > 0.0 ? 1.0 : -1.0;
    if (scale < 1e-100) return {force_N * linear.m_per_N, 0.0, force_N * linear.rad_per_N};
    const ElasticaTip tip = bent_tip(pieces, clamped_low, std::abs(force_N) / scale);
    return {sign * scale * tip.across_m, scale * scale * tip.shortening_m, sign * scale * tip.slope_rad};
}

}  // namespace palpa::mechanics
