#pragma once
// Makes a map of a recording in any of its forms.

#include <filesystem>
#include <vector>

#include "stiffnessmaps/import/options.h"

namespace palpa::stiffnessmaps {

// The form is `options.form`, or is determined from the files: tables by their columns (columns.h), arrays by their
// first bytes or as numbers without a header (arrays.h). Several files are one recording: one array per depth, or one
// table after the other. Throws InputError.
Map import_recording(const std::vector<std::filesystem::path>& files, const ImportOptions& options,
                     ImportReport& report);

}  // namespace palpa::stiffnessmaps
