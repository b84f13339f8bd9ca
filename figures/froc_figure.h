#pragma once
// The figure of free-response curves, by gnuplot: the share of lesions found against false marks a case.

#include <filesystem>
#include <string>

#include "study/report.h"

namespace palpa::figures {

// Writes froc.gp, which holds its data, and draws froc as .svg, .pdf and .png: one curve for each of the first 12 conditions,
// of all people pooled. Nothing without marks and ratings. Returns what went wrong, or "". Throws std::runtime_error if
// froc.gp cannot be written.
std::string draw_froc_figure(const study::Report& report, const std::filesystem::path& folder);

// The script alone.
std::string froc_script(const study::Report& report);

}  // namespace palpa::figures
