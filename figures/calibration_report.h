#pragma once
// A calibration as JSON, as text and as a figure.

#include <filesystem>

#include "calibration/calibrate.h"
#include "files/json.h"

namespace palpa {

// What is kept in the profile as `quality`; with the model and its parameters, what `calibrate fit --json` prints.
Json quality_json(const Calibration& calibration);
Json calibration_json(const Calibration& calibration);
Json bands_json(const std::vector<ErrorBand>& bands);

void print_calibration(const Calibration& calibration);
void print_bands(const std::vector<ErrorBand>& bands, const char* of_what);

// Points, curve, its 95 % band, and the relative residuals of points left out of the fit. .png, .svg or .pdf.
void plot_calibration(const Calibration& calibration, const std::filesystem::path& file);

}  // namespace palpa
