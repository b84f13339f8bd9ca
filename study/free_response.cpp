#include "study/free_response.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <set>

namespace palpa::study {
namespace {

constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();

double psi(double false_mark, double lesion) { return false_mark < lesion ? 1.0 : false_mark == lesion ? 0.5 : 0.0; }

double highest(const std::vector<double>& ratings) {
    return ratings.empty() ? kUnmarked : *std::max_element(ratings.begin(), ratings.end());
}

// How right the ratings of lesion case k are against a false mark: sum_l W_kl psi for the weights of this figure.
double rightness(const FreeResponseCase& one, const Reading& reading, Merit merit, double false_mark) {
    if (merit == Merit::hr_auc) return psi(false_mark, std::max(highest(reading.nl), highest(reading.ll)));
    double sum = 0.0;
    for (std::size_t l = 0; l < reading.ll.size(); ++l) {
        const double equal = 1.0 / static_cast<double>(reading.ll.size());
        const double weight = merit == Merit::afroc ? 1.0 : one.weights.empty() ? equal : one.weights[l];
        sum += weight * psi(false_mark, reading.ll[l]);
    }
    return sum;
}

// The cases that one person judged: those that give false marks, and those with lesions.
struct Judged {
    std::vector<std::size_t> rows, columns;
    std::vector<double> weight;  // of a column in the denominator
    double total_weight = 0.0;
};

Judged judged_cases(const FreeResponse& data, std::size_t condition, std::size_t participant, Merit merit) {
    Judged out;
    for (std::size_t k = 0; k < data.cases.size(); ++k) {
        if (!data.at(condition, participant, k)) continue;
        const std::size_t lesions = data.cases[k].lesions.size();
        if (lesions == 0 || merit == Merit::wafroc1) out.rows.push_back(k);
        if (lesions == 0) continue;
        out.columns.push_back(k);
        out.weight.push_back(merit == Merit::afroc ? static_cast<double>(lesions) : 1.0);
        out.total_weight += out.weight.back();
    }
    return out;
}

double ratio(double sum, double rows, double weight) {
    return rows > 0.5 && weight > 0.5 ? sum / (rows * weight) : kNoFigure;
}

struct CountedMarks {
    std::vector<double> nl, ll;  // ratings, highest first
    double cases = 0.0;
    double lesions = 0.0;
};

CountedMarks counted_marks(const FreeResponse& data, std::size_t condition, std::optional<std::size_t> participant) {
    CountedMarks out;
    for (std::size_t j = 0; j < data.participants.size(); ++j) {
        if (participant && *participant != j) continue;
        for (std::size_t k = 0; k < data.cases.size(); ++k) {
            const auto& reading = data.at(condition, j, k);
            if (!reading) continue;
            out.cases += 1.0;
            out.lesions += static_cast<double>(reading->ll.size());
            out.nl.insert(out.nl.end(), reading->nl.begin(), reading->nl.end());
            std::copy_if(reading->ll.begin(), reading->ll.end(), std::back_inserter(out.ll),
                         [](double rating) { return rating != kUnmarked; });
        }
    }
    std::sort(out.nl.begin(), out.nl.end(), std::greater<>());
    std::sort(out.ll.begin(), out.ll.end(), std::greater<>());
    return out;
}

double share_at_least(const std::vector<double>& falling, double rating, double of) {
    const auto end = std::upper_bound(falling.begin(), falling.end(), rating, std::greater<>());
    return of > 0.0 ? static_cast<double>(end - falling.begin()) / of : kNoFigure;
}

}  // namespace

const char* name_of(Merit merit) {
    constexpr const char* kNames[] = {"wafroc", "wafroc1", "afroc", "hr_auc"};
    return kNames[static_cast<int>(merit)];
}

MeritFigure merit_of(const FreeResponse& data, std::size_t condition, std::size_t participant, Merit merit) {
    const Judged judged = judged_cases(data, condition, participant, merit);
    const std::size_t n = data.cases.size();
    // what each case adds as a row, as a column, and as both at once: leaving it out subtracts these
    std::vector<double> by_row(n, 0.0), by_column(n, 0.0), by_both(n, 0.0);
    double sum = 0.0;
    for (const std::size_t i : judged.rows) {
        const double false_mark = highest(data.at(condition, participant, i)->nl);
        for (const std::size_t k : judged.columns) {
            const double s = rightness(data.cases[k], *data.at(condition, participant, k), merit, false_mark);
            sum += s;
            by_row[i] += s;
            by_column[k] += s;
            if (i == k) by_both[i] = s;
        }
    }
    const auto rows = static_cast<double>(judged.rows.size());
    MeritFigure out{ratio(sum, rows, judged.total_weight), std::vector<double>(n, kNoFigure)};
    for (const std::size_t i : judged.rows) out.without[i] = ratio(sum - by_row[i], rows - 1.0, judged.total_weight);
    for (std::size_t c = 0; c < judged.columns.size(); ++c) {
        const std::size_t k = judged.columns[c];
        const double left = merit == Merit::wafroc1 ? rows - 1.0 : rows;
        out.without[k] =
            ratio(sum - by_row[k] - by_column[k] + by_both[k], left, judged.total_weight - judged.weight[c]);
    }
    return out;
}

std::vector<FrocPoint> froc_curve(const FreeResponse& data, std::size_t condition,
                                  std::optional<std::size_t> participant) {
    const CountedMarks marks = counted_marks(data, condition, participant);
    std::set<double, std::greater<>> ratings(marks.nl.begin(), marks.nl.end());
    ratings.insert(marks.ll.begin(), marks.ll.end());
    std::vector<FrocPoint> curve;
    for (const double rating : ratings) {
        curve.push_back(
            {rating, share_at_least(marks.nl, rating, marks.cases), share_at_least(marks.ll, rating, marks.lesions)});
    }
    return curve;
}

double llf_at(const FreeResponse& data, std::size_t condition, std::optional<std::size_t> participant, double nlf) {
    assert(nlf >= 0.0);
    if (!(counted_marks(data, condition, participant).lesions > 0.0)) return kNoFigure;
    FrocPoint before;
    for (const FrocPoint& point : froc_curve(data, condition, participant)) {
        if (point.nlf > nlf) {
            const double part = (nlf - before.nlf) / (point.nlf - before.nlf);
            return before.llf + part * (point.llf - before.llf);
        }
        before = point;
    }
    return before.llf;
}

}  // namespace palpa::study
