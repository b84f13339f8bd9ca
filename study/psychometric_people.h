#pragma once
// Psychometric functions of several people: bootstrap over people, since the answers of one person are not independent.

#include <span>
#include <vector>

#include "study/bootstrap.h"
#include "study/psychometric.h"

namespace palpa::study {

// The answers of one person under one condition, as merged_levels() returns them; empty if the person did not take part.
using PersonAnswers = std::vector<LevelAnswers>;

// All answers together.
std::vector<LevelAnswers> pooled_answers(std::span<const PersonAnswers> people);

// Percentile intervals of the curve through the pooled answers of people drawn with replacement. The percentiles are
// farther out than those of the level, so that few people get intervals as wide as Student's t gives a mean:
//
//     tail = Phi(-t sqrt(n / (n - 1)))          t: the two-sided quantile of Student's t with n - 1 degrees of freedom
//
// Source: Hesterberg, The American Statistician 69 (2015) 371, "expanded percentile". A limit is missing where the
// percentile is a resample without an estimate. Both intervals lack both limits with fewer than two people.
struct CurveIntervals {
    OpenInterval pse, sd;
};

// The curves of all resamples of the people who took part, as likeliest_curve() returns them.
struct ResampledCurves {
    std::vector<std::size_t> people;
    std::vector<double> pse, sd;
};
ResampledCurves resampled_curves(std::span<const PersonAnswers> people, double greatest_lapse,
                                 const BootstrapOptions& options);
CurveIntervals intervals_of(const ResampledCurves& curves, double level);

// The same for the ratio of the JNDs of two conditions, sd_a / sd_b; entry i of both spans belongs to the same person.
// People of both conditions, of a only and of b only are resampled separately, as in bootstrap_difference(). Where the
// same people did both, the resamples in `curves` are used, which must be from the same seed.
struct Resampled {
    std::span<const PersonAnswers> people;
    const ResampledCurves& curves;
};
OpenInterval bootstrap_jnd_ratio(const Resampled& of_a, const Resampled& of_b, double greatest_lapse,
                                 const BootstrapOptions& options);

// The ratio of two JNDs whose answers are independent, from their two intervals: the arms of ln(sd) that face each
// other, squared and summed. Source: Donner & Zou, Statistical Methods in Medical Research 21 (2012) 347.
OpenInterval independent_jnd_ratio(const PsychometricFit& a, const PsychometricFit& b);

}  // namespace palpa::study
