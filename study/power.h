#pragma once
// How often the tests of a report reject, and how often its intervals hold the true value, over many simulated studies.

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "files/json.h"
#include "study/report.h"

namespace palpa::study {

// One test, one interval, or both, of one report. What the report does not have is NaN.
// The people of all groups are simulated alike, so that a comparison of groups tells the type I error at every effect.
inline constexpr const char* kSameGroups = "type I error: simulated groups do not differ";

struct Finding {
    std::string quantity;  // sensitivity, ppv, correct, a figure of merit, or log odds
    std::string a, b;      // conditions or groups; b empty: of a alone
    std::string method;    // t, permutation, bootstrap, Wilson, ...
    // replication or ignores clustering, as in the report; kSameGroups; empty for what should keep its level and has power
    std::string label;
    double p = std::numeric_limits<double>::quiet_NaN();
    double estimate = std::numeric_limits<double>::quiet_NaN();  // of what `ci` is an interval of
    Interval ci{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};

    bool has_interval() const { return ci.low == ci.low; }
};

// The primary comparison (method "primary"), all pairs of sensitivity, PPV and right choices, shares of each condition,
// comparisons of groups, Obuchowski and Rockette's tests, and likelihood-ratio tests of the mixed model. Psychometric functions
// are left to `palpa study observers`.
std::vector<Finding> findings_of(const Report& report);

// A finding of one simulated study.
struct PowerRow {
    double effect = 0.0;  // 0: the null hypothesis
    double noise = 1.0;   // factor on the noise of the eye
    int participants = 0;
    Finding finding;
};

// How often something happened in n studies, with its Monte Carlo error: the standard error of the rate, and Wilson's 95 %
// interval, which is not empty at 0 and 1 either.
struct PowerShare {
    std::int64_t hits = 0;
    std::int64_t n = 0;
    double rate() const { return n > 0 ? static_cast<double>(hits) / static_cast<double>(n) : std::nan(""); }
    double standard_error() const;
    Interval interval() const;
};

struct PowerResult {
    double effect = 0.0;
    double noise = 1.0;
    int participants = 0;
    Finding what;             // without numbers
    PowerShare rejections{};  // of the studies; a test that cannot be computed does not reject. n = 0: no test
    std::int64_t tested = 0;  // studies in which the test could be computed
    PowerShare coverage{};    // of the studies with an interval. n = 0: none, or the true value is not known
    double mean_estimate = 0.0;
    double truth = 0.0;     // NaN: not known
    double truth_se = 0.0;  // its Monte Carlo error; 0: known exactly
};

// `studies`: how many were simulated for each effect, noise and number of participants. `alpha`: rejected is p < alpha.
//
// True values: 0 for differences without an effect, which is exact. Else the mean estimate over all studies with the greatest
// number of participants, whose error is smaller than that of one study by the root of their number. Log odds ratios have
// none, since simulated people do not follow the mixed model. The results are sorted by effect, noise and participants.
std::vector<PowerResult> summarise_power(const std::vector<PowerRow>& rows, std::int64_t studies, double alpha);

files::Json power_json(const std::vector<PowerResult>& results);
ReportTable power_table(const std::vector<PowerResult>& results);
files::Json power_dictionary();  // of power_table()

}  // namespace palpa::study
