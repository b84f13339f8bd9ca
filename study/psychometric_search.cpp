#include "study/psychometric_search.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace palpa::study {
namespace {

using Three = std::array<double, 3>;  // height, slope, lapse

constexpr double kFarthest_z = 37.0;  // beyond this the tail of the normal distribution has no digits left

struct Tails {
    double below, above;  // Phi(z) and 1 - Phi(z), each with all its digits
};

Tails tails_of(double z) {
    const double tail = 0.5 * std::erfc(std::abs(z) * std::numbers::sqrt2 / 2.0);
    return z < 0.0 ? Tails{tail, 1.0 - tail} : Tails{1.0 - tail, tail};
}

double z_at(const CurveSearch& search, const CurvePoint& point, double x) {
    return std::clamp(point.height + point.slope * (x - search.origin), -kFarthest_z, kFarthest_z);
}

// k ln p, and 0 for no answers, whatever their probability
double part(std::int64_t k, double p) { return k == 0 ? 0.0 : static_cast<double>(k) * std::log(p); }

// The slope of the log likelihood and the expected (Fisher) information at a point, by height, slope and lapse:
//
//     s = sum (k - n p) / (p q) dp        I = sum n / (p q) dp dp^T        dp = ((1 - 2 l) phi (1, x - origin), 1 - 2 Phi)
struct SearchScore {
    Three s{};
    std::array<Three, 3> information{};
};

SearchScore score_of(const CurveSearch& search, const CurvePoint& point) {
    SearchScore out;
    const double span = 1.0 - 2.0 * point.lapse;
    for (const LevelAnswers& level : search.levels) {
        const double z = z_at(search, point, level.x);
        const Tails tails = tails_of(z);
        const double p = point.lapse + span * tails.below, q = point.lapse + span * tails.above;
        const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
        const Three dp{span * density, span * density * (level.x - search.origin), tails.above - tails.below};
        const auto n = static_cast<double>(level.n), k = static_cast<double>(level.stiffer);
        const double off = k * q - (n - k) * p;  // k - n p
        for (std::size_t i = 0; i < 3; ++i) {
            out.s[i] += off / p * (dp[i] / q);
            for (std::size_t j = 0; j <= i; ++j) out.information[i][j] += n * (dp[i] / p) * (dp[j] / q);
        }
    }
    return out;
}

// Solves A d = s by Cholesky's factors for the coordinates that are free; the others stay where they are. Returns
// false if A is not positive definite to rounding.
bool solve(std::array<Three, 3> a, const Three& s, const std::array<bool, 3>& is_free, Three& d) {
    for (std::size_t i = 0; i < 3; ++i) {
        if (is_free[i]) continue;
        for (std::size_t j = 0; j < 3; ++j) (j <= i ? a[i][j] : a[j][i]) = i == j ? 1.0 : 0.0;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const double diagonal = a[i][i];
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = a[i][j];
            for (std::size_t k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
            if (i != j) {
                a[i][j] = sum / a[j][j];
                continue;
            }
            if (!(sum > 1e-14 * diagonal)) return false;
            a[i][i] = std::sqrt(sum);
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        d[i] = is_free[i] ? s[i] : 0.0;
        for (std::size_t k = 0; k < i; ++k) d[i] -= a[i][k] * d[k];
        d[i] /= a[i][i];
    }
    for (std::size_t i = 3; i-- > 0;) {
        for (std::size_t k = i + 1; k < 3; ++k) d[i] -= a[k][i] * d[k];
        d[i] /= a[i][i];
    }
    return true;
}

// Damps until the equations can be solved: where a coordinate tells nothing, its information is 0.
Three direction(const SearchScore& score, const std::array<bool, 3>& is_free) {
    Three d{};
    for (double damping = 0.0; damping < 1e6; damping = damping == 0.0 ? 1e-9 : 100.0 * damping) {
        std::array<Three, 3> a = score.information;
        for (std::size_t i = 0; i < 3; ++i) a[i][i] += damping * (a[i][i] + 1e-12);
        if (solve(a, score.s, is_free, d)) return d;
    }
    return {};
}

CurvePoint moved(const CurveSearch& search, const CurvePoint& from, const Three& d, double share) {
    CurvePoint to;
    to.height = from.height + share * d[0];
    to.slope = std::max(0.0, from.slope + share * d[1]);
    to.lapse = std::clamp(from.lapse + share * d[2], 0.0, search.greatest_lapse);
    to.log_likelihood = log_likelihood(search, to);
    return to;
}

}  // namespace

double log_likelihood(const CurveSearch& search, const CurvePoint& point) {
    double sum = 0.0;
    const double span = 1.0 - 2.0 * point.lapse;
    for (const LevelAnswers& level : search.levels) {
        const Tails tails = tails_of(z_at(search, point, level.x));
        sum += part(level.stiffer, point.lapse + span * tails.below) +
               part(level.n - level.stiffer, point.lapse + span * tails.above);
    }
    return sum;
}

CurvePoint climb(const CurveSearch& search, const CurvePoint& start) {
    constexpr int kMostSteps = 200;
    constexpr double kNoGain = 1e-20, kRounding = 1e-15;  // of the log likelihood, relative to it
    constexpr double kLittle = 1e-13;
    constexpr int kMostLittle = 4;  // gains in a row: enough to converge, and no endless way to a step
    int little = 0;
    CurvePoint at = start;
    at.log_likelihood = log_likelihood(search, at);
    for (int step = 0; step < kMostSteps; ++step) {
        const SearchScore score = score_of(search, at);
        const bool lapse_free = (at.lapse > 0.0 || score.s[2] > 0.0) &&
                                (at.lapse < search.greatest_lapse || score.s[2] < 0.0) && search.greatest_lapse > 0.0;
        const bool slope_free = search.slope_free && (at.slope > 0.0 || score.s[1] > 0.0);
        const Three d = direction(score, {search.height_free, slope_free, lapse_free});
        const double gain = d[0] * score.s[0] + d[1] * score.s[1] + d[2] * score.s[2];
        if (!(gain > kNoGain * (1.0 - at.log_likelihood))) break;
        const double least = at.log_likelihood - kRounding * (1.0 - at.log_likelihood);
        double share = 1.0;
        CurvePoint next = moved(search, at, d, share);
        while (!(next.log_likelihood >= least) && share > 1e-9) next = moved(search, at, d, share *= 0.5);
        if (!(next.log_likelihood >= least)) break;
        little = next.log_likelihood - at.log_likelihood < kLittle * (1.0 - at.log_likelihood) ? little + 1 : 0;
        at = next;
        if (little == kMostLittle) break;
    }
    return at;
}

Step likeliest_step(std::span<const LevelAnswers> levels, double greatest_lapse) {
    assert(!levels.empty());
    std::int64_t n = 0, below = 0, not_above = 0;  // stiffer below the step; not stiffer from the step up
    for (const LevelAnswers& level : levels) {
        n += level.n;
        not_above += level.n - level.stiffer;
    }
    Step best;
    best.log_likelihood = -std::numeric_limits<double>::infinity();
    const auto consider = [&](std::int64_t wrong, std::int64_t of, const LevelAnswers* at, double pse) {
        const double share = of > 0 ? static_cast<double>(wrong) / static_cast<double>(of) : 0.0;
        const double lapse = std::min(share, greatest_lapse);
        double sum = part(wrong, lapse) + part(of - wrong, 1.0 - lapse);
        if (at != nullptr) {
            const double p = static_cast<double>(at->stiffer) / static_cast<double>(at->n);
            if (p < lapse || p > 1.0 - lapse) return;  // then a step between levels is as likely
            sum += part(at->stiffer, p) + part(at->n - at->stiffer, 1.0 - p);
        }
        if (sum > best.log_likelihood) best = {sum, lapse, pse};
    };
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const LevelAnswers& level = levels[i];
        if (i > 0) consider(below + not_above, n, nullptr, 0.5 * (levels[i - 1].x + level.x));
        not_above -= level.n - level.stiffer;
        consider(below + not_above, n - level.n, &level, level.x);  // there, any probability that the lapse leaves
        below += level.stiffer;
    }
    return best;
}

double step_log_likelihood(std::span<const LevelAnswers> levels, double pse, double greatest_lapse) {
    std::int64_t wrong = 0, of = 0, at = 0;
    for (const LevelAnswers& level : levels) {
        if (level.x == pse) {
            at += level.n;
            continue;
        }
        wrong += level.x < pse ? level.stiffer : level.n - level.stiffer;
        of += level.n;
    }
    const double share = of > 0 ? static_cast<double>(wrong) / static_cast<double>(of) : 0.0;
    const double lapse = std::min(share, greatest_lapse);
    return part(wrong, lapse) + part(of - wrong, 1.0 - lapse) + part(at, 0.5);
}

double constant_log_likelihood(std::span<const LevelAnswers> levels, double low, double high) {
    std::int64_t n = 0, k = 0;
    for (const LevelAnswers& level : levels) {
        n += level.n;
        k += level.stiffer;
    }
    const double p = std::clamp(static_cast<double>(k) / static_cast<double>(n), low, high);
    return part(k, p) + part(n - k, 1.0 - p);
}

double saturated_log_likelihood(std::span<const LevelAnswers> levels) {
    double sum = 0.0;
    for (const LevelAnswers& level : levels) {
        const double p = static_cast<double>(level.stiffer) / static_cast<double>(level.n);
        sum += part(level.stiffer, p) + part(level.n - level.stiffer, 1.0 - p);
    }
    return sum;
}

}  // namespace palpa::study
