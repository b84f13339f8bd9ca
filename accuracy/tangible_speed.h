#pragma once
// The cost of the inverse step of soft devices (tangible/inverse.h), in units of the machine that are measured between
// the steps.

#include <filesystem>

#include "accuracy/accuracy.h"
#include "accuracy/speed.h"

namespace palpa::accuracy {

struct TangibleSpeedRow {
    std::string what;
    double median_ms = kUnknown;
    double p99_ms = kUnknown;
    double units = kUnknown;        // median over the unit's median
    double peer_units = kUnknown;   // of SOFA with SoftRobots.Inverse, one thread, in the same units; NaN: none known
    double bound_units = kUnknown;  // what it must stay below
    double force_error_percent = kUnknown;  // rms against the fidelity `converged`, of the greatest force
    double allocated_MB = kUnknown;         // heap that model and state keep
};

struct TangibleSpeed {
    double unit_ms = kUnknown;  // median
    std::vector<TangibleSpeedRow> rows;
};

// Presses of 6 mm there and back at 100 Hz on strip.json and accordion.json of a folder. Throws InputError.
TangibleSpeed tangible_speed(const std::filesystem::path& devices);

files::Json tangible_speed_json(const TangibleSpeed& speed, const Machine& machine);
std::string tangible_speed_table(const TangibleSpeed& speed);

}  // namespace palpa::accuracy
