#include "study/simulated_observer.h"

#include <algorithm>
#include <cmath>

namespace palpa::study {
namespace {

bool holds(const OpenInterval& ci, double truth) {
    return !(ci.low && *ci.low > truth) && !(ci.high && *ci.high < truth);
}

PsychometricCurve someone(const PsychometricCurve& average, const ObservedPeople& people, Random& random) {
    return {average.pse + people.pse_spread * random.normal(),
            average.sd * std::exp(people.log_sd_spread * random.normal()), average.lapse};
}

// The curve through the expected answers of 20,000 people.
PsychometricCurve curve_of_all(const std::vector<double>& levels, const ObserverOptions& options,
                               const ObservedPeople& people) {
    constexpr int kMany = 20000;
    constexpr double kAnswers = 1e9;  // at each level, so that expected shares are counts
    Random random(derived_seed(options.seed, 2, 0));
    std::vector<double> shares(levels.size(), 0.0);
    for (int i = 0; i < kMany; ++i) {
        const PsychometricCurve one = someone(options.truth, people, random);
        for (std::size_t j = 0; j < levels.size(); ++j) shares[j] += probability_stiffer(levels[j], one) / kMany;
    }
    std::vector<LevelAnswers> expected;
    for (std::size_t j = 0; j < levels.size(); ++j)
        expected.push_back({levels[j], std::llround(kAnswers * shares[j]), std::llround(kAnswers)});
    return likeliest_curve(expected, options.fit.greatest_lapse);
}

}  // namespace

std::vector<double> paper_levels() {
    std::vector<double> x;
    for (const double comparison_kPa : {1.875, 2.0, 2.25, 2.75, 3.75}) {
        x.push_back(std::log(comparison_kPa / 1.75));
        x.push_back(-x.back());
    }
    std::sort(x.begin(), x.end());
    return x;
}

std::vector<LevelAnswers> draw_answers(const std::vector<double>& levels, int trials, const PsychometricCurve& truth,
                                       Random& random) {
    std::vector<LevelAnswers> out;
    const int each = trials / static_cast<int>(levels.size());
    int left = trials % static_cast<int>(levels.size());
    for (const double x : levels) {
        LevelAnswers answers{x, 0, each + (left-- > 0 ? 1 : 0)};
        const double p = probability_stiffer(x, truth);
        for (std::int64_t i = 0; i < answers.n; ++i) answers.stiffer += random.uniform() < p ? 1 : 0;
        if (answers.n > 0) out.push_back(answers);
    }
    return out;
}

Held coverage_of_profiles(const ObserverOptions& options) {
    const std::vector<double> levels = paper_levels();
    Held held;
    for (int repeat = 0; repeat < options.repeats; ++repeat) {
        Random random(derived_seed(options.seed, 1, static_cast<std::uint64_t>(repeat)));
        const PsychometricFit a =
            fit_psychometric(draw_answers(levels, options.trials, options.truth, random), options.fit);
        const PsychometricFit b =
            fit_psychometric(draw_answers(levels, options.trials, options.truth, random), options.fit);
        ++held.of;
        held.pse += holds(a.pse_ci, options.truth.pse) ? 1 : 0;
        held.sd += holds(a.sd_ci, options.truth.sd) ? 1 : 0;
        held.jnd_ratio += holds(independent_jnd_ratio(a, b), 1.0) ? 1 : 0;
        held.open += a.status == FitStatus::open ? 1 : 0;
        held.separated += a.status == FitStatus::separated ? 1 : 0;
    }
    return held;
}

Held coverage_of_bootstrap(const ObserverOptions& options, const ObservedPeople& people, int resamples) {
    const std::vector<double> levels = paper_levels();
    const PsychometricCurve truth = curve_of_all(levels, options, people);
    Held held;
    for (int repeat = 0; repeat < options.repeats; ++repeat) {
        Random random(derived_seed(options.seed, 3, static_cast<std::uint64_t>(repeat)));
        std::vector<PersonAnswers> a, b;
        for (int i = 0; i < people.n; ++i) {
            const PsychometricCurve one = someone(options.truth, people, random);
            a.push_back(draw_answers(levels, options.trials, one, random));
            b.push_back(draw_answers(levels, options.trials, one, random));
        }
        const BootstrapOptions bootstrap{resamples, derived_seed(options.seed, 4, static_cast<std::uint64_t>(repeat)),
                                         options.fit.level};
        const double greatest_lapse = options.fit.greatest_lapse;
        const ResampledCurves of_a = resampled_curves(a, greatest_lapse, bootstrap);
        const ResampledCurves of_b = resampled_curves(b, greatest_lapse, bootstrap);
        const CurveIntervals ci = intervals_of(of_a, bootstrap.level);
        const OpenInterval ratio = bootstrap_jnd_ratio({a, of_a}, {b, of_b}, greatest_lapse, bootstrap);
        ++held.of;
        held.pse += holds(ci.pse, truth.pse) ? 1 : 0;
        held.sd += holds(ci.sd, truth.sd) ? 1 : 0;
        held.jnd_ratio += holds(ratio, 1.0) ? 1 : 0;
        held.open += ci.pse.closed() && ci.sd.closed() ? 0 : 1;
    }
    return held;
}

}  // namespace palpa::study
