#pragma once
// Tests of figures of merit over random people and random cases, by the method of Obuchowski and Rockette with the
// covariances of the jackknife over cases. Source: Obuchowski & Rockette, Commun. Statist. Simul. 24 (1995) 285; Hillis,
// Statist. Med. 26 (2007) 596 for the degrees of freedom.

#include <cstddef>
#include <string>
#include <vector>

#include "study/statistics.h"

namespace palpa::study {

// I conditions, J participants, K cases; everybody judged every case under every condition.
struct MeritTable {
    std::size_t conditions = 0;
    std::size_t participants = 0;
    std::vector<double> theta;                 // [condition][participant]
    std::vector<std::vector<double>> without;  // [condition][participant][case]: the figure without that case
};

// With C(ij, i'j') = (K-1)/K sum_k (theta_ij(k) - mean)(theta_i'j'(k) - mean): var is the mean of C(ij, ij), cov1 with
// i != i' and j = j', cov2 with i = i' and j != j', cov3 with both different.
struct MeritComponents {
    double var = 0.0, cov1 = 0.0, cov2 = 0.0, cov3 = 0.0;
    double ms_t = 0.0;   // J sum (theta_i. - theta_..)^2 / (I-1)
    double ms_tr = 0.0;  // sum (theta_ij - theta_i. - theta_.j + theta_..)^2 / ((I-1)(J-1))
};

// theta_i., with SE = sqrt((MS_R(i) + max(J cov2(i), 0))/J) and df = (J SE^2)^2 / (MS_R(i)^2/(J-1)).
struct MeritOfCondition {
    double mean = 0.0;
    double se = 0.0;
    double df = 0.0;
    Interval ci;
};

struct MeritPair {
    std::size_t a = 0, b = 0;  // indices of the conditions
    double difference = 0.0;   // a - b
    double se = 0.0;           // sqrt(2 den / J)
    double t = 0.0;
    double p = 1.0;  // two-sided, of t with ddf
    Interval ci;
};

// F = MS_T / den with den = MS_TR + max(J (cov2 - cov3), 0), ndf = I-1, ddf = den^2 / (MS_TR^2/((I-1)(J-1))). What cannot
// be computed is NaN, and `status` says why. An infinite ddf (MS_TR is 0) is kept.
struct MeritTest {
    MeritComponents components;
    std::vector<MeritOfCondition> conditions;
    double f = 0.0;
    double ndf = 0.0;
    double ddf = 0.0;
    double p = 1.0;
    std::vector<MeritPair> pairs;  // all pairs of conditions
    std::string status;            // empty, or "cannot be computed, because ..."
};

MeritTest test_merits(const MeritTable& table, double level);

}  // namespace palpa::study
