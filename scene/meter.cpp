#include "scene/meter.h"

#include <algorithm>
#include <cmath>

namespace palpa::scene {

void Meter::add_ns(double ns) {
    ++timed_;
    worst_ns_ = std::max(worst_ns_, ns);
    const int bucket = ns > 1.0 ? static_cast<int>(kPerOctave * std::log2(ns)) : 0;
    ++buckets_[static_cast<std::size_t>(std::min(bucket, kPerOctave * kOctaves - 1))];
}

double Meter::quantile_ns(double q) const {
    if (timed_ == 0) return 0.0;
    const auto wanted = static_cast<std::int64_t>(q * static_cast<double>(timed_ - 1));
    std::int64_t seen = 0;
    for (std::size_t i = 0; i < buckets_.size(); ++i) {
        seen += buckets_[i];
        if (seen > wanted) return std::min(worst_ns_, std::exp2((static_cast<double>(i) + 0.5) / kPerOctave));
    }
    return worst_ns_;
}

Meter Meter::since(const Meter& earlier) const {
    Meter out = *this;
    out.calls_ -= earlier.calls_;
    out.timed_ -= earlier.timed_;
    for (std::size_t i = 0; i < buckets_.size(); ++i) out.buckets_[i] -= earlier.buckets_[i];
    return out;
}

}  // namespace palpa::scene
