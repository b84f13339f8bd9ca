#pragma once
// The report of `palpa maps detect`.

#include "files/json.h"
#include "stiffnessmaps/import/detect.h"

namespace palpa::app {

files::Json detection_json(const stiffnessmaps::Map& map, const stiffnessmaps::Detection& detection);
std::string detection_text(const stiffnessmaps::Map& map, const stiffnessmaps::Detection& detection);
std::vector<std::string> detection_warnings(
    const stiffnessmaps::Detection& detection);  // of the map, and of the regions by their names

}  // namespace palpa::app
