#pragma once
// What recorded presses say about a device: by what factor its modulus differs from the file's, how much of a cable's tension
// its guides take, where its sensor's zero is, and how far its drives lag.

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "tangible/plant_model.h"

namespace palpa::tangible {

// PRESSES.tsv: columns time_s, depth_mm (as the sensor read it), force_N (of the finger), and for each actuator NAME_N or
// NAME_Pa (what its drive was told). Where NAME_mm is there for every cable (the length of it that its drive was told to let
// out), the cable's motion, and so the sense of friction, is taken from there, behind by the drives' lag as the forces are, and
// not from the model. The tables that `palpa tangible characterise -o` writes are such files; other columns are allowed.
struct RecordedTick {
    double time_s = 0.0;
    double depth_m = 0.0;
    double force_N = 0.0;
    Actuation actuation{};
    Lengths length{};  // of the cables, m
    bool has_lengths = false;
    Actuation sense{};  // of friction, by cable, -1 to 1; fit_presses() finds it from the lengths
};
// Throws InputError with file, line and column.
std::vector<RecordedTick> read_presses(const std::filesystem::path& tsv, const DeviceModel& model);

struct FitResult {
    DeviceFit fit;
    double rms_before_N = 0.0;  // recorded minus modelled force
    double rms_after_N = 0.0;
    std::optional<double> lag_error_s;  // standard error of a lag that was seen; a lag at its bound 0 has none
    int ticks = 0;                      // that were used
    int rounds = 0;                     // of the Gauss-Newton method
    bool settled = false;
};

// Fits by the Gauss-Newton method on converged equilibria of the device file's model, at most `most` ticks. The
// friction and the lag are seen from the difference of pressing and releasing, the one by its sense and the other by its speed;
// without cables the friction stays 0. The lag is fitted only if that is asked for, and else the device's own stays: a sensor
// that is late looks like a lag, and where the actuators hardly move none can be seen. One of less than three standard
// errors, or far below the time between two rows, is taken for none. Throws std::runtime_error
// where the presses do not tell (fewer than 20 ticks in contact, a depth that stays, or no equilibrium at most of them).
struct FitOptions {
    bool lag = false;
    std::size_t most = 60;
    std::function<void(double share)> progress{};  // told the share done, on the way to the most rounds
};
FitResult fit_presses(const SoftDevice& device, const std::vector<RecordedTick>& ticks, const FitOptions& options = {});

}  // namespace palpa::tangible
