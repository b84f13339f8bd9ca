#include "study/psychometric.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "study/psychometric_search.h"
#include "study/statistics.h"

namespace palpa::study {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kAsLikely = 1e-7;  // difference of log likelihoods that only rounding and slow ends make
constexpr double kJndPerSd = 0.674489750196081743;  // Phi(0.6745) = 3/4

double range_of(std::span<const LevelAnswers> levels) { return levels.back().x - levels.front().x; }

// Keeps the `N` likeliest of many points as starts. The rest is not climbed from.
template <std::size_t N>
struct Starts {
    std::array<CurvePoint, N> points;
    std::size_t n = 0;
    void offer(const CurvePoint& point) {
        if (n < N) {
            points[n++] = point;
        } else {
            const auto worst = std::min_element(
                points.begin(), points.end(),
                [](const CurvePoint& a, const CurvePoint& b) { return a.log_likelihood < b.log_likelihood; });
            if (point.log_likelihood > worst->log_likelihood) *worst = point;
        }
    }
};

void offer(const CurveSearch& search, CurvePoint point, auto& starts) {
    point.log_likelihood = log_likelihood(search, point);
    starts.offer(point);
}

CurvePoint best_climb(const CurveSearch& search, const auto& starts) {
    CurvePoint best;
    best.log_likelihood = -kInfinity;
    for (std::size_t i = 0; i < starts.n; ++i) {
        const CurvePoint top = climb(search, starts.points[i]);
        if (top.log_likelihood > best.log_likelihood) best = top;
    }
    return best;
}

std::array<double, 2> lapses_of(double greatest) { return {0.2 * greatest, greatest}; }

constexpr double kSteepest = 40.0;  // 1 / sd of a start, per range of x
constexpr double kFlattest = 0.2;
constexpr int kSlopes = 9;  // in a geometric row between them
double slope_of_row(int i) {
    return kFlattest * std::pow(kSteepest / kFlattest, static_cast<double>(i) / (kSlopes - 1));
}

// Where curves may have their PSE, four in each gap between levels, so that none much steeper than a gap is passed over, and
// some beyond all levels.
std::vector<double> places_of(std::span<const LevelAnswers> levels) {
    constexpr int kInGap = 4;
    std::vector<double> places;
    for (std::size_t i = 1; i < levels.size(); ++i) {
        for (int k = 0; k < kInGap; ++k)
            places.push_back(levels[i - 1].x + (levels[i].x - levels[i - 1].x) * k / kInGap);
    }
    for (const double beyond : {0.0, 0.15, 0.4}) {
        places.push_back(levels.back().x + beyond * range_of(levels));
        if (beyond > 0.0) places.push_back(levels.front().x - beyond * range_of(levels));
    }
    return places;
}

// The likeliest curve of all: there may be several tops, of which the steep ones are narrow, so that one climb begins at
// each of a row of slopes, from the likeliest place and lapse with that slope; or from one start.
CurvePoint likeliest(std::span<const LevelAnswers> levels, double greatest_lapse,
                     const std::optional<PsychometricCurve>& start) {
    const double range = range_of(levels);
    CurveSearch search{levels, greatest_lapse, 0.5 * (levels.front().x + levels.back().x)};
    CurvePoint best;
    if (start) {
        best = climb(search, {(search.origin - start->pse) / start->sd, 1.0 / start->sd, start->lapse});
    } else {
        best.log_likelihood = -kInfinity;
        const std::vector<double> places = places_of(levels);
        for (int i = 0; i < kSlopes; ++i) {
            const double slope = slope_of_row(i) / range;
            Starts<1> starts;
            for (const double place : places) {
                for (const double lapse : lapses_of(greatest_lapse))
                    offer(search, {slope * (search.origin - place), slope, lapse}, starts);
            }
            const CurvePoint top = best_climb(search, starts);
            if (top.log_likelihood > best.log_likelihood) best = top;
        }
    }
    best.height -= best.slope * search.origin;  // about an origin at 0
    return best;
}

// Profile log likelihoods of one set of answers: the greatest with one parameter held. Each climb begins where the one
// before ended, since limits are reached in small steps; `thorough` ones begin at a grid of places, too, since there may
// be several tops. Any curve that is likelier than the likeliest so far is remembered.
struct Profiles {
    std::span<const LevelAnswers> levels;
    double greatest_lapse;
    CurvePoint best;  // about an origin at 0
    double last_pse, last_slope, last_lapse;

    Profiles(std::span<const LevelAnswers> all, double greatest, const CurvePoint& top)
        : levels(all), greatest_lapse(greatest), best(top) {
        start_at_best();
    }

    void start_at_best() {
        last_slope = best.slope;
        last_pse = best.slope > 0.0 ? -best.height / best.slope : levels.front().x + 0.5 * range_of(levels);
        last_lapse = best.lapse;
    }

    double of_slope(double slope, bool thorough) {
        CurveSearch search{levels, greatest_lapse, 0.0, true, false};
        Starts<3> starts;
        offer(search, {-slope * last_pse, slope, last_lapse}, starts);
        constexpr int kPlaces = 12;
        for (int i = 0; thorough && i <= kPlaces; ++i) {
            const double place = levels.front().x + range_of(levels) * i / kPlaces;
            for (const double lapse : lapses_of(greatest_lapse)) offer(search, {-slope * place, slope, lapse}, starts);
        }
        return remember(best_climb(search, starts), 0.0);
    }

    double of_pse(double pse, bool thorough) {
        CurveSearch search{levels, greatest_lapse, pse, false, true};
        Starts<3> starts;
        offer(search, {0.0, last_slope, last_lapse}, starts);
        for (int i = 0; thorough && i < kSlopes; ++i) {
            const double slope = slope_of_row(i) / range_of(levels);
            for (const double lapse : lapses_of(greatest_lapse)) offer(search, {0.0, slope, lapse}, starts);
        }
        const double climbed = remember(best_climb(search, starts), pse);
        // curves much steeper than all starts may be likelier; a climb seldom comes so far
        return std::max(climbed, step_log_likelihood(levels, pse, greatest_lapse));
    }

  private:
    double remember(CurvePoint point, double origin) {
        point.height -= point.slope * origin;
        if (point.log_likelihood > best.log_likelihood) best = point;
        last_slope = point.slope;
        last_lapse = point.lapse;
        if (point.slope > 0.0) last_pse = -point.height / point.slope;
        return point.log_likelihood;
    }
};

// Finds where `height` falls through 0 on the way from `inside`, where it is above 0, in steps that double, then by
// false position, since it is almost linear (with the halving of the Illinois rule: Dowell & Jarratt, BIT 11 (1971)
// 168).
template <class Height>
double crossing(double inside, double step, double tolerance, Height&& height) {
    double a = inside, f_a = height(a);
    double b = a, f_b = f_a;
    for (int i = 0; i < 60 && f_b > 0.0; ++i) {
        a = b;
        f_a = f_b;
        b += step;
        step *= 2.0;
        f_b = height(b);
    }
    constexpr double kAtZero = 1e-8;
    for (int i = 0; i < 100 && std::abs(b - a) > tolerance && std::abs(f_b) > kAtZero; ++i) {
        const bool halve = i % 8 == 7;  // where the profile jumps
        const double at = halve || f_a == f_b ? 0.5 * (a + b) : (a * f_b - b * f_a) / (f_b - f_a);
        const double f = height(at);
        if ((f > 0.0) == (f_b > 0.0)) {
            f_a *= 0.5;
        } else {
            a = b;
            f_a = f_b;
        }
        b = at;
        f_b = f;
    }
    return b;
}

// Returns the place beyond `inside` where `profile` falls to `least`. The square root of its fall is almost linear in
// the place. A thorough look that finds the place inside after all goes on from there.
template <class Profile>
double limit(double inside, double step, double greatest, double least, double tolerance, Profile&& profile) {
    bool thorough = false;
    const auto height = [&](double at) {
        return std::sqrt(greatest - least) - std::sqrt(std::max(0.0, greatest - profile(at, thorough)));
    };
    double at = inside;
    constexpr double kInside = 1e-6;
    for (int round = 0; round < 4; ++round) {
        at = crossing(at, step, tolerance, height);
        thorough = true;
        if (height(at) < kInside) break;
    }
    return at;
}

// u = ln sd of the steepest and the flattest curve that the answers do not exclude, out of a row below `until`. The row
// begins near the likeliest step, at an sd far below the distances of the levels, since the profile may leave the interval
// and come back.
struct RowEnds {
    std::optional<double> steepest, flattest;
};
RowEnds row_inside(Profiles& profiles, double least, const Step& step, double until) {
    const std::span<const LevelAnswers> levels = profiles.levels;
    double closest = range_of(levels);
    for (std::size_t i = 1; i < levels.size(); ++i) closest = std::min(closest, levels[i].x - levels[i - 1].x);
    constexpr double kStep = 0.3;
    profiles.last_pse = step.pse;
    profiles.last_lapse = step.lapse;
    RowEnds ends;
    for (double u = std::log(std::min(1e-3 * range_of(levels), 0.05 * closest)); u < until; u += kStep) {
        if (profiles.of_slope(std::exp(-u), true) < least) continue;
        if (!ends.steepest) ends.steepest = u;
        ends.flattest = u;
    }
    return ends;
}

// The interval of sd: of u = ln sd = -ln slope, in which the profile is most nearly a parabola.
OpenInterval sd_interval(Profiles& profiles, double greatest, double least, const Step& step) {
    const double range = range_of(profiles.levels);
    const bool has_sd = profiles.best.slope > 0.0;
    const auto profile = [&](double u, bool thorough) { return profiles.of_slope(std::exp(-u), thorough); };
    constexpr double kStep = 0.3, kTolerance = 1e-8;
    OpenInterval ci;
    const double constant = constant_log_likelihood(profiles.levels, 0.0, 1.0);  // whatever the lapse: sd is infinite
    // beyond one of the row, from the step's place on
    const auto limit_of_row = [&](double inside, double towards) {
        profiles.last_pse = step.pse;
        profiles.of_slope(std::exp(-inside), true);
        return std::exp(limit(inside, towards, greatest, least, kTolerance, profile));
    };
    const bool from_step = greatest - step.log_likelihood <= kAsLikely;
    if (from_step) {
        const std::optional<double> inside = row_inside(profiles, least, step, std::log(10.0 * range)).flattest;
        if (constant < least && inside) ci.high = limit_of_row(*inside, kStep);
        return ci;
    }
    const double u = has_sd ? -std::log(profiles.best.slope) : std::log(1e3 * range);
    profiles.start_at_best();
    if (step.log_likelihood < least) {
        ci.low = std::exp(limit(u, -kStep, greatest, least, kTolerance, profile));
        const std::optional<double> steepest = row_inside(profiles, least, step, std::log(*ci.low)).steepest;
        if (steepest) ci.low = limit_of_row(*steepest, -kStep);
    }
    profiles.start_at_best();
    if (constant < least) ci.high = std::exp(limit(u, kStep, greatest, least, kTolerance, profile));
    return ci;
}

OpenInterval pse_interval(Profiles& profiles, double pse, double greatest, double least) {
    const double range = range_of(profiles.levels);
    const auto profile = [&](double at, bool thorough) { return profiles.of_pse(at, thorough); };
    const double step = 0.1 * range, tolerance = 1e-9 * range;
    OpenInterval ci;
    profiles.start_at_best();
    // far below all levels all are called stiffer with one probability, of one half or more
    if (constant_log_likelihood(profiles.levels, 0.5, 1.0) < least)
        ci.low = limit(pse, -step, greatest, least, tolerance, profile);
    profiles.start_at_best();
    if (constant_log_likelihood(profiles.levels, 0.0, 0.5) < least)
        ci.high = limit(pse, step, greatest, least, tolerance, profile);
    return ci;
}

}  // namespace

std::vector<LevelAnswers> merged_levels(std::vector<LevelAnswers> levels) {
    constexpr double kSame = 1e-9;
    std::erase_if(levels, [](const LevelAnswers& level) { return level.n == 0; });
    std::sort(levels.begin(), levels.end(), [](const LevelAnswers& a, const LevelAnswers& b) { return a.x < b.x; });
    std::vector<LevelAnswers> out;
    for (const LevelAnswers& level : levels) {
        if (out.empty() || level.x - out.back().x > kSame) {
            out.push_back(level);
        } else {
            out.back().stiffer += level.stiffer;
            out.back().n += level.n;
        }
    }
    return out;
}

double probability_stiffer(double x, const PsychometricCurve& curve) {
    const double z = (x - curve.pse) / curve.sd;
    return curve.lapse + (1.0 - 2.0 * curve.lapse) * 0.5 * std::erfc(-z / std::sqrt(2.0));
}

double log_likelihood(std::span<const LevelAnswers> levels, const PsychometricCurve& curve) {
    const CurveSearch search{levels, 0.5, curve.pse};
    return log_likelihood(search, {0.0, 1.0 / curve.sd, curve.lapse});
}

double jnd_of_sd(double sd) { return kJndPerSd * sd; }
double jnd_percent_of_sd(double sd) { return 100.0 * std::expm1(jnd_of_sd(sd)); }

const char* name_of(FitStatus status) {
    constexpr const char* kNames[] = {"ok", "open", "separated"};
    return kNames[static_cast<int>(status)];
}

PsychometricCurve likeliest_curve(std::span<const LevelAnswers> levels, double greatest_lapse,
                                  const std::optional<PsychometricCurve>& start) {
    assert(levels.size() >= 2);
    const Step step = likeliest_step(levels, greatest_lapse);
    const CurvePoint top = likeliest(levels, greatest_lapse, start);
    const double constant = constant_log_likelihood(levels, 0.0, 1.0);
    if (constant >= std::max(top.log_likelihood, step.log_likelihood) - kAsLikely) return {kNaN, kInfinity, 0.0};
    if (step.log_likelihood >= top.log_likelihood - kAsLikely) return {kNaN, 0.0, step.lapse};
    return {-top.height / top.slope, 1.0 / top.slope, top.lapse};
}

PsychometricFit fit_psychometric(std::span<const LevelAnswers> levels, const PsychometricOptions& options) {
    assert(levels.size() >= 2);
    PsychometricFit fit;
    const double z = z_of_level(options.level);
    const Step step = likeliest_step(levels, options.greatest_lapse);
    const double constant = constant_log_likelihood(levels, 0.0, 1.0);
    Profiles profiles(levels, options.greatest_lapse, likeliest(levels, options.greatest_lapse, std::nullopt));
    // a profile that finds a likelier curve than the one it belongs to begins everything anew from there
    for (int round = 0; round < 3; ++round) {
        const CurvePoint top = profiles.best;
        const double greatest = std::max({top.log_likelihood, step.log_likelihood, constant});
        const double least = greatest - 0.5 * z * z;
        fit = {};
        fit.log_likelihood = greatest;
        fit.deviance = std::max(0.0, 2.0 * (saturated_log_likelihood(levels) - greatest));
        fit.rises = constant < greatest - kAsLikely;
        const bool separated = fit.rises && step.log_likelihood >= greatest - kAsLikely;
        if (separated) fit.lapse = step.lapse;
        if (!fit.rises) profiles.best = {0.0, 0.0, 0.0, constant};
        if (fit.rises && !separated) {
            fit.pse = -top.height / top.slope;
            fit.sd = 1.0 / top.slope;
            fit.lapse = top.lapse;
            fit.pse_ci = pse_interval(profiles, *fit.pse, greatest, least);
        }
        fit.sd_ci = sd_interval(profiles, greatest, least, step);
        fit.status = separated                                   ? FitStatus::separated
                     : fit.pse_ci.closed() && fit.sd_ci.closed() ? FitStatus::ok
                                                                 : FitStatus::open;
        if (profiles.best.log_likelihood <= greatest + kAsLikely) break;
    }
    return fit;
}

}  // namespace palpa::study
