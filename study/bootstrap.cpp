#include "study/bootstrap.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <map>

#include "files/quantile.h"
#include "study/binomial_draw.h"

namespace palpa::study {
namespace {

constexpr Interval kUnknown{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};

double share(double k, double n) { return k / n; }

Interval percentiles(std::vector<double>& values, double level) {
    if (values.empty()) return kUnknown;
    const double tail = 0.5 * (1.0 - level);
    return {files::reordered_quantile(values, tail), files::reordered_quantile(values, 1.0 - tail)};
}

// What one participant contributed to two conditions.
struct Both {
    Contribution a, b;
    bool operator<(const Both& other) const {
        return std::array{a.k, a.n, b.k, b.n} < std::array{other.a.k, other.a.n, other.b.k, other.b.n};
    }
};

// Sums of contributions over a resample.
struct Sums {
    double k_a = 0.0, n_a = 0.0, k_b = 0.0, n_b = 0.0;
    void add(const Both& one, double times) {
        k_a += times * static_cast<double>(one.a.k);
        n_a += times * static_cast<double>(one.a.n);
        k_b += times * static_cast<double>(one.b.k);
        n_b += times * static_cast<double>(one.b.n);
    }
};

// People drawn with replacement from one stratum. Of many people most contribute the same as others; then how often each
// kind of contribution is drawn follows from one binomial draw for each kind, with the same distribution of the sums.
class Stratum {
  public:
    explicit Stratum(std::vector<Both> people) : people_(std::move(people)) {
        constexpr std::size_t kMany = 2000, kAlike = 20;
        if (people_.size() < kMany) return;
        std::map<Both, std::int64_t> kinds;
        for (const Both& one : people_) ++kinds[one];
        if (kAlike * kinds.size() < people_.size()) kinds_.assign(kinds.begin(), kinds.end());
    }

    void draw(Random& random, Sums& sums) const {
        const auto n = static_cast<std::int64_t>(people_.size());
        if (kinds_.empty()) {
            for (std::int64_t i = 0; i < n; ++i) sums.add(people_[random.below(static_cast<std::uint32_t>(n))], 1.0);
            return;
        }
        std::int64_t left = n, undrawn = n;  // people to draw, people of the kinds that are still to come
        for (const auto& [kind, count] : kinds_) {
            const double chance = static_cast<double>(count) / static_cast<double>(undrawn);
            const std::int64_t times = count == undrawn ? left : binomial_draw(left, chance, random);
            sums.add(kind, static_cast<double>(times));
            left -= times;
            undrawn -= count;
        }
    }

  private:
    std::vector<Both> people_;
    std::vector<std::pair<Both, std::int64_t>> kinds_;  // with their numbers of people; empty: drawn one by one
};

}  // namespace

Interval bootstrap_share(std::span<const Contribution> people, const BootstrapOptions& options) {
    std::vector<Both> in;
    for (const Contribution& one : people) {
        if (one.n > 0) in.push_back({one, {}});
    }
    if (in.size() < 2) return kUnknown;
    const Stratum stratum(std::move(in));
    Random random(options.seed);
    std::vector<double> values;
    for (int r = 0; r < options.resamples; ++r) {
        Sums sums;
        stratum.draw(random, sums);
        values.push_back(share(sums.k_a, sums.n_a));
    }
    return percentiles(values, options.level);
}

Interval bootstrap_difference(std::span<const Contribution> a, std::span<const Contribution> b,
                              const BootstrapOptions& options) {
    assert(a.size() == b.size());
    std::array<std::vector<Both>, 3> people;  // both, only a, only b
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (a[i].n > 0 && b[i].n > 0) people[0].push_back({a[i], b[i]});
        if (a[i].n > 0 && b[i].n == 0) people[1].push_back({a[i], b[i]});
        if (a[i].n == 0 && b[i].n > 0) people[2].push_back({a[i], b[i]});
    }
    if (people[0].size() + people[1].size() < 2 || people[0].size() + people[2].size() < 2) return kUnknown;
    std::vector<Stratum> strata;
    for (auto& stratum : people) strata.emplace_back(std::move(stratum));
    Random random(options.seed);
    std::vector<double> values;
    for (int r = 0; r < options.resamples; ++r) {
        Sums sums;
        for (const Stratum& stratum : strata) stratum.draw(random, sums);
        values.push_back(share(sums.k_a, sums.n_a) - share(sums.k_b, sums.n_b));
    }
    return percentiles(values, options.level);
}

}  // namespace palpa::study
