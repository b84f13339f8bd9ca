#pragma once
// A push button: a soft cover over a support that snaps. Its force over travel, and its travel under a force.

#include <array>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "mechanics/button_cover.h"

namespace palpa::mechanics {

// The paper's support: a spring that lets go when the force on the button, cover and support together, exceeds a
// threshold, and holds again above `off`. Read literally ("F_s = 0 when F > f") it would chatter: letting go takes the
// force below the threshold.
// Source: Yang, Lian, Chen, "Haptic evaluation of multi-material parts", equation (13); the latch by travel is ours.
struct LatchSupport {
    double stiffness_N_per_m = 0.0;
    double threshold_N = 0.0;
};

// Two bars that meet at an apex and snap through:
//   F = 2 k z ( L0 / L - 1 ),   z = h - w,   L = sqrt(a^2 + z^2),   L0 = sqrt(a^2 + h^2)
// k: stiffness of a bar; a: half of the span; h: rise; w: travel of the apex.
// Source: e.g. Bazant, Cedolin, Stability of Structures, section 4.4 (von Mises truss), for bars of linear springs.
struct TrussSupport {
    double bar_N_per_m = 0.0;
    double half_span_m = 0.0;
    double rise_m = 0.0;
};
double truss_force_N(const TrussSupport& truss, double travel_m);
double truss_slope_N_per_m(const TrussSupport& truss, double travel_m);

// A measured support: force when pressed and when released at the same travels, ascending from 0; straight between
// them. release <= press everywhere, so that a cycle makes no energy.
struct MeasuredSupport {
    std::vector<double> travel_m;
    std::vector<double> press_N;
    std::vector<double> release_N;
};

struct Button {
    std::optional<ButtonCover> cover;
    std::variant<std::monostate, LatchSupport, TrussSupport, MeasuredSupport> support;
    double travel_m = 0.0;          // where it stops
    std::optional<double> on_m{};   // absent: where a latch lets go, else at the trough after the snap
    std::optional<double> off_m{};  // absent: at the peak before the snap; of a latch at half the travel of on
};

// The force over travel. A button is on or off; that matters to a latch. Force when pressed: at least that when
// released.
struct ButtonCurve {
    double travel_m = 0.0;
    // [on]: at equally spaced travels from 0
    std::array<std::vector<double>, 2> press_N;
    std::array<std::vector<double>, 2> release_N;
    // the force falls somewhere while the button is pressed further, with a measured support by 2 % of its greatest force and
    // 8 standard deviations of its noise at least; the next four are of the greatest fall
    bool snaps = false;
    double peak_m = 0.0;
    double peak_N = 0.0;
    double trough_m = std::numeric_limits<double>::quiet_NaN();  // NaN: the stop comes before a trough
    double trough_N = std::numeric_limits<double>::quiet_NaN();
    std::optional<double> on_m, off_m;  // absent for a button that neither snaps nor names them
    double loss_J = 0.0;                // of one press to the stop and back, by travel
    int newton_iterations = 0;          // of the cover, in all
};

constexpr std::size_t kCoverTravels = 33;

// A cover's force and its slope at 33 equally spaced travels from 0 to travel_m; between them cubic. Takes about a second with
// the default spacings, the rest of a curve a millisecond. Throws LoadError for a travel that is not > 0, MeshError as
// make_net() does, SolverError if the cover finds no equilibrium.
struct CoverTable {
    double step_m = 0.0;
    std::vector<double> force_N, slope_N_per_m;  // empty: no cover
    int iterations = 0;
};
CoverTable make_cover_table(const ButtonCover& cover, double travel_m);

// Computes the curve by travel, so that it passes the snap. `cover`: the table of the button's cover. peak and trough are
// refined beyond the table's steps, to round-off for a truss. Throws LoadError for a button with neither cover nor support,
// sizes that are not > 0, measured forces that make energy or travels that do not ascend from 0, on or off outside the
// travel, off not before on.
ButtonCurve press_button(const Button& button, const CoverTable& cover);
ButtonCurve press_button(const Button& button);  // makes the cover's table too

// What a force changes.
struct ButtonState {
    double travel_m = 0.0;
    bool on = false;
    bool stopped = false;       // at the end of the travel
    std::int64_t switched = 0;  // times that it went on
};

// Moves the button, slowly, to where it bears `force_N` (>= 0): further in while the force exceeds that of pressing, out
// while it is below that of releasing. Through a snap it goes on to the next travel that bears the force. On and off by
// travel, off before on, so that a force that rests at the peak with noise switches once. Not finite: nothing changes.
// Allocates nothing, does not throw.
void move_button(const ButtonCurve& curve, double force_N, ButtonState& state);

// Returns the force at a travel when pressed, from the table.
double press_force_N(const ButtonCurve& curve, bool on, double travel_m);

}  // namespace palpa::mechanics
