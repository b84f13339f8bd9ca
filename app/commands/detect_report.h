#pragma once
// What `palpa maps detect` says.

#include "files/json.h"
#include "stiffnessmaps/import/detect.h"

namespace palpa {

Json detection_json(const Map& map, const Detection& detection);
std::string detection_text(const Map& map, const Detection& detection);
std::vector<std::string> detection_warnings(const Detection& detection);  // of the map, and of the regions by their names

}  // namespace palpa
