#pragma once
// The steps with which every form of recording becomes a map: checks, the filled copy, noise, tangential force, and the
// residual against the recording.

#include <optional>
#include <string>

#include "stiffnessmaps/import/gridding.h"

namespace palpa::stiffnessmaps {

// The recorded points, to be compared with the map.
struct RecordedPoints {
    std::vector<double> x_m;
    std::vector<double> y_m;
    std::vector<float> depth_m;
    std::vector<float> force_N;
    // along x and y, as in Samples: one for each point, or none
    std::vector<float> tangential_N[2];
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

// Sets the grid and the depths of a new map.
void start_map(const GridPlan& plan, Map& map);

// Throws InputError if there are over 10000 more cells than samples: the pitch is then too fine.
void check_enough_samples(const GridPlan& plan, std::size_t n_samples, const std::string& file);

// Returns the normal forces without gaps, [depth][y][x]. Between measured depths they are linear (from (0, 0) on);
// beyond a cell's deepest measurement, and in cells without any, each layer's step in force is the mean of the
// neighbours' steps. A layer without any force repeats the layer above.
std::vector<float> filled_forces(const Map& map);

// Throws InputError for a map without forces, also at one of its depths, with a median force at the greatest depths that
// is not above 0, or with a size that is implausible (columns.h). Then
// derives the tangential force if asked for, fills gaps, estimates the noise, records the choices, and measures the
// residual. `measured_tangential`: the map has measured tangential arrays. `recorded` empty: the map's numbers are the
// recording.
void finish_map(Map& map, const RecordedPoints& recorded, bool measured_tangential, const ImportOptions& options,
                const std::string& file, ImportReport& report);

// Returns |map - recording| over all recorded points that are not deeper than the map there.
ImportResidual residual_of(const Map& map, const RecordedPoints& recorded);

// The same for the measured tangential forces, where the map has them; nothing if it was compared at no point.
std::optional<ImportResidual> tangential_residual_of(const Map& map, const RecordedPoints& recorded);

// The same as residual_of() if the recorded points are the map's own numbers: how much isotonic regression changes them.
ImportResidual residual_of_numbers(const Map& map);

}  // namespace palpa::stiffnessmaps
