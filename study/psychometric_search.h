#pragma once
// How study/psychometric.cpp finds the likeliest curve: Fisher scoring from several starts, with some coordinates held.
//
// A curve has coordinates (height, slope, lapse) about an origin:  z = height + slope (x - origin),  slope >= 0, so that
// sd = 1 / slope and PSE = origin - height / slope. A constant has slope 0. Holding the slope profiles sd; holding the
// height at 0 profiles the PSE, which is then the origin.

#include <span>

#include "study/psychometric.h"

namespace palpa::study {

struct CurvePoint {
    double height = 0.0;
    double slope = 0.0;
    double lapse = 0.0;
    double log_likelihood = 0.0;
};

struct CurveSearch {
    std::span<const LevelAnswers> levels;
    double greatest_lapse = 0.05;
    double origin = 0.0;
    bool height_free = true;
    bool slope_free = true;
};

// Returns the point that `start` climbs to, with its log likelihood.
CurvePoint climb(const CurveSearch& search, const CurvePoint& start);

double log_likelihood(const CurveSearch& search, const CurvePoint& point);

// The greatest log likelihood of a step between two levels or at a level: the limit of the curve as sd goes to 0.
// `pse`: a place of that step.
struct Step {
    double log_likelihood = 0.0;
    double lapse = 0.0;
    double pse = 0.0;
};
Step likeliest_step(std::span<const LevelAnswers> levels, double greatest_lapse);

// The greatest log likelihood of a step at this PSE: the limit of the curves that have it as their slope rises.
double step_log_likelihood(std::span<const LevelAnswers> levels, double pse, double greatest_lapse);

// The greatest log likelihood of a probability between `low` and `high` that is the same at all levels: the limit of
// the curve as sd goes to infinity, or as the PSE does.
double constant_log_likelihood(std::span<const LevelAnswers> levels, double low, double high);

// The log likelihood of probabilities that equal the shares at each level: the greatest of any probabilities.
double saturated_log_likelihood(std::span<const LevelAnswers> levels);

}  // namespace palpa::study
