#pragma once
// A simulated person who feels how stiff a surface is: by the hand from force over depth, by the fingertip from the
// shape that pins reached, or by the eye from the dent that a screen drew. Each sense has noise of its own; what they
// tell is joined as a person who knows that noise would join it.
//
// Each sense k tells x_k = ln(stiffness in N/m) + s_k n, n standard normal. The joined estimate is
//
//   x = sum w_k x_k / sum w_k,  w_k = 1 / s_k^2,   so that  1 / s^2 = sum 1 / s_k^2
//
// (Ernst & Banks, Nature 415 (2002) 429). Of two surfaces the one with the smaller x is called the softer one: the
// psychometric function of study/psychometric.h without bias and lapse, with sd = sqrt(2) s.

#include <array>
#include <limits>
#include <span>

#include "study/random.h"

namespace palpa::study {

// One moment of a press on a display, as it was displayed.
struct FeltMoment {
    double force_N = 0.0;      // on the hand
    double depth_m = 0.0;      // of the hand, or of the dent that is drawn
    double shape_m = 0.0;      // highest minus lowest pin; 0 without pins
    double own_shape_m = 0.0;  // the same of the tissue's own surface at these places and this depth
};

enum class Sense { hand, fingertip, eye };
inline constexpr std::size_t kSenses = 3;

// ln(stiffness in N/m) that each sense is told, before its noise; NaN: nothing.
struct FeltStiffness {
    std::array<double, kSenses> ln_N_per_m{std::numeric_limits<double>::quiet_NaN(),
                                           std::numeric_limits<double>::quiet_NaN(),
                                           std::numeric_limits<double>::quiet_NaN()};
    double by(Sense sense) const { return ln_N_per_m[static_cast<std::size_t>(sense)]; }
    double& by(Sense sense) { return ln_N_per_m[static_cast<std::size_t>(sense)]; }
};

// Hand: the slope of force over depth through the origin (least squares). Fingertip: the slope of force over shape while
// the shape still changes (below 90 % of its greatest in this press), times the ratio of shape and depth that the tissue's
// own surface has. Pins that are late are behind while pressing and ahead while releasing, so a press there and back tells
// the right stiffness if both are alike. A sense is told nothing if the press has no depth, or less than 0.05 mm of
// shape. Moments that are not finite are left out.
FeltStiffness feel_by_hand(std::span<const FeltMoment> press);
// A surface that itself gives way under the fingertip, of a soft device or a cast: both senses are told the slope of force
// over depth, the fingertip by how its contact grows (Srinivasan & LaMotte, J. Neurophysiol. 73 (1995) 88).
FeltStiffness feel_soft_surface(std::span<const FeltMoment> press);
// The same depth and force, but seen: for a screen.
FeltStiffness feel_by_eye(std::span<const FeltMoment> press);

// Standard deviation of the noise of ln(stiffness), one for each sense. ASSUMED: hand and fingertip are what gives
// shares of right answers of 56 % by the hand alone and 82 % by hand and fingertip over the paper's five comparisons
// (sd 2.1929494 and 0.2567221 of the psychometric function), if the displays show exactly what they should. So these two
// figures are put in and do not come out. The eye's is our choice.
struct TouchNoise {
    std::array<double, kSenses> sd{1.5506494, 0.1827868, 0.2};
};

// The joined estimate of ln(stiffness in N/m). Always draws one number for each sense. Without any sense: noise alone,
// of the hand.
double perceived_ln(const FeltStiffness& felt, const TouchNoise& noise, Random& random);

// The same estimate without noise; NaN without any sense.
double joined_ln(const FeltStiffness& felt, const TouchNoise& noise);

// Standard deviation of that estimate.
double perceived_sd(const FeltStiffness& felt, const TouchNoise& noise);

}  // namespace palpa::study
