#pragma once
// Records in the map what was chosen at its import.

#include <string>

#include "stiffnessmaps/map.h"

namespace palpa::stiffnessmaps {

using ChoiceValue = std::variant<double, std::string, std::vector<double>>;

inline constexpr const char* kAsAskedFor = "as asked for";

// `stated`: the person chose the value, which then is the only reason given.
inline void add_choice(MapSource& source, std::string key, ChoiceValue value, std::string how, std::string option,
                       bool stated = false) {
    if (stated) how = kAsAskedFor;
    source.choices.push_back({std::move(key), std::move(value), std::move(how), std::move(option)});
}

// Returns millimetres rounded to the nanometre: 1.5802469 mm becomes 1.580247.
double choice_mm(double metres);
std::vector<double> choice_mm(const std::vector<double>& metres);

}  // namespace palpa::stiffnessmaps
