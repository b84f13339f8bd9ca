#pragma once
// What a sample costs on this machine, from pressure to avatar, with the program that people run. Beside every time
// stands its ratio to a unit that any machine can measure: one factorisation of a known matrix by Eigen.

#include <string>
#include <vector>

#include "accuracy/accuracy.h"
#include "scene/plan.h"

namespace palpa::accuracy {

// Of several repetitions in one run; the least is what a busy machine disturbs least.
struct SpeedRow {
    std::string what;
    double least_us = kUnknown;
    double median_us = kUnknown;
    double p99_us = kUnknown;  // of single samples, clock included, in the repetition with the least
    int repetitions = 0;
};

// Eigen's SimplicialLDLT, factorisation alone, of the 7-point Laplacian on 16 x 16 x 16 points (6 on the diagonal, -1
// beside it).
SpeedRow machine_unit(int repetitions);

// A simulated pen at 1,000 Hz over the scene for `seconds`, each repetition from a fresh start. Times are per sample.
SpeedRow sample_speed(const scene::Scene& scene, const scene::Plan& plan, double seconds, int repetitions);

files::Json speed_json(const SpeedRow& unit, const std::vector<SpeedRow>& rows, const Machine& machine);
std::string speed_table(const SpeedRow& unit, const std::vector<SpeedRow>& rows);

}  // namespace palpa::accuracy
