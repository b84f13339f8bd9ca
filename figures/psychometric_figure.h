#pragma once
// The figure of psychometric functions, by gnuplot: the shares of answers at each level, and the curve through them.

#include <filesystem>
#include <string>

#include "study/report.h"

namespace palpa::figures {

// Writes psychometric.gp, which holds its data, and draws psychometric as .svg, .pdf and .png: one panel for each
// condition, with the answers and the curve of all people and, thin, each person's curve. Nothing without psychometric
// functions. Returns what went wrong, or "". Throws std::runtime_error if psychometric.gp cannot be written.
std::string draw_psychometric_figure(const study::Report& report, const std::filesystem::path& folder);

// The script alone.
std::string psychometric_script(const study::Report& report);

}  // namespace palpa::figures
