#pragma once
// A simulated person: a hand that searches a surface and an eye that sees the avatar lag behind the pen and the
// dent grow shallower. It knows nothing of the tissue: it sees what the loop shows, as a person does.
//
// Lengths are metres on the screen, which is taken as large as the tissue; x to the right, y upwards, (0, 0) in the
// middle of the tissue. All numbers below are choices of ours, tuned to no data of people; they check a protocol and
// the chain from pen to report, and predict nothing.

#include <cstdint>
#include <vector>

#include "study/random.h"

namespace palpa::study {

struct ScreenPlace {
    double x_m = 0.0;
    double y_m = 0.0;
};

enum class SearchPath { strips, spiral };

// What differs from person to person.
struct PersonTraits {
    SearchPath path = SearchPath::strips;
    double spacing_m = 12e-3;  // of strips or turns: about a fingertip
    double speed_m_per_s = 35e-3;
    double force_N = 2.5;  // aimed at while searching; on a place in doubt 15 % more
    double sway = 0.1;     // slow change of the force, share
    double tremor = 0.03;  // 8 to 12 Hz, share of the force
    double tremor_Hz = 10.0;
    double jitter_m = 0.1e-3;     // of the hand, rms
    double lag_noise_m = 0.1e-3;  // of the eye, after looking for `look_s`
    double dent_noise = 0.2;      // of the dent against the force that is felt, share
    double dent_weight = 0.4;     // beside the lag's 1
    double look_s = 0.12;
    double criterion = 3.5;  // in noise: what is taken for something
};

// `deep_N`: the force that the force bar shows as deep; `greatest_N`: the greatest force that the device can report.
PersonTraits draw_person(double deep_N, double greatest_N, Random& random);

struct Sight {
    double lag_m = 0.0;    // avatar behind the pen
    double depth_m = 0.0;  // of the dent; with dent_shown
    bool dent_shown = false;
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
    std::vector<ScreenPlace> way;  // still to go, last first
    int passes = 0;
    // the eye
    double lag_seen_m = 0.0;
    double lag_noise = 0.0;  // standard normal, remembered for look_s
    double dent_seen = 0.0;
    double dent_noise = 0.0;
    double compliance = 0.0;  // mean of log(depth / force^0.6) so far
    bool has_compliance = false;
    double felt_N = 0.0;
    // a place in doubt
    enum class Check { none, along_x, along_y };
    Check check = Check::none;
    std::size_t way_before = 0;  // length of `way` when the check began, with the place to go back to
    ScreenPlace doubt;           // where it is thought to be
    double weight = 0.0;         // of the evidence in this half of the check
    ScreenPlace weighted;
    double best = 0.0;      // strongest evidence of the check
    int passes_over = 0;    // separate times that the evidence passed the criterion, in this half
    int passes_before = 0;  // in the half before
    double moved_m = 0.0;   // how far that half had moved the place
    int halves = 0;
    bool above = false;
    std::vector<SettledPlace> settled;  // marked, or looked at and dismissed
};

SimulatedPerson make_person(const PersonTraits& traits, double width_m, double height_m, double limit_s,
                            std::uint64_t seed);

// The next move, `dt_s` after the last one. After Deed::finish the person is done.
Move move(double dt_s, SimulatedPerson& person);

// What the person sees of that move.
void see(const Sight& sight, double dt_s, SimulatedPerson& person);

// Draws whether the answer is right. Each of the two stiffnesses is seen with noise; `weber` is the standard deviation
// of its logarithm (a share).
bool answers_right(double reference_kPa, double comparison_kPa, double weber, Random& random);

}  // namespace palpa::study
