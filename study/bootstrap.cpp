#include "study/bootstrap.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>

#include "files/distributions.h"
#include "files/quantile.h"
#include "study/binomial_draw.h"

namespace palpa::study {
namespace {

constexpr Interval kUnknown{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};

double share(double k, double n) { return k / n; }

Contribution counts_of(const std::optional<Contribution>& one) { return one.value_or(Contribution{0, 0}); }

// Returns how many have something to count.
std::size_t counted(const People& people) {
    return static_cast<std::size_t>(
        std::count_if(people.begin(), people.end(), [](const auto& one) { return one && one->n > 0; }));
}

// The z of bootstrap_share(), of people in so many strata.
double expanded_z(std::size_t people, std::size_t strata, double level) {
    const auto m = static_cast<double>(people), df = static_cast<double>(people - strata);
    return files::student_quantile(level, df) * std::sqrt(m / df);
}

Interval limits(std::vector<double>& values, std::size_t people, std::size_t strata, double skew, double level) {
    if (values.empty() || people <= strata) return kUnknown;
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    constexpr double kRounding = 1e-12;
    if (*most - *least < kRounding) return kUnknown;
    const double z = expanded_z(people, strata, level);
    constexpr double kMostSkew = 0.5;  // far from 1, where a limit would run away; reached below four people only
    const double az = std::clamp(skew * z, -kMostSkew, kMostSkew);
    return {files::reordered_quantile(values, files::normal_probability(-z / (1.0 + az))),
            files::reordered_quantile(values, files::normal_probability(z / (1.0 - az)))};
}

// What one participant contributed to two conditions.
struct Both {
    Contribution a, b;
    bool operator<(const Both& other) const {
        return std::array{a.k, a.n, b.k, b.n} < std::array{other.a.k, other.a.n, other.b.k, other.b.n};
    }
};

// Sums of contributions over a resample; with Average::people of shares, each of which weighs the same.
struct Sums {
    Average average = Average::pooled;
    double k_a = 0.0, n_a = 0.0, k_b = 0.0, n_b = 0.0;
    void add(const Both& one, double times) {
        add(one.a, times, k_a, n_a);
        add(one.b, times, k_b, n_b);
    }

  private:
    void add(const Contribution& one, double times, double& k, double& n) const {
        if (one.n == 0) return;
        const auto counted = static_cast<double>(one.n);
        const double weight = average == Average::people ? times / counted : times;
        k += weight * static_cast<double>(one.k);
        n += weight * counted;
    }
};

// Efron's acceleration of a's share: how skewed the people are, from e_i = k_i - share n_i.
double acceleration(const std::vector<Both>& people) {
    Sums all;
    for (const Both& one : people) all.add(one, 1.0);
    const double pooled = share(all.k_a, all.n_a);
    double squares = 0.0, cubes = 0.0;
    for (const Both& one : people) {
        const double e = static_cast<double>(one.a.k) - pooled * static_cast<double>(one.a.n);
        squares += e * e;
        cubes += e * e * e;
    }
    return squares > 0.0 ? cubes / (6.0 * std::pow(squares, 1.5)) : 0.0;
}

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

Interval bootstrap_share(const People& people, const BootstrapOptions& options) {
    if (counted(people) < 2) return kUnknown;
    std::vector<Both> in;
    for (const auto& one : people) {
        if (one) in.push_back({*one, {}});
    }
    const std::size_t m = in.size();
    const double skew = acceleration(in);
    const Stratum stratum(std::move(in));
    Random random(options.seed);
    std::vector<double> values;
    for (int r = 0; r < options.resamples; ++r) {
        Sums sums;
        stratum.draw(random, sums);
        if (sums.n_a > 0.0) values.push_back(share(sums.k_a, sums.n_a));
    }
    return limits(values, m, 1, skew, options.level);
}

Interval bootstrap_difference(const People& a, const People& b, Average average, const BootstrapOptions& options) {
    assert(a.size() == b.size());
    if (counted(a) < 2 || counted(b) < 2) return kUnknown;
    std::array<std::vector<Both>, 3> people;  // both, only a, only b
    std::size_t m = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (!a[i] && !b[i]) continue;
        people[!b[i] ? 1 : !a[i] ? 2 : 0].push_back({counts_of(a[i]), counts_of(b[i])});
        ++m;
    }
    const auto used = std::count_if(people.begin(), people.end(), [](const auto& one) { return !one.empty(); });
    std::vector<Stratum> strata;
    for (auto& stratum : people) strata.emplace_back(std::move(stratum));
    Random random(options.seed);
    std::vector<double> values;
    for (int r = 0; r < options.resamples; ++r) {
        Sums sums{average};
        for (const Stratum& stratum : strata) stratum.draw(random, sums);
        if (sums.n_a > 0.0 && sums.n_b > 0.0) values.push_back(share(sums.k_a, sums.n_a) - share(sums.k_b, sums.n_b));
    }
    return limits(values, m, static_cast<std::size_t>(used), 0.0, options.level);
}

double resamples_needed(double level, std::size_t people) {
    constexpr double kBeyond = 10.0;
    const double needed = kBeyond / files::normal_probability(-expanded_z(people, 1, level));
    const double unit = std::pow(10.0, std::floor(std::log10(needed)) - 1.0);
    return unit * std::ceil(needed / unit);
}

}  // namespace palpa::study
