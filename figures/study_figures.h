#pragma once
// The figures of a study, by gnuplot: sensitivity, sensitivity by nodule, and positive predictive value, as in figures
// 11, 12 and 13 of Li et al.

#include <filesystem>
#include <string>

#include "study/report.h"

namespace palpa::figures {

// Writes figures.gp beside the report's .tsv tables, which must be in `folder` already, and draws sensitivity, nodules
// and ppv as .svg, .pdf and .png. Returns what went wrong, or "". Throws std::runtime_error if figures.gp cannot be
// written.
std::string draw_figures(const study::Report& report, const std::filesystem::path& folder);

}  // namespace palpa::figures
