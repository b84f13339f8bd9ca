#include "study/simulated_person.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpa::study {
namespace {

constexpr double kMargin = 0.92;       // share of the surface that the search covers
constexpr double kCheck_m = 12e-3;     // strokes over a place in doubt extend this far to each side
constexpr double kMarked_m = 14e-3;    // radius around a mark in which nothing is checked again
constexpr double kDismissed_m = 6e-3;  // radius around a dismissed place in which nothing is checked again
constexpr double kMoreForce = 1.15;    // on a place in doubt, as masters of palpation do (Laufer 2024)
constexpr double kPressing_s = 0.25;   // time until a press has its full force
constexpr double kExponent = 0.6;      // depth ~ force^0.6: between a flat punch and a sphere
constexpr double kCompliance_s = 3.0;  // time constant of learning what plain tissue is like

double distance_m(const ScreenPlace& a, const ScreenPlace& b) { return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m); }

// Lines along x, or along y on every second pass, from one side to the other and back.
std::vector<ScreenPlace> strips(const SimulatedPerson& person, bool along_x) {
    const double length_m = kMargin * (along_x ? person.half_x_m : person.half_y_m);
    const double across_m = kMargin * (along_x ? person.half_y_m : person.half_x_m);
    const int n = std::max(1, static_cast<int>(std::ceil(2.0 * across_m / person.traits.spacing_m)));
    std::vector<ScreenPlace> out;
    for (int i = 0; i <= n; ++i) {
        const double offset_m = -across_m + 2.0 * across_m * i / n;
        for (const int side : {-1, 1}) {
            const double along_m = (i % 2 == 0 ? side : -side) * length_m;
            out.push_back(along_x ? ScreenPlace{along_m, offset_m} : ScreenPlace{offset_m, along_m});
        }
    }
    return out;
}

// Returns a spiral from the middle outwards, clamped to the searched surface.
std::vector<ScreenPlace> spiral(const SimulatedPerson& person) {
    const double reach_m = std::hypot(person.half_x_m, person.half_y_m);
    std::vector<ScreenPlace> out;
    constexpr double kStep_rad = 0.3;
    for (double angle = 0.0;; angle += kStep_rad) {
        const double r_m = person.traits.spacing_m * angle / (2.0 * std::numbers::pi);
        if (r_m > reach_m) return out;
        out.push_back({std::clamp(r_m * std::cos(angle), -kMargin * person.half_x_m, kMargin * person.half_x_m),
                       std::clamp(r_m * std::sin(angle), -kMargin * person.half_y_m, kMargin * person.half_y_m)});
    }
}

void plan_pass(SimulatedPerson& person) {
    std::vector<ScreenPlace> pass =
        person.traits.path == SearchPath::strips ? strips(person, person.passes % 2 == 0) : spiral(person);
    if (person.passes % 4 >= 2) std::reverse(pass.begin(), pass.end());
    ++person.passes;
    person.way.assign(pass.rbegin(), pass.rend());
}

// Moves the hand along its way by `step_m`.
void go(double step_m, SimulatedPerson& person) {
    while (step_m > 0.0 && !person.way.empty()) {
        const ScreenPlace& next = person.way.back();
        const double left_m = distance_m(person.at, next);
        if (left_m <= step_m) {
            person.at = next;
            person.way.pop_back();
            step_m -= left_m;
            continue;
        }
        person.at.x_m += step_m / left_m * (next.x_m - person.at.x_m);
        person.at.y_m += step_m / left_m * (next.y_m - person.at.y_m);
        return;
    }
}

double press_N(SimulatedPerson& person) {
    const PersonTraits& traits = person.traits;
    const double sway = 1.0 + traits.sway * std::sin(2.0 * std::numbers::pi * 0.4 * person.t_s + 1.0);
    const double tremor = 1.0 + traits.tremor * std::sin(2.0 * std::numbers::pi * traits.tremor_Hz * person.t_s) +
                          0.01 * person.random.normal();
    const double ramp = std::min(1.0, (person.t_s + 0.02) / kPressing_s);
    return std::max(
        0.0, traits.force_N * sway * tremor * ramp * (person.check != SimulatedPerson::Check::none ? kMoreForce : 1.0));
}

bool is_settled(const ScreenPlace& place, const SimulatedPerson& person) {
    return std::any_of(person.settled.begin(), person.settled.end(),
                       [&](const SettledPlace& known) { return distance_m(known.at, place) < known.radius_m; });
}

// Three strokes over the doubtful place, from side to side.
void add_strokes(bool along_x, SimulatedPerson& person) {
    for (const double side : {-1.0, 1.0, -1.0, 1.0}) {
        const double x_m = person.doubt.x_m + (along_x ? side * kCheck_m : 0.0);
        const double y_m = person.doubt.y_m + (along_x ? 0.0 : side * kCheck_m);
        person.way.push_back({std::clamp(x_m, -kMargin * person.half_x_m, kMargin * person.half_x_m),
                              std::clamp(y_m, -kMargin * person.half_y_m, kMargin * person.half_y_m)});
    }
    person.weight = 0.0;
    person.weighted = {};
}

// Begins a check of a place in doubt. The hand strokes over it along the direction in which it was felt (x or y), then
// across, through the place that the strokes gave, and so on until the place no longer moves; then the search
// continues.
void begin_check(SimulatedPerson& person) {
    const ScreenPlace ahead = person.way.empty() ? person.at : person.way.back();
    const bool along_x = std::abs(ahead.x_m - person.at.x_m) >= std::abs(ahead.y_m - person.at.y_m);
    person.check = along_x ? SimulatedPerson::Check::along_x : SimulatedPerson::Check::along_y;
    person.doubt = person.at;
    person.best = 0.0;
    person.halves = person.passes_over = person.passes_before = 0;
    person.above = true;  // what caused the doubt does not count again
    person.way.push_back(person.at);
    person.way_before = person.way.size();
    add_strokes(along_x, person);
}

void end_check(bool convinced, SimulatedPerson& person, Move& out) {
    person.check = SimulatedPerson::Check::none;
    const bool mark = convinced && !is_settled(person.doubt, person);
    person.settled.push_back({person.doubt, mark ? kMarked_m : kDismissed_m});
    if (!mark) return;
    out.deed = Deed::mark;
    out.mark = person.doubt;
    const double surplus = person.best / person.traits.criterion - 1.0;
    out.confidence = 1 + static_cast<int>(std::clamp(2.5 * surplus, 0.0, 4.0));
}

// To be called when the strokes of one half of the check are done. Computes the place along them, then begins the next
// half or ends the check.
void go_on_with_check(SimulatedPerson& person, Move& out) {
    constexpr double kStill_m = 6e-3;
    constexpr int kMostHalves = 4;
    constexpr int kTimes = 2;  // least number of the six strokes of two halves that must show something
    if (person.weight == 0.0) return end_check(false, person, out);
    const bool was_x = person.check == SimulatedPerson::Check::along_x;
    double& place_m = was_x ? person.doubt.x_m : person.doubt.y_m;
    const double felt_m = (was_x ? person.weighted.x_m : person.weighted.y_m) / person.weight;
    const double moved_m = std::abs(felt_m - place_m);
    place_m = felt_m;
    ++person.halves;
    const bool still = person.halves >= 2 && std::max(moved_m, person.moved_m) < kStill_m;
    if (still || person.halves == kMostHalves) {
        return end_check(person.passes_over + person.passes_before >= kTimes, person, out);
    }
    person.moved_m = moved_m;
    person.passes_before = person.passes_over;
    person.passes_over = 0;
    person.check = was_x ? SimulatedPerson::Check::along_y : SimulatedPerson::Check::along_x;
    add_strokes(!was_x, person);
}

// A first-order low-pass of time constant `memory_s`; its noise is standard normal and correlated over the same time.
void look(double input, double dt_s, double memory_s, double& seen, double& noise, Random& random) {
    const double kept = std::exp(-dt_s / memory_s);
    seen = kept * seen + (1.0 - kept) * input;
    noise = kept * noise + std::sqrt(1.0 - kept * kept) * random.normal();
}

// Returns how much shallower the dent is than the force that is felt lets expect, as a difference of logarithms. The
// expectation is learned from the tissue pressed so far.
double missing_depth(const Sight& sight, double dt_s, SimulatedPerson& person) {
    if (!sight.dent_shown || sight.depth_m <= 0.0 || person.felt_N < 0.3) return 0.0;
    const double compliance = std::log(sight.depth_m) - kExponent * std::log(person.felt_N);
    if (!person.has_compliance) person.compliance = compliance;
    person.has_compliance = true;
    const double missing = person.compliance - compliance;
    person.compliance += (1.0 - std::exp(-dt_s / kCompliance_s)) * (compliance - person.compliance);
    return missing;
}

}  // namespace

PersonTraits draw_person(double deep_N, double greatest_N, Random& random) {
    PersonTraits traits;
    traits.path = random.uniform() < 0.75 ? SearchPath::strips : SearchPath::spiral;
    traits.spacing_m = std::clamp(12e-3 + 2e-3 * random.normal(), 7e-3, 18e-3);
    traits.speed_m_per_s = 35e-3 * std::exp(0.2 * random.normal());
    traits.force_N = std::min(1.4 * deep_N * std::exp(0.15 * random.normal()), 0.85 * greatest_N);
    traits.tremor_Hz = random.uniform(8.0, 12.0);
    traits.tremor = 0.03 * std::exp(0.3 * random.normal());
    traits.lag_noise_m = 0.1e-3 * std::exp(0.3 * random.normal());
    traits.criterion = std::max(2.8, 3.5 + 0.3 * random.normal());
    return traits;
}

SimulatedPerson make_person(const PersonTraits& traits, double width_m, double height_m, double limit_s,
                            std::uint64_t seed) {
    SimulatedPerson person;
    person.traits = traits;
    person.random = Random(seed);
    person.half_x_m = 0.5 * width_m;
    person.half_y_m = 0.5 * height_m;
    person.limit_s = limit_s;
    plan_pass(person);
    person.at = person.way.back();
    return person;
}

Move move(double dt_s, SimulatedPerson& person) {
    Move out;
    out.began = !person.down;
    person.down = true;
    if (!out.began) {
        person.t_s += dt_s;
        go(person.traits.speed_m_per_s * dt_s, person);
    }
    if (person.check != SimulatedPerson::Check::none && person.way.size() <= person.way_before)
        go_on_with_check(person, out);
    if (person.way.empty()) plan_pass(person);
    out.at = {person.at.x_m + person.traits.jitter_m * person.random.normal(),
              person.at.y_m + person.traits.jitter_m * person.random.normal()};
    out.force_N = person.felt_N = press_N(person);
    if (person.t_s >= person.limit_s && out.deed == Deed::none) out.deed = Deed::finish;
    return out;
}

void see(const Sight& sight, double dt_s, SimulatedPerson& person) {
    const PersonTraits& traits = person.traits;
    look(sight.lag_m, dt_s, traits.look_s, person.lag_seen_m, person.lag_noise, person.random);
    look(missing_depth(sight, dt_s, person), dt_s, traits.look_s, person.dent_seen, person.dent_noise, person.random);
    const double weight_of_lag = sight.lag_shown ? 1.0 : 0.0;
    const double weight_of_dent = !sight.lag_shown ? 1.0 : sight.dent_shown ? traits.dent_weight : 0.0;
    const double by_lag = person.lag_seen_m / traits.lag_noise_m + person.lag_noise;
    const double by_dent = person.dent_seen / traits.dent_noise + person.dent_noise;
    // its noise has a standard deviation of 1
    const double evidence =
        (weight_of_lag * by_lag + weight_of_dent * by_dent) / std::hypot(weight_of_lag, weight_of_dent);
    if (person.check == SimulatedPerson::Check::none) {
        if (evidence > traits.criterion && !is_settled(person.at, person)) begin_check(person);
        return;
    }
    if (evidence > traits.criterion && !person.above) {
        ++person.passes_over;
        person.above = true;
    }
    // hysteresis, since noise would cross a single threshold again and again
    if (evidence < 0.4 * traits.criterion) person.above = false;
    person.best = std::max(person.best, evidence);
    const double weight = std::max(0.0, evidence - 0.5 * traits.criterion);
    person.weight += weight;
    person.weighted.x_m += weight * person.at.x_m;
    person.weighted.y_m += weight * person.at.y_m;
}

bool answers_right(double reference_kPa, double comparison_kPa, double weber, Random& random) {
    const double seen = std::log(comparison_kPa / reference_kPa) + weber * std::numbers::sqrt2 * random.normal();
    return (seen > 0.0) == (comparison_kPa > reference_kPa);
}

}  // namespace palpa::study
