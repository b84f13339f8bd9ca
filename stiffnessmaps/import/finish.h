#pragma once
// What every form of recording ends with: checks, the filled copy, noise, tangential force, and how far the
// map is from what was recorded.

#include <string>

#include "stiffnessmaps/import/gridding.h"

namespace palpa::stiffnessmaps {

// What was recorded, to hold against the map.
struct RecordedPoints {
    std::vector<double> x_m;
    std::vector<double> y_m;
    std::vector<float> depth_m;
    std::vector<float> force_N;
    void reserve(std::size_t n) {
        x_m.reserve(n);
        y_m.reserve(n);
        depth_m.reserve(n);
        force_N.reserve(n);
    }
    void add(double x, double y, double depth, double force) {
        x_m.push_back(x);
        y_m.push_back(y);
        depth_m.push_back(static_cast<float>(depth));
        force_N.push_back(static_cast<float>(force));
    }
};

// Grid and depths of a new map.
void start_map(const GridPlan& plan, Map& map);

// More cells than samples is a pitch that is too fine.
void check_enough_samples(const GridPlan& plan, std::size_t n_samples, const std::string& file);

// A map without gaps: between measured depths linear (from (0, 0) on); beyond a cell's deepest measurement,
// and in cells without any, each layer's step in force is the mean of the neighbours' steps. Layers without
// any force stay as they are above. [depth][y][x].
std::vector<float> filled_forces(const Map& map);

// Refuses a map without forces, or whose forces fall with depth; then fills, estimates the noise, derives the
// tangential force where asked for, writes its choices, and measures the residual. `measured_tangential`: the
// map has arrays of its own. `recorded` empty: the map's numbers are the recording.
void finish_map(Map& map, const RecordedPoints& recorded, bool measured_tangential, const ImportOptions& options,
                const std::string& file, ImportReport& report);

// |map - recording| at every recorded point that is not deeper than the map there.
ImportResidual residual_of(const Map& map, const RecordedPoints& recorded);

// The same where the recorded points are the map's own numbers: what making them rise with depth changes.
ImportResidual residual_of_numbers(const Map& map);

}  // namespace palpa::stiffnessmaps
