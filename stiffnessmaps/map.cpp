#include "stiffnessmaps/map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpa::stiffnessmaps {

std::size_t missing_count(const Map& map) {
    const auto missing = [](float force) { return std::isnan(force); };
    return static_cast<std::size_t>(std::count_if(map.normal_N.begin(), map.normal_N.end(), missing));
}

ForceRange force_range(const Map& map) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const float force : map.normal_N) {
        if (std::isnan(force)) continue;
        low = std::min(low, static_cast<double>(force));
        high = std::max(high, static_cast<double>(force));
    }
    if (low > high) return {};
    return {low, high};
}

const char* name_of(IndenterShape shape) { return shape == IndenterShape::sphere ? "sphere" : "cylinder"; }

const char* name_of(TangentialKind kind) {
    switch (kind) {
        case TangentialKind::recorded:
            return "recorded";
        case TangentialKind::energy:
            return "energy";
        case TangentialKind::none:
            return "none";
    }
    return "none";
}

const char* name_of(SourceKind kind) {
    switch (kind) {
        case SourceKind::recorded:
            return "recorded";
        case SourceKind::simulated:
            return "simulated";
        case SourceKind::analytic:
            return "analytic";
    }
    return "recorded";
}

}  // namespace palpa::stiffnessmaps
