#pragma once
// Observers whose psychometric functions are known, to measure how often the intervals of study/psychometric.h hold the
// true values.

#include <cstdint>
#include <vector>

#include "study/psychometric.h"
#include "study/psychometric_people.h"
#include "study/random.h"

namespace palpa::study {

// The levels of a protocol of forced choices with the paper's comparisons, 1.875 to 3.75 kPa against 1.75 kPa, each in
// both orders: ten levels x = ln(second/first), in order.
std::vector<double> paper_levels();

// `trials` answers, spread evenly over the levels; what is left over goes to the first levels.
std::vector<LevelAnswers> draw_answers(const std::vector<double>& levels, int trials, const PsychometricCurve& truth,
                                       Random& random);

// People differ: their PSE by a normal distribution, the logarithm of sd too. All have the lapse of the average person.
struct ObservedPeople {
    int n = 10;
    double pse_spread = 0.1;
    double log_sd_spread = 0.3;
};

struct ObserverOptions {
    PsychometricCurve truth{0.05, 0.257, 0.02};  // of the only observer, or of the average person
    int trials = 80;                             // of each observer, under each condition
    int repeats = 1000;                          // of the whole experiment
    std::uint64_t seed = 1;
    PsychometricOptions fit;
};

// How many of `of` intervals hold the true value. A missing limit holds every value.
struct Held {
    int pse = 0, sd = 0, jnd_ratio = 0;
    int of = 0;
    int open = 0, separated = 0;  // of the estimates whose intervals are counted
};

// One observer under two conditions with the same truth: profile-likelihood intervals of the first condition, and the
// interval of the ratio of both JNDs, whose true value is 1.
Held coverage_of_profiles(const ObserverOptions& options);

// Groups of people, each of whom does two conditions with one curve: intervals by bootstrap over people. The true PSE
// and sd of the group are those of the curve through the expected answers of very many people.
Held coverage_of_bootstrap(const ObserverOptions& options, const ObservedPeople& people, int resamples);

}  // namespace palpa::study
