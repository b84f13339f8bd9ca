#include "study/staircase.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

namespace palpa::study {
namespace {

constexpr int kPseSteps = 13;
constexpr double kGreatestPse = 0.6;
constexpr double kPseSpread = 0.2;
constexpr int kSdSteps = 41;
constexpr double kLeastSd = 0.02;
constexpr double kGreatestSd = 1.5;
constexpr double kLapses[] = {0.0, 0.02, 0.04};
constexpr double kJndOfSd = 0.6744897501960817;  // Phi(0.6745) = 0.75
constexpr double kEqualEntropy = 1e-9;           // nat: which of two such levels is taken may depend on the machine
constexpr int kFirstReversals = 2;               // on the way from the first level to the threshold
constexpr double kTail = 0.025;                  // of the posterior beyond each limit of the interval

double normal_share(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double difference_at(const StaircaseTask& task, int level) {
    return std::log(task.comparisons_kPa[static_cast<std::size_t>(level)] / task.reference_kPa);
}

std::vector<PosteriorPoint> prior() {
    std::vector<PosteriorPoint> out;
    double sum = 0.0;
    for (int i = 0; i < kPseSteps; ++i) {
        const double pse = kGreatestPse * (2.0 * i / (kPseSteps - 1) - 1.0);
        const double z = pse / kPseSpread;
        for (int j = 0; j < kSdSteps; ++j) {
            const double sd = kLeastSd * std::pow(kGreatestSd / kLeastSd, static_cast<double>(j) / (kSdSteps - 1));
            for (const double lapse : kLapses) {
                out.push_back({pse, sd, lapse, std::exp(-0.5 * z * z)});
                sum += out.back().weight;
            }
        }
    }
    for (PosteriorPoint& point : out) point.weight /= sum;
    return out;
}

double entropy_term(double weight) { return weight > 0.0 ? -weight * std::log(weight) : 0.0; }

// Expected entropy of the posterior after the next answer (Watson, equation 9): with w = prior weight times likelihood
// of an answer, and p their sum, the answer leaves an entropy of -sum w/p ln(w/p).
double expected_entropy(const std::vector<PosteriorPoint>& posterior, double difference, bool reference_first) {
    double p[2] = {0.0, 0.0};
    double terms[2] = {0.0, 0.0};
    for (const PosteriorPoint& point : posterior) {
        const double right = share_right(point, difference, reference_first);
        const double weights[2] = {point.weight * right, point.weight * (1.0 - right)};
        for (int answer = 0; answer < 2; ++answer) {
            p[answer] += weights[answer];
            terms[answer] += entropy_term(weights[answer]);
        }
    }
    double expected = 0.0;
    for (int answer = 0; answer < 2; ++answer) {
        if (p[answer] > 0.0) expected += terms[answer] + p[answer] * std::log(p[answer]);
    }
    return expected;
}

// Of each level.
std::vector<double> expected_entropies(const StaircaseTask& task, const std::vector<PosteriorPoint>& posterior,
                                       bool reference_first) {
    std::vector<double> out;
    for (int level = 0; level < static_cast<int>(task.comparisons_kPa.size()); ++level)
        out.push_back(expected_entropy(posterior, difference_at(task, level), reference_first));
    return out;
}

void learn(const StaircaseTask& task, const StaircaseAnswer& answer, std::vector<PosteriorPoint>& points) {
    const double difference = difference_at(task, answer.level);
    double sum = 0.0;
    for (PosteriorPoint& point : points) {
        const double right = share_right(point, difference, answer.reference_first);
        point.weight *= answer.correct ? right : 1.0 - right;
        sum += point.weight;
    }
    assert(sum > 0.0);  // a lapse is always possible
    for (PosteriorPoint& point : points) point.weight /= sum;
}

int moved(const StaircaseTask& task, int level, bool correct) {
    const int last = static_cast<int>(task.comparisons_kPa.size()) - 1;
    return std::clamp(correct ? level - 1 : level + task.steps_after_wrong, 0, last);
}

// The geometric mean level once the first reversals are over, on the way from the first level to the threshold.
void estimate_threshold(const StaircaseTask& task, const std::vector<StaircaseAnswer>& answers,
                        StaircaseEstimate& out) {
    out.target = task.steps_after_wrong / (task.steps_after_wrong + 1.0);
    const int last = static_cast<int>(task.comparisons_kPa.size()) - 1;
    int reversals = 0, n = 0, at_ends = 0;
    double sum = 0.0;
    for (std::size_t i = 1; i < answers.size(); ++i) {
        reversals += answers[i].correct != answers[i - 1].correct ? 1 : 0;
        if (reversals < kFirstReversals) continue;
        ++n;
        sum += difference_at(task, answers[i].level);
        at_ends += answers[i].level == (answers[i].correct ? 0 : last) ? 1 : 0;
    }
    if (out.reversals >= 2 * kFirstReversals) out.threshold = sum / n;
    if (!out.threshold || 10 * at_ends > n) out.status = "open";
}

// Returns the value of ln(sd) below which this share of the posterior lies, between the points of the grid.
double quantile_of(const std::vector<double>& log_sd, const std::vector<double>& weights, double share) {
    double below = 0.0;
    const double half = 0.5 * (log_sd[1] - log_sd[0]);
    for (std::size_t i = 0; i < log_sd.size(); ++i) {
        if (below + weights[i] >= share && weights[i] > 0.0)
            return log_sd[i] - half + 2.0 * half * (share - below) / weights[i];
        below += weights[i];
    }
    return log_sd.back() + half;
}

void estimate_jnd(const std::vector<PosteriorPoint>& posterior, StaircaseEstimate& out) {
    std::vector<double> log_sd, weights;
    for (int j = 0; j < kSdSteps; ++j) {
        log_sd.push_back(std::log(kLeastSd) + j * std::log(kGreatestSd / kLeastSd) / (kSdSteps - 1));
        weights.push_back(0.0);
    }
    for (std::size_t i = 0; i < posterior.size(); ++i)
        weights[i / std::size(kLapses) % static_cast<std::size_t>(kSdSteps)] += posterior[i].weight;
    const double mean = std::inner_product(log_sd.begin(), log_sd.end(), weights.begin(), 0.0);
    const double low = quantile_of(log_sd, weights, kTail), high = quantile_of(log_sd, weights, 1.0 - kTail);
    out.jnd = kJndOfSd * std::exp(mean);
    out.jnd_low = kJndOfSd * std::exp(low);
    out.jnd_high = kJndOfSd * std::exp(high);
    // the tails of the flat prior end 1.025 cells from the ends, and these points lie 1.5 cells from them
    if (low <= log_sd[1] || high >= log_sd[log_sd.size() - 2]) out.status = "open";
}

}  // namespace

double share_right(const PosteriorPoint& point, double difference, bool reference_first) {
    const double x = reference_first ? difference : -difference;  // ln(second / first)
    const double second = point.lapse + (1.0 - 2.0 * point.lapse) * normal_share((x - point.pse) / point.sd);
    return x > 0.0 ? second : 1.0 - second;
}

int next_level(const StaircaseTask& task, const std::vector<StaircaseAnswer>& answers, bool reference_first) {
    if (task.method == StaircaseMethod::quest_plus) {
        const std::vector<double> entropies = expected_entropies(task, posterior_of(task, answers), reference_first);
        return static_cast<int>(std::min_element(entropies.begin(), entropies.end()) - entropies.begin());
    }
    return answers.empty() ? task.start : moved(task, answers.back().level, answers.back().correct);
}

int answers_at_other_levels(const StaircaseTask& task, const std::vector<StaircaseAnswer>& answers) {
    int others = 0, asked = task.start;
    std::vector<PosteriorPoint> posterior = prior();
    for (const StaircaseAnswer& answer : answers) {
        if (task.method == StaircaseMethod::weighted_up_down) {
            others += answer.level != asked ? 1 : 0;
            asked = moved(task, answer.level, answer.correct);
            continue;
        }
        const std::vector<double> entropies = expected_entropies(task, posterior, answer.reference_first);
        const double least = *std::min_element(entropies.begin(), entropies.end());
        others += entropies[static_cast<std::size_t>(answer.level)] > least + kEqualEntropy ? 1 : 0;
        learn(task, answer, posterior);
    }
    return others;
}

std::vector<PosteriorPoint> posterior_of(const StaircaseTask& task, const std::vector<StaircaseAnswer>& answers) {
    std::vector<PosteriorPoint> points = prior();
    for (const StaircaseAnswer& answer : answers) learn(task, answer, points);
    return points;
}

StaircaseEstimate estimate_of(const StaircaseTask& task, const std::vector<StaircaseAnswer>& answers) {
    StaircaseEstimate out;
    out.status = "ok";
    out.trials = static_cast<int>(answers.size());
    for (std::size_t i = 1; i < answers.size(); ++i)
        out.reversals += answers[i].correct != answers[i - 1].correct ? 1 : 0;
    estimate_jnd(posterior_of(task, answers), out);
    if (task.method == StaircaseMethod::weighted_up_down) estimate_threshold(task, answers, out);
    return out;
}

double percent_of(double difference) { return 100.0 * std::expm1(difference); }

}  // namespace palpa::study
