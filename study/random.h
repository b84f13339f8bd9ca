#pragma once
// Random numbers that are the same on every machine and with every standard library, unlike <random>'s
// distributions: orders of trials and bootstraps must repeat from their seed anywhere.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace palpa::study {

// SplitMix64 (Steele, Lea & Flood, OOPSLA 2014): one 64-bit word of state; passes BigCrush.
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    // Returns a number in [0, 1).
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    // Returns one of 0 ... n - 1. Their probabilities differ by at most 2^-32.
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(((bits() >> 32) * n) >> 32); }
    // Returns a standard normal number, by the method of Box and Muller.
    double normal() {
        const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
        return radius * std::cos(2.0 * std::numbers::pi * uniform());
    }
    template <class T>
    void shuffle(std::vector<T>& items) {
        for (std::size_t i = items.size(); i > 1; --i)
            std::swap(items[i - 1], items[below(static_cast<std::uint32_t>(i))]);
    }

  private:
    std::uint64_t state_;
};

// Derives a seed for one purpose (a participant, a trial) from the study's seed, so that no two purposes share a
// sequence.
inline std::uint64_t derived_seed(std::uint64_t seed, std::uint64_t purpose, std::uint64_t index) {
    Random mixed(seed ^ (purpose * 0xd1342543de82ef95u));
    Random again(mixed.bits() ^ (index * 0xaf251af3b0f025b5u));
    return again.bits();
}

}  // namespace palpa::study
