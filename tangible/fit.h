#pragma once
// What recorded presses say about a device: by what factor its modulus differs from the file's, how much of a cable's tension
// its guides take, and where its sensor's zero is.

#include <filesystem>
#include <vector>

#include "tangible/plant_model.h"

namespace palpa::tangible {

// PRESSES.tsv: columns time_s, depth_mm (as the sensor read it), force_N (of the finger), and for each actuator NAME_N or
// NAME_Pa (what its drive was told). Where NAME_mm is there for every cable (how much of it was wound out), its motion, and so
// the sense of friction, is taken from there, and not from the model. The tables that `palpa tangible characterise -o` writes
// are such files; other columns are allowed.
struct RecordedTick {
    double time_s = 0.0;
    double depth_m = 0.0;
    double force_N = 0.0;
    Actuation actuation{};
    Actuation sense{};  // of friction, by cable, -1 to 1
    bool has_sense = false;
};
// Throws InputError with file, line and column.
std::vector<RecordedTick> read_presses(const std::filesystem::path& tsv, const DeviceModel& model);

struct FitResult {
    DeviceFit fit;
    double rms_before_N = 0.0;  // recorded minus modelled force
    double rms_after_N = 0.0;
    int ticks = 0;   // that were used
    int rounds = 0;  // of the Gauss-Newton method
    bool settled = false;
};

// Fits by the Gauss-Newton method on converged equilibria of the device file's model, at most `kMostFitted` ticks. The
// friction is seen from the difference of pressing and releasing; without cables it stays 0. Throws std::runtime_error
// where the presses do not tell (fewer than 20 ticks in contact, or no equilibrium at most of them).
inline constexpr int kMostFitted = 60;
FitResult fit_presses(const SoftDevice& device, const std::vector<RecordedTick>& ticks);

}  // namespace palpa::tangible
