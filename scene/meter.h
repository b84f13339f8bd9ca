#pragma once
// Counts how often a stage was called and how long it took. The times go into a histogram of fixed size, so that
// measuring allocates nothing; its buckets are 1/32 octave wide, so that quantiles are accurate to about 2 %.

#include <array>
#include <cstdint>

#include "files/clock.h"

namespace palpa::scene {

class Meter {
  public:
    void count() { ++calls_; }
    void add_ns(double ns);
    std::int64_t calls() const { return calls_; }
    std::int64_t timed() const { return timed_; }
    double quantile_ns(double q) const;  // q in 0 ... 1; 0 ns if nothing was timed
    double worst_ns() const { return worst_ns_; }
    // What was counted and timed since `earlier`, a copy of this meter; the worst is still that of all.
    Meter since(const Meter& earlier) const;

  private:
    static constexpr int kPerOctave = 32;
    static constexpr int kOctaves = 36;  // 1 ns to 68 s
    std::int64_t calls_ = 0;
    std::int64_t timed_ = 0;
    double worst_ns_ = 0.0;
    std::array<std::uint32_t, kPerOctave * kOctaves> buckets_{};
};

using files::steady_ns;

}  // namespace palpa::scene
