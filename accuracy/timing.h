#pragma once
// Times of single calls, and the memory in use.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "files/clock.h"
#include "files/quantile.h"

namespace palpa::accuracy {

struct Timing {
    std::vector<double> us;  // of each call
};

inline double quantile_us(const Timing& timing, double share) {
    return files::quantile(timing.us, share, files::QuantileType::reached);
}

template <class Call>
void time_call(Timing& timing, Call&& call) {
    const std::int64_t began_ns = files::steady_ns();
    call();
    timing.us.push_back(1e-3 * static_cast<double>(files::steady_ns() - began_ns));
}

// Times call(i) until `budget_s` is spent, at least `least` and at most `most` times.
template <class Call>
Timing time_calls(int least, int most, double budget_s, Call&& call) {
    Timing timing;
    double spent_s = 0.0;
    for (int i = 0; i < most && (i < least || spent_s < budget_s); ++i) {
        time_call(timing, [&] { call(i); });
        spent_s += 1e-6 * timing.us.back();
    }
    return timing;
}

// Returns the heap in use, MB; NaN if the allocator does not report it (sanitizers, other C libraries).
double heap_MB();

}  // namespace palpa::accuracy
