#include "stiffnessmaps/import/sliding_tangential.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "files/text.h"
#include "stiffnessmaps/grid.h"
#include "stiffnessmaps/import/robust.h"

namespace palpa::stiffnessmaps {
namespace {

// Direction of a sample's motion, from 0.1 s before to 0.1 s after it; 0 if the tool stands still.
struct Motion {
    double x = 0.0;
    double y = 0.0;
};

std::vector<float> against(const Sliding& sliding, const Surface& surface, bool along_y,
                           const std::vector<Motion>& motion) {
    const SurfaceSamples& s = sliding.samples;
    constexpr double kAlong = 0.8;  // cosine
    std::vector<float> out(s.size(), kMissing);
    for (std::size_t i = 0; i < s.size(); ++i) {
        if ((along_y ? motion[i].y : motion[i].x) < kAlong) continue;
        const SurfacePoint p = surface_at(surface, s.x_m[i], s.y_m[i]);
        // the axis, projected onto the surface
        const std::size_t a = along_y ? 1 : 0;
        double e[3] = {along_y ? 0.0 : 1.0, along_y ? 1.0 : 0.0, 0.0};
        for (std::size_t c = 0; c < 3; ++c) e[c] -= p.normal[a] * p.normal[c];
        const double length = std::sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
        if (!(length > 1e-6)) continue;
        double force = 0.0;
        for (std::size_t c = 0; c < 3; ++c) force += e[c] / length * static_cast<double>(s.force_N[c][i]);
        out[i] = static_cast<float>(-force);  // the force on the tool points against its motion
    }
    return out;
}

std::vector<Motion> motions(const Sliding& sliding) {
    const SurfaceSamples& s = sliding.samples;
    std::vector<Motion> out(s.size());
    constexpr double kWindow_s = 0.1;
    constexpr double kStill_m = 0.05e-3;
    std::size_t from = 0;
    std::size_t to = 0;
    for (std::size_t i = 0; i < s.size(); ++i) {
        // the files follow one another, each with its own clock
        const auto near = [&](std::size_t j) { return std::abs(sliding.time_s[j] - sliding.time_s[i]) <= kWindow_s; };
        from = std::min(from, i);
        while (from < i && !near(from)) ++from;
        to = std::max(to, i);
        while (to + 1 < s.size() && near(to + 1)) ++to;
        const double dx = s.x_m[to] - s.x_m[from];
        const double dy = s.y_m[to] - s.y_m[from];
        const double length = std::hypot(dx, dy);
        if (length > kStill_m) out[i] = {dx / length, dy / length};
    }
    return out;
}

// Returns the median share of the normal force that holds the tool back along its motion; below 0 the sign is wrong.
double drag(const Samples& samples) {
    std::vector<double> shares;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        for (const auto& tangential : {&samples.tangential_x_N, &samples.tangential_y_N}) {
            const float t = (*tangential)[i];
            if (!std::isnan(t) && samples.force_N[i] > 0.05)
                shares.push_back(static_cast<double>(t) / samples.force_N[i]);
        }
    }
    return median(std::move(shares));
}

}  // namespace

bool take_tangential(const Sliding& sliding, const Surface& surface, const ImportOptions& options, Samples& pressed,
                     ImportReport& report) {
    const auto& lateral = sliding.samples.force_N;
    const auto silent = [](const std::vector<float>& f) {
        return std::all_of(f.begin(), f.end(), [](float v) { return v == 0.0f; });
    };
    const bool wanted = options.tangential.value_or(TangentialChoice::measured) == TangentialChoice::measured;
    if (!wanted || (silent(lateral[0]) && silent(lateral[1]))) return false;
    const std::vector<Motion> motion = motions(sliding);
    pressed.tangential_x_N = against(sliding, surface, false, motion);
    pressed.tangential_y_N = against(sliding, surface, true, motion);
    const double share = drag(pressed);
    if (share > 0.0 || options.tangential) return true;
    report.notes.push_back("the lateral force does not hold the tool back (median " + files::short_number(share) +
                           " of the normal force): it is not stored; --tangential measured stores it");
    pressed.tangential_x_N.clear();
    pressed.tangential_y_N.clear();
    return false;
}

}  // namespace palpa::stiffnessmaps
