#pragma once
// A simulated person: a hand that searches a surface, and an eye that sees the avatar lag behind the pen and the dent
// become shallower. The person knows nothing of the tissue but what the loop shows, as a participant does.
//
// Lengths are metres on the screen, which is taken to be as large as the tissue; x points to the right, y upwards, and
// (0, 0) is the middle of the tissue. All numbers below are our choices and are not fitted to data of people: they
// serve to check a protocol and the chain from pen to report, and predict nothing.

#include <cstdint>
#include <vector>

#include "study/random.h"

namespace palpa::study {

struct ScreenPlace {
    double x_m = 0.0;
    double y_m = 0.0;
};

enum class SearchPath { strips, spiral };

// The traits in which persons differ.
struct PersonTraits {
    SearchPath path = SearchPath::strips;
    double spacing_m = 12e-3;  // of strips or turns: about a fingertip
    double speed_m_per_s = 35e-3;
    double force_N = 2.5;         // aimed at while searching; 15 % more on a place in doubt
    double sway = 0.1;            // amplitude of the slow change of the force, as a share of it
    double tremor = 0.03;         // amplitude of the tremor, as a share of the force
    double tremor_Hz = 10.0;      // 8 to 12 Hz
    double jitter_m = 0.1e-3;     // of the hand, rms
    double lag_noise_m = 0.1e-3;  // of the eye, after looking for `look_s`
    double dent_noise = 0.2;      // of the eye for the dent relative to the force that is felt, as a share
    double dent_weight = 0.4;     // of the dent in the evidence, beside 1 for the lag
    double look_s = 0.12;         // time constant of seeing
    double criterion = 3.5;       // evidence, in standard deviations of its noise, above which a place is checked
};

// Draws the traits of one person. `deep_N`: the force that the force bar shows as deep; `greatest_N`: the greatest
// force that the device can report.
PersonTraits draw_person(double deep_N, double greatest_N, Random& random);

struct Sight {
    double lag_m = 0.0;    // avatar behind the pen
    double depth_m = 0.0;  // of the dent; only if dent_shown
    bool dent_shown = false;
    bool lag_shown = true;  // false: the surface is felt and not seen
};

enum class Deed { none, mark, finish };

struct Move {
    ScreenPlace at;
    double force_N = 0.0;
    bool began = false;      // the pen comes down with this move
    Deed deed = Deed::none;  // after the move
    ScreenPlace mark;
    int confidence = 0;  // 1 ... 5, of the mark
};

struct SettledPlace {
    ScreenPlace at;
    double radius_m = 0.0;
};

struct SimulatedPerson {
    PersonTraits traits;
    Random random{1};
    double half_x_m = 0.0;
    double half_y_m = 0.0;
    double limit_s = 60.0;
    double t_s = 0.0;
    bool down = false;
    ScreenPlace at;                // the hand, without jitter
    std::vector<ScreenPlace> way;  // places still to be reached, the next one last
    int passes = 0;
    // the eye
    double lag_seen_m = 0.0;
    double lag_noise = 0.0;  // standard normal, remembered for look_s
    double dent_seen = 0.0;  // difference of logarithms
    double dent_noise = 0.0;
    double compliance = 0.0;  // running mean of log(depth / force^0.6)
    bool has_compliance = false;
    double felt_N = 0.0;
    // a place in doubt
    enum class Check { none, along_x, along_y };
    Check check = Check::none;
    std::size_t way_before = 0;  // length of `way` when the check began, the place to return to included
    ScreenPlace doubt;           // where the hidden thing is thought to be
    double weight = 0.0;         // sum of the weights of this half of the check
    ScreenPlace weighted;        // weighted sum of places, m
    double best = 0.0;           // strongest evidence of the check
    int passes_over = 0;         // how often the evidence rose above the criterion, in this half
    int passes_before = 0;       // the same in the half before
    double moved_m = 0.0;        // how far the half before moved the place
    int halves = 0;
    bool above = false;                 // the evidence has not fallen below the threshold since it last counted
    std::vector<SettledPlace> settled;  // marked, or checked and dismissed
};

// Makes a person who searches a surface of this width and height until `limit_s` of pressing.
SimulatedPerson make_person(const PersonTraits& traits, double width_m, double height_m, double limit_s,
                            std::uint64_t seed);

// Returns the next move, `dt_s` after the last one. After Deed::finish no further call is meant.
Move move(double dt_s, SimulatedPerson& person);

// Lets the person see what the loop shows of that move.
void see(const Sight& sight, double dt_s, SimulatedPerson& person);

// Draws whether the answer to a forced choice is right. Each of the two stiffnesses is seen with noise; `weber` is the
// standard deviation of its logarithm (a share).
bool answers_right(double reference_kPa, double comparison_kPa, double weber, Random& random);

}  // namespace palpa::study
