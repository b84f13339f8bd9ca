#pragma once
// The key `button` of a part file, and measured curves of buttons.

#include "files/json.h"
#include "files/table.h"
#include "mechanics/button.h"
#include "parts/part_file.h"

namespace palpa::parts {

// Reads the object after the key `button` (docs/parts.md). `part` gives the materials, and the folder in which a curve is
// looked for. Throws InputError, also for off after on where the file names both.
mechanics::Button read_button(files::JsonReader json, const Part& part);

// Reads a measured support: columns travel_mm, press_N, release_N, one row per travel, ascending from 0, release_N at most
// press_N. Throws InputError with file, line and column.
mechanics::MeasuredSupport read_curve(files::Table& table);

// press_button() of the part's button. Throws InputError for a part without one, and what press_button() refuses.
mechanics::ButtonCurve button_curve(const Part& part);

// The same, with the cover's table from the cache (files/cache.h; empty: no cache) if it is there; else it is left there.
// `warning`: what write_cache() says, if it says anything.
mechanics::ButtonCurve button_curve(const Part& part, const std::filesystem::path& cache, std::string& warning);

}  // namespace palpa::parts
