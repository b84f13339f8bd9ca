#include "study/psychometric_people.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "files/distributions.h"
#include "files/quantile.h"
#include "study/random.h"

namespace palpa::study {
namespace {

using Drawn = std::span<const std::size_t>;

// The answers of all people on one list of levels, so that a resample is a sum over its people.
class Pool {
  public:
    Pool(std::span<const PersonAnswers> people, double greatest_lapse)
        : greatest_lapse_(greatest_lapse), levels_(pooled_answers(people)) {
        for (const PersonAnswers& person : people) {
            rows_.emplace_back();
            std::size_t at = 0;  // both lists are in order
            for (const LevelAnswers& answers : person) {
                while (at + 1 < levels_.size() && levels_[at + 1].x <= answers.x) ++at;
                rows_.back().push_back({at, answers.stiffer, answers.n});
            }
        }
        if (levels_.size() < 2) return;
        const PsychometricCurve curve = likeliest_curve(levels_, greatest_lapse_);
        if (std::isfinite(curve.pse)) start_ = curve;
    }

    // sd is NaN if the people drawn leave fewer than two levels.
    PsychometricCurve curve_of(Drawn people) {
        drawn_ = levels_;
        for (LevelAnswers& level : drawn_) level.stiffer = level.n = 0;
        for (const std::size_t person : people) {
            for (const Row& row : rows_[person]) {
                drawn_[row.level].stiffer += row.stiffer;
                drawn_[row.level].n += row.n;
            }
        }
        std::erase_if(drawn_, [](const LevelAnswers& level) { return level.n == 0; });
        constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
        if (drawn_.size() < 2) return {kNone, kNone, 0.0};
        return likeliest_curve(drawn_, greatest_lapse_, start_);
    }

  private:
    struct Row {
        std::size_t level;
        std::int64_t stiffer, n;
    };
    double greatest_lapse_;
    std::vector<LevelAnswers> levels_;
    std::vector<std::vector<Row>> rows_;
    std::optional<PsychometricCurve> start_;
    std::vector<LevelAnswers> drawn_;
};

double expanded_tail(double level, std::size_t people) {
    const auto n = static_cast<double>(people);
    return 0.5 * std::erfc(files::student_quantile(level, n - 1.0) * std::sqrt(n / (n - 1.0)) / std::sqrt(2.0));
}

// A limit that is 0, infinite or no number is none. Resamples without a value may lie on either side, so neither limit
// exists if they are more than a tail.
OpenInterval percentiles(std::vector<double>& values, double tail) {
    const auto end = std::partition(values.begin(), values.end(), [](double value) { return !std::isnan(value); });
    const auto lost = static_cast<double>(values.end() - end);
    if (lost > tail * static_cast<double>(values.size())) return {};
    values.erase(end, values.end());
    std::sort(values.begin(), values.end());
    const auto at = [&](double share) {
        // between a number and an infinity there is nothing to interpolate
        const double value =
            std::isfinite(values.front()) && std::isfinite(values.back())
                ? files::sorted_quantile(values, share)
                : files::sorted_quantile(values, share,
                                         share < 0.5 ? files::QuantileType::lower : files::QuantileType::reached);
        return std::isfinite(value) ? std::optional(value) : std::nullopt;
    };
    return {at(tail), at(1.0 - tail)};
}

OpenInterval of_positive(OpenInterval ci) {
    if (ci.low && *ci.low <= 0.0) ci.low.reset();
    return ci;
}

void draw(const std::vector<std::size_t>& from, Random& random, std::vector<std::size_t>& to) {
    for (std::size_t i = 0; i < from.size(); ++i)
        to.push_back(from[random.below(static_cast<std::uint32_t>(from.size()))]);
}

}  // namespace

std::vector<LevelAnswers> pooled_answers(std::span<const PersonAnswers> people) {
    std::vector<LevelAnswers> all;
    for (const PersonAnswers& person : people) all.insert(all.end(), person.begin(), person.end());
    return merged_levels(std::move(all));
}

ResampledCurves resampled_curves(std::span<const PersonAnswers> people, double greatest_lapse,
                                 const BootstrapOptions& options) {
    ResampledCurves out;
    for (std::size_t i = 0; i < people.size(); ++i) {
        if (!people[i].empty()) out.people.push_back(i);
    }
    if (out.people.size() < 2) return out;
    Pool pool(people, greatest_lapse);
    Random random(options.seed);
    std::vector<std::size_t> drawn;
    for (int r = 0; r < options.resamples; ++r) {
        drawn.clear();
        draw(out.people, random, drawn);
        const PsychometricCurve curve = pool.curve_of(drawn);
        out.pse.push_back(curve.pse);
        out.sd.push_back(curve.sd);
    }
    return out;
}

CurveIntervals intervals_of(const ResampledCurves& curves, double level) {
    if (curves.people.size() < 2) return {};
    std::vector<double> pse = curves.pse, sd = curves.sd;
    const double tail = expanded_tail(level, curves.people.size());
    return {percentiles(pse, tail), of_positive(percentiles(sd, tail))};
}

OpenInterval bootstrap_jnd_ratio(const Resampled& of_a, const Resampled& of_b, double greatest_lapse,
                                 const BootstrapOptions& options) {
    assert(of_a.people.size() == of_b.people.size());
    const std::size_t n_a = of_a.curves.people.size(), n_b = of_b.curves.people.size();
    if (n_a < 2 || n_b < 2) return {};
    std::vector<double> ratios;
    const auto add = [&](double sd_a, double sd_b) { ratios.push_back(sd_a / sd_b); };
    if (of_a.curves.people == of_b.curves.people) {
        for (std::size_t r = 0; r < of_a.curves.sd.size(); ++r) add(of_a.curves.sd[r], of_b.curves.sd[r]);
    } else {
        std::array<std::vector<std::size_t>, 3> strata;  // both, only a, only b
        for (std::size_t i = 0; i < of_a.people.size(); ++i) {
            const bool in_a = !of_a.people[i].empty(), in_b = !of_b.people[i].empty();
            if (in_a || in_b) strata[in_a && in_b ? 0 : in_a ? 1 : 2].push_back(i);
        }
        Pool pool_a(of_a.people, greatest_lapse), pool_b(of_b.people, greatest_lapse);
        Random random(options.seed);
        std::vector<std::size_t> drawn;
        for (int r = 0; r < options.resamples; ++r) {
            drawn.clear();
            for (const auto& stratum : strata) draw(stratum, random, drawn);
            add(pool_a.curve_of(drawn).sd, pool_b.curve_of(drawn).sd);
        }
    }
    return of_positive(percentiles(ratios, expanded_tail(options.level, std::min(n_a, n_b))));
}

OpenInterval independent_jnd_ratio(const PsychometricFit& a, const PsychometricFit& b) {
    OpenInterval ci;
    if (!a.sd || !b.sd) return ci;
    const double u = std::log(*a.sd), v = std::log(*b.sd);
    if (a.sd_ci.low && b.sd_ci.high)
        ci.low = std::exp(u - v - std::hypot(u - std::log(*a.sd_ci.low), std::log(*b.sd_ci.high) - v));
    if (a.sd_ci.high && b.sd_ci.low)
        ci.high = std::exp(u - v + std::hypot(std::log(*a.sd_ci.high) - u, v - std::log(*b.sd_ci.low)));
    return ci;
}

}  // namespace palpa::study
