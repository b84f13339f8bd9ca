#include "mechanics/button.h"

#include <algorithm>
#include <cmath>

#include "mechanics/error.h"
#include "mechanics/index.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

constexpr int kTravels = 1025;  // of the table

struct Force {
    double N = 0.0;
    double slope_N_per_m = 0.0;
};

// Hermite's cubic.
Force cover_at(const CoverTable& table, double travel_m) {
    if (table.force_N.empty()) return {};
    const double place = travel_m / table.step_m;
    const std::size_t i = std::min(static_cast<std::size_t>(std::max(place, 0.0)), kCoverTravels - 2);
    const double t = place - static_cast<double>(i), h = table.step_m;
    const double from_N = table.force_N[i], rise = table.force_N[i + 1] - from_N;
    const double m0 = h * table.slope_N_per_m[i], m1 = h * table.slope_N_per_m[i + 1];
    const double c2 = 3.0 * rise - 2.0 * m0 - m1, c3 = m0 + m1 - 2.0 * rise;
    return {from_N + t * (m0 + t * (c2 + t * c3)), (m0 + t * (2.0 * c2 + 3.0 * t * c3)) / h};
}

Force measured_at(const std::vector<double>& travel_m, const std::vector<double>& force_N, double w) {
    const auto above = std::upper_bound(travel_m.begin() + 1, travel_m.end() - 1, w);
    const auto i = at(above - travel_m.begin());
    const double slope = (force_N[i] - force_N[i - 1]) / (travel_m[i] - travel_m[i - 1]);
    return {force_N[i - 1] + slope * (w - travel_m[i - 1]), slope};
}

// Cover and support together.
struct ButtonModel {
    const Button& button;
    const CoverTable& cover;

    Force operator()(double w, bool on, bool release) const {
        Force out = cover_at(cover, w);
        if (const auto* latch = std::get_if<LatchSupport>(&button.support); latch != nullptr && !on) {
            out.N += latch->stiffness_N_per_m * w;
            out.slope_N_per_m += latch->stiffness_N_per_m;
        } else if (const auto* truss = std::get_if<TrussSupport>(&button.support)) {
            out.N += truss_force_N(*truss, w);
            out.slope_N_per_m += truss_slope_N_per_m(*truss, w);
        } else if (const auto* measured = std::get_if<MeasuredSupport>(&button.support)) {
            const Force f = measured_at(measured->travel_m, release ? measured->release_N : measured->press_N, w);
            out.N += f.N;
            out.slope_N_per_m += f.slope_N_per_m;
        }
        return out;
    }
};

void check_positive(std::initializer_list<std::pair<const char*, double>> values) {
    for (const auto& [name, value] : values) {
        if (!(value > 0.0 && std::isfinite(value))) throw LoadError(text("a button's ", name, " of ", value));
    }
}

void check_measured(const MeasuredSupport& m, double travel_m) {
    const std::size_t n = m.travel_m.size();
    if (n < 2 || m.press_N.size() != n || m.release_N.size() != n || m.travel_m[0] != 0.0)
        throw LoadError("a measured curve needs two or more travels from 0, each with both forces");
    for (std::size_t i = 0; i < n; ++i) {
        const double mm = 1e3 * m.travel_m[i];
        if (i > 0 && !(m.travel_m[i] > m.travel_m[i - 1]))
            throw LoadError(text("a measured travel of ", mm, " mm that is not above the one before"));
        if (!(std::isfinite(m.press_N[i]) && m.release_N[i] <= m.press_N[i] && std::isfinite(m.release_N[i])))
            throw LoadError(text("at ", mm, " mm the button releases with ", m.release_N[i], " N and is pressed with ",
                                 m.press_N[i], " N: it would make energy"));
    }
    if (!(m.travel_m.back() >= travel_m * (1.0 - 1e-9)))
        throw LoadError(text("a curve measured to ", 1e3 * m.travel_m.back(), " mm for a travel of ", 1e3 * travel_m));
}

void check_button(const Button& button) {
    check_positive({{"travel", button.travel_m}});
    if (!button.cover && std::holds_alternative<std::monostate>(button.support))
        throw LoadError("a button with neither cover nor support");
    if (const auto* latch = std::get_if<LatchSupport>(&button.support))
        check_positive({{"stiffness", latch->stiffness_N_per_m}, {"threshold", latch->threshold_N}});
    if (const auto* truss = std::get_if<TrussSupport>(&button.support)) {
        check_positive(
            {{"bar's stiffness", truss->bar_N_per_m}, {"half span", truss->half_span_m}, {"rise", truss->rise_m}});
    }
    if (const auto* measured = std::get_if<MeasuredSupport>(&button.support))
        check_measured(*measured, button.travel_m);
}

// Halves an interval whose ends have opposite answers down to neighbouring numbers. below(w) is true at `low`.
template <class Below>
double halved(double low, double high, const Below& below) {
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        if (!(middle > low && middle < high)) break;
        (below(middle) ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double travel_at(const ButtonCurve& curve, std::size_t i) {
    return curve.travel_m * static_cast<double>(i) / (kTravels - 1);
}

void fill_table(const ButtonModel& model, ButtonCurve& curve) {
    for (const bool on : {false, true}) {
        for (std::size_t i = 0; i < kTravels; ++i) {
            curve.press_N[on].push_back(model(travel_at(curve, i), on, false).N);
            curve.release_N[on].push_back(model(travel_at(curve, i), on, true).N);
        }
    }
}

// The standard deviation of what a sensor added to a measured curve, from the median of its fourth differences, in which a
// curve of ten rows a period leaves a sixth of its amplitude. 0 for fewer than ten rows.
double noise_N(const MeasuredSupport& support) {
    const std::vector<double>& F = support.press_N;
    std::vector<double> differences;
    for (std::size_t i = 4; i < F.size(); ++i)
        differences.push_back(std::abs(F[i] - 4.0 * F[i - 1] + 6.0 * F[i - 2] - 4.0 * F[i - 3] + F[i - 4]));
    if (differences.size() < 6) return 0.0;
    const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
    std::nth_element(differences.begin(), middle, differences.end());
    return *middle / (0.6745 * std::sqrt(70.0));  // 1 + 16 + 36 + 16 + 1
}

// What a measured force must fall by to be no noise.
double least_fall_N(const MeasuredSupport& support) {
    constexpr double kOfGreatest = 0.02, kOfNoise = 8.0;
    const double most_N = *std::max_element(support.press_N.begin(), support.press_N.end());
    return std::max(kOfGreatest * most_N, kOfNoise * noise_N(support));
}

// The greatest fall of the pressing force, if it is greater than `least_N`: it snaps from the peak to the trough.
void find_snap(const ButtonModel& model, double least_N, ButtonCurve& curve) {
    const std::vector<double>& F = curve.press_N[0];
    std::size_t top = 0, peak = 0, trough = 0;
    double fall_N = 0.0;
    for (std::size_t i = 1; i < kTravels; ++i) {
        if (F[i] >= F[top]) top = i;
        if (F[top] - F[i] <= 0.0 || F[top] - F[i] < fall_N) continue;
        fall_N = F[top] - F[i];
        peak = top;
        trough = i;
    }
    if (!(fall_N > least_N)) return;
    curve.snaps = true;
    const auto rises = [&](double w) { return model(w, false, false).slope_N_per_m > 0.0; };
    const auto falls = [&](double w) { return !rises(w); };
    curve.peak_m = halved(travel_at(curve, std::max<std::size_t>(peak, 1) - 1), travel_at(curve, peak + 1), rises);
    curve.peak_N = model(curve.peak_m, false, false).N;
    if (trough + 1 == kTravels) return;  // the stop comes first
    curve.trough_m = halved(travel_at(curve, trough - 1), travel_at(curve, trough + 1), falls);
    curve.trough_N = model(curve.trough_m, false, false).N;
}

// A latch lets go where cover and spring together reach the threshold.
void find_latch(const ButtonModel& model, const LatchSupport& latch, ButtonCurve& curve) {
    const auto holds = [&](double w) { return model(w, false, false).N < latch.threshold_N; };
    if (holds(curve.travel_m)) throw LoadError("a latch whose threshold is not reached within the travel");
    curve.snaps = true;
    curve.peak_m = curve.trough_m = halved(0.0, curve.travel_m, holds);
    curve.on_m = curve.peak_m;
    curve.peak_N = model(curve.peak_m, false, false).N;
    curve.trough_N = model(curve.peak_m, true, false).N;
}

void check_switch(const ButtonCurve& curve) {
    if (!curve.on_m && !curve.off_m) return;
    if (!curve.on_m || !curve.off_m) throw LoadError("a button that goes on but never off, or off but never on");
    if (!(*curve.off_m < *curve.on_m)) {
        throw LoadError(text("off at ", 1e3 * *curve.off_m, " mm, on at ", 1e3 * *curve.on_m,
                             " mm: a button goes off before (above) where it goes on"));
    }
    if (!(*curve.off_m > 0.0 && *curve.on_m <= curve.travel_m))
        throw LoadError(text("on at ", 1e3 * *curve.on_m, " and off at ", 1e3 * *curve.off_m, " mm, in a travel of ",
                             1e3 * curve.travel_m));
}

// int (press - release) dw over one cycle; the branch changes at on and off.
double loss_J(const ButtonModel& model, const ButtonCurve& curve) {
    const auto area = [&](double from, double to, bool pressed_on, bool released_on) {
        constexpr int n = 2000;
        double sum = 0.0;
        for (int i = 0; i < n; ++i) {
            const double w = from + (to - from) * (i + 0.5) / n;
            sum += model(w, pressed_on, false).N - model(w, released_on, true).N;
        }
        return sum * (to - from) / n;
    };
    if (!curve.on_m) return area(0.0, curve.travel_m, false, false);
    return area(0.0, *curve.off_m, false, false) + area(*curve.off_m, *curve.on_m, false, true) +
           area(*curve.on_m, curve.travel_m, true, true);
}

double in_table(const std::vector<double>& table, double place) {
    const int i = std::clamp(static_cast<int>(place), 0, kTravels - 2);
    return table[at(i)] + (place - i) * (table[at(i) + 1] - table[at(i)]);
}

// Moves in (way = 1) or out (way = -1) within one state, to where the table bears the force, to a switching point or to an
// end. Returns true if it is the switching point.
bool slide(const std::vector<double>& table, double force_N, int way, double switch_place, double& place) {
    const auto past = [way, force_N](double N) { return way > 0 ? N >= force_N : N <= force_N; };
    const double end = way > 0 ? kTravels - 1 : 0.0;
    while (place != end) {
        const double edge = way > 0 ? std::floor(place) + 1.0 : std::ceil(place) - 1.0;
        const bool switches = way * (switch_place - place) > 0.0 && way * (switch_place - edge) <= 0.0;
        const double next = switches ? switch_place : edge;
        const double here = in_table(table, place), there = in_table(table, next);
        if (past(there)) {
            if (there != here) place += (next - place) * std::clamp((force_N - here) / (there - here), 0.0, 1.0);
            return false;
        }
        place = next;
        if (switches) return true;
    }
    return false;
}

}  // namespace

double truss_force_N(const TrussSupport& truss, double travel_m) {
    const double z = truss.rise_m - travel_m;
    const double L = std::hypot(truss.half_span_m, z), L0 = std::hypot(truss.half_span_m, truss.rise_m);
    // L0 - L from the squares, which do not cancel at small travel
    const double shorter_m = travel_m * (2.0 * truss.rise_m - travel_m) / (L0 + L);
    return 2.0 * truss.bar_N_per_m * z * shorter_m / L;
}

double truss_slope_N_per_m(const TrussSupport& truss, double travel_m) {
    const double z = truss.rise_m - travel_m, a = truss.half_span_m;
    const double L = std::hypot(a, z), L0 = std::hypot(a, truss.rise_m);
    return 2.0 * truss.bar_N_per_m * (1.0 - L0 * a * a / (L * L * L));
}

CoverTable make_cover_table(const ButtonCover& cover, double travel_m) {
    check_positive({{"travel", travel_m}});
    const CoverNet net = make_net(cover);
    CoverTable out;
    out.step_m = travel_m / (kCoverTravels - 1);
    std::vector<double> travels_m;
    for (std::size_t i = 0; i < kCoverTravels; ++i) travels_m.push_back(static_cast<double>(i) * out.step_m);
    for (const CoverState& state : press_cover(net, travels_m)) {
        if (!state.converged)
            throw SolverError(text("no equilibrium of the cover at ", 1e3 * state.travel_m, " mm"), 0);
        out.force_N.push_back(state.force_N);
        out.slope_N_per_m.push_back(state.slope_N_per_m);
        out.iterations += state.iterations;
    }
    return out;
}

ButtonCurve press_button(const Button& button) {
    check_button(button);
    return press_button(button, button.cover ? make_cover_table(*button.cover, button.travel_m) : CoverTable());
}

ButtonCurve press_button(const Button& button, const CoverTable& cover) {
    check_button(button);
    const ButtonModel model{button, cover};
    ButtonCurve curve;
    curve.travel_m = button.travel_m;
    curve.newton_iterations = model.cover.iterations;
    fill_table(model, curve);
    const auto* latch = std::get_if<LatchSupport>(&button.support);
    if (latch != nullptr) {
        find_latch(model, *latch, curve);
    } else {
        const auto* support = std::get_if<MeasuredSupport>(&button.support);
        find_snap(model, support != nullptr ? least_fall_N(*support) : 0.0, curve);
        if (curve.snaps && std::isfinite(curve.trough_m)) curve.on_m = curve.trough_m;
        if (button.on_m) curve.on_m = button.on_m;
    }
    if (curve.on_m && curve.snaps) curve.off_m = latch != nullptr ? 0.5 * curve.peak_m : curve.peak_m;
    if (button.off_m) curve.off_m = button.off_m;
    check_switch(curve);
    curve.loss_J = loss_J(model, curve);
    return curve;
}

void move_button(const ButtonCurve& curve, double force_N, ButtonState& state) {
    if (!std::isfinite(force_N)) return;
    constexpr double kNowhere = -1e9;
    const double scale = (kTravels - 1) / curve.travel_m;
    double place = std::clamp(state.travel_m * scale, 0.0, kTravels - 1.0);
    const bool in = force_N > in_table(curve.press_N[state.on], place);
    const bool out = !in && force_N < in_table(curve.release_N[state.on], place);
    const auto& table = in ? curve.press_N : curve.release_N;
    while (in || out) {
        const bool waits = state.on != in && curve.on_m.has_value();  // moving in while off, out while on
        const double at_place = !waits ? kNowhere : scale * (in ? *curve.on_m : *curve.off_m);
        if (!slide(table[state.on], force_N, in ? 1 : -1, at_place, place)) break;
        state.on = in;
        state.switched += in;
        const double now_N = in_table(table[state.on], place);
        if (in ? now_N >= force_N : now_N <= force_N) break;
    }
    state.travel_m = place / scale;
    state.stopped = place >= kTravels - 1;
}

double press_force_N(const ButtonCurve& curve, bool on, double travel_m) {
    return in_table(curve.press_N[on], std::clamp(travel_m / curve.travel_m, 0.0, 1.0) * (kTravels - 1));
}

}  // namespace palpa::mechanics
