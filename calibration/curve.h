#pragma once
// Curves from pressure level to force: value, slope and inverse. They are evaluated for every sample, so these three
// allocate nothing.

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

namespace palpa::calibration {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

enum class CurveModel : std::uint8_t { exponential, exponential_offset, power, monotone_cubic };

// F(x), newtons, x the level:
//
//   exponential         a exp(b x)               Li et al., eqs. 1, 5 and 6
//   exponential_offset  offset + a exp(b x)      a b > 0: it rises whether it bends up (b > 0) or down (b < 0)
//   power               a x^b
//   monotone_cubic      cubic pieces through knots that rise in level and in force
//
// The cubic's slopes are those of Fritsch & Butland (SIAM J. Sci. Stat. Comput. 5, 1984): the weighted harmonic mean of
// the neighbouring chords, so that the curve rises wherever the knots do. We differ at the two ends, where the slope is
// at least a tenth of the chord's, so that the inverse stays well conditioned. Below its first knot the curve continues
// as an exponential with the same value and slope (it never reaches zero), above its last one as a straight line.
struct Curve {
    CurveModel model = CurveModel::exponential;
    double a_N = 0.0;
    double b = 0.0;                  // per level; the exponent of `power`
    double offset_N = 0.0;           // exponential_offset only
    std::vector<double> knot_level;  // monotone_cubic only: at least 2
    std::vector<double> knot_N;
    std::vector<double> knot_N_per_level;  // set by monotone_cubic()
};

// Makes a cubic through knots. Levels and forces must rise strictly; needs at least two of each, and a first force > 0
// (assert).
Curve monotone_cubic(std::vector<double> level, std::vector<double> force_N);

double value_N(const Curve& curve, double level);
double slope_N_per_level(const Curve& curve, double level);
// Returns the level at which the curve has this force. If it never has it, returns the end that is nearest in force:
// -infinity or infinity, or 0 for a power.
double level_at(const Curve& curve, double force_N);

std::string_view name_of(CurveModel model);

}  // namespace palpa::calibration
