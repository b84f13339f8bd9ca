#pragma once
// The cost of a sample on this machine, from pressure to avatar, in the program that people run. Every time is also
// given as its ratio to a unit that any machine can measure: one factorisation of a known matrix by Eigen.

#include <memory>
#include <string>
#include <vector>

#include "accuracy/accuracy.h"
#include "accuracy/timing.h"
#include "scene/plan.h"

namespace palpa::accuracy {

// Times over several repetitions in one run; the least is disturbed least by other programs. Of a scene, `least_us` and
// `median_us` are of the mean time of a sample in a repetition.
struct SpeedRow {
    std::string what;
    double least_us = kUnknown;
    double median_us = kUnknown;
    double p99_us = kUnknown;  // of single samples, clock included; least over the repetitions
    int repetitions = 0;
};

// Eigen's SimplicialLDLT, factorisation alone, of the 7-point Laplacian on 16 x 16 x 16 points (6.1 on the diagonal, -1
// for each neighbour). Timed now and then between what is measured, it feels the same load.
class LaplacianUnit {
  public:
    LaplacianUnit();
    ~LaplacianUnit();
    LaplacianUnit(const LaplacianUnit&) = delete;
    LaplacianUnit& operator=(const LaplacianUnit&) = delete;
    void time();
    const Timing& timing() const { return timing_; }

  private:
    struct Solver;
    std::unique_ptr<Solver> solver_;
    Timing timing_;
};
SpeedRow machine_unit(int repetitions);

// Times a simulated pen at 1,000 Hz over the scene for `seconds`, with a fresh start in each repetition. Times are per
// sample.
SpeedRow sample_speed(const scene::Scene& scene, const scene::Plan& plan, double seconds, int repetitions);

files::Json machine_json(const Machine& machine);
files::Json speed_json(const SpeedRow& unit, const std::vector<SpeedRow>& rows, const Machine& machine);
std::string speed_table(const SpeedRow& unit, const std::vector<SpeedRow>& rows);

}  // namespace palpa::accuracy
