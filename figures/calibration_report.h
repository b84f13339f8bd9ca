#pragma once
// A calibration as JSON, as text and as a figure.

#include <filesystem>

#include "calibration/calibrate.h"
#include "files/json.h"

namespace palpa::figures {

// quality_json() is what the profile keeps as `quality`; calibration_json() adds the model and its parameters, and is
// what `calibrate fit --json` prints.
files::Json quality_json(const calibration::Calibration& calibration);
files::Json calibration_json(const calibration::Calibration& calibration);
files::Json bands_json(const std::vector<calibration::ErrorBand>& bands);

void print_calibration(const calibration::Calibration& calibration);
void print_bands(const std::vector<calibration::ErrorBand>& bands, const char* of_what);

// Draws points, curve, its 95 % band, and the relative residuals of points left out of the fit, to .png, .svg or .pdf.
// Throws as draw_figure() does.
void plot_calibration(const calibration::Calibration& calibration, const std::filesystem::path& file);

}  // namespace palpa::figures
