#include "study/obuchowski_rockette.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "files/distributions.h"

namespace palpa::study {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

double sq(double x) { return x * x; }

// The jackknife's covariance of two series of figures with one case left out.
double jackknife_covariance(const std::vector<double>& a, const std::vector<double>& b) {
    const auto n = static_cast<double>(a.size());
    double mean_a = 0.0, mean_b = 0.0, sum = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        mean_a += a[k] / n;
        mean_b += b[k] / n;
    }
    for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - mean_a) * (b[k] - mean_b);
    return (n - 1.0) / n * sum;
}

struct MeanOf {
    double sum = 0.0;
    int n = 0;
    void add(double x) {
        sum += x;
        ++n;
    }
    double mean() const { return n > 0 ? sum / n : 0.0; }
};

struct Covariances {
    MeanOf var, cov1, cov2, cov3;
    std::vector<MeanOf> cov2_of;  // by condition
};

Covariances covariances_of(const MeritTable& table) {
    Covariances out;
    out.cov2_of.resize(table.conditions);
    const std::size_t n = table.theta.size(), people = table.participants;
    for (std::size_t x = 0; x < n; ++x) {
        for (std::size_t y = x; y < n; ++y) {
            const double c = jackknife_covariance(table.without[x], table.without[y]);
            const bool same_condition = x / people == y / people, same_person = x % people == y % people;
            if (x == y) {
                out.var.add(c);
            } else if (same_person) {
                out.cov1.add(c);
            } else if (same_condition) {
                out.cov2.add(c);
                out.cov2_of[x / people].add(c);
            } else {
                out.cov3.add(c);
            }
        }
    }
    return out;
}

struct Means {
    std::vector<double> condition, participant;
    double all = 0.0;
};

Means means_of(const MeritTable& table) {
    Means out{std::vector<double>(table.conditions, 0.0), std::vector<double>(table.participants, 0.0), 0.0};
    const auto conditions = static_cast<double>(table.conditions), people = static_cast<double>(table.participants);
    for (std::size_t i = 0; i < table.conditions; ++i) {
        for (std::size_t j = 0; j < table.participants; ++j) {
            const double theta = table.theta[i * table.participants + j];
            out.condition[i] += theta / people;
            out.participant[j] += theta / conditions;
            out.all += theta / (conditions * people);
        }
    }
    return out;
}

MeritComponents components_of(const MeritTable& table, const Means& means, const Covariances& covariances) {
    MeritComponents out{covariances.var.mean(), covariances.cov1.mean(), covariances.cov2.mean(),
                        covariances.cov3.mean()};
    const auto conditions = static_cast<double>(table.conditions), people = static_cast<double>(table.participants);
    for (std::size_t i = 0; i < table.conditions; ++i) {
        out.ms_t += people * sq(means.condition[i] - means.all) / (conditions - 1.0);
        for (std::size_t j = 0; j < table.participants; ++j) {
            const double theta = table.theta[i * table.participants + j];
            out.ms_tr += sq(theta - means.condition[i] - means.participant[j] + means.all) /
                         ((conditions - 1.0) * (people - 1.0));
        }
    }
    return out;
}

// Rounding leaves squares of some 1e-32 where figures are equal; figures lie between 0 and 1.
bool is_nothing(double variance) { return !(variance > 1e-24); }

Interval interval_of(double mean, double se, double df, double level) {
    const double q =
        std::isfinite(df) ? files::student_quantile(level, df) : files::normal_quantile(0.5 * (1.0 + level));
    return {mean - q * se, mean + q * se};
}

double p_of_t(double t, double df) {
    return std::isfinite(df) ? files::student_p(t, df) : 2.0 * files::normal_probability(-std::abs(t));
}

MeritOfCondition of_condition(const MeritTable& table, const Means& means, const Covariances& covariances,
                              std::size_t i, double level) {
    const auto people = static_cast<double>(table.participants);
    double ms_r = 0.0;
    for (std::size_t j = 0; j < table.participants; ++j)
        ms_r += sq(table.theta[i * table.participants + j] - means.condition[i]) / (people - 1.0);
    const double scaled = ms_r + std::max(people * covariances.cov2_of[i].mean(), 0.0);
    MeritOfCondition out{means.condition[i], kNoValue, kNoValue, {kNoValue, kNoValue}};
    if (is_nothing(scaled)) return out;
    out.se = std::sqrt(scaled / people);
    out.df = is_nothing(ms_r) ? std::numeric_limits<double>::infinity() : sq(scaled) / (sq(ms_r) / (people - 1.0));
    out.ci = interval_of(out.mean, out.se, out.df, level);
    return out;
}

void compare_pairs(const Means& means, double se, double level, MeritTest& out) {
    for (std::size_t a = 0; a < means.condition.size(); ++a) {
        for (std::size_t b = a + 1; b < means.condition.size(); ++b) {
            MeritPair pair{a, b, means.condition[a] - means.condition[b], se, kNoValue, kNoValue, {kNoValue, kNoValue}};
            if (std::isfinite(se)) {
                pair.t = pair.difference / se;
                pair.p = p_of_t(pair.t, out.ddf);
                pair.ci = interval_of(pair.difference, se, out.ddf, level);
            }
            out.pairs.push_back(pair);
        }
    }
}

std::string why_not(const MeritTable& table) {
    const std::string cannot = "cannot be computed, because ";
    if (table.participants < 2) return cannot + "there are fewer than two participants";
    const auto known = [](double x) { return std::isfinite(x); };
    if (!std::all_of(table.theta.begin(), table.theta.end(), known))
        return cannot + "the figure needs cases that are not there";
    for (const auto& series : table.without) {
        if (series.empty() || !std::all_of(series.begin(), series.end(), known))
            return cannot + "the jackknife needs two cases of each kind: with one left out, one must remain";
    }
    return "";
}

}  // namespace

MeritTest test_merits(const MeritTable& table, double level) {
    MeritTest out;
    out.f = out.ddf = out.p = kNoValue;
    out.ndf = static_cast<double>(table.conditions) - 1.0;
    const Means means = means_of(table);
    out.status = why_not(table);
    if (!out.status.empty()) {
        out.conditions.assign(table.conditions, {0.0, kNoValue, kNoValue, {kNoValue, kNoValue}});
        for (std::size_t i = 0; i < table.conditions; ++i) out.conditions[i].mean = means.condition[i];
        compare_pairs(means, kNoValue, level, out);
        return out;
    }
    const Covariances covariances = covariances_of(table);
    for (std::size_t i = 0; i < table.conditions; ++i)
        out.conditions.push_back(of_condition(table, means, covariances, i, level));
    if (table.conditions < 2) {
        out.status = "cannot be computed, because there is one condition only";
        return out;
    }
    out.components = components_of(table, means, covariances);
    const auto people = static_cast<double>(table.participants);
    const MeritComponents& c = out.components;
    const double den = c.ms_tr + std::max(people * (c.cov2 - c.cov3), 0.0);
    const double products = out.ndf * (people - 1.0);
    double se = kNoValue;
    if (is_nothing(den)) {
        out.status = "cannot be computed, because the figures vary neither over people nor over cases";
    } else {
        out.f = c.ms_t / den;
        out.ddf = is_nothing(c.ms_tr) ? std::numeric_limits<double>::infinity() : sq(den) / (sq(c.ms_tr) / products);
        out.p = files::f_distribution_p(out.f, out.ndf, out.ddf);
        se = std::sqrt(2.0 * den / people);
    }
    compare_pairs(means, se, level, out);
    return out;
}

}  // namespace palpa::study
