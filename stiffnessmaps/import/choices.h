#pragma once
// Writes down what was chosen, so that it stands in the map.

#include <string>

#include "stiffnessmaps/map.h"

namespace palpa::stiffnessmaps {

using ChoiceValue = std::variant<double, std::string, std::vector<double>>;

// `stated`: by the person, which is then all that is said of why.
inline void add_choice(MapSource& source, std::string key, ChoiceValue value, std::string how, std::string option,
                       bool stated = false) {
    if (stated) how = "as asked for";
    source.choices.push_back({std::move(key), std::move(value), std::move(how), std::move(option)});
}

// 1.5802469 mm becomes 1.580247: what is chosen is told to the nanometre.
double choice_mm(double metres);
std::vector<double> choice_mm(const std::vector<double>& metres);

}  // namespace palpa::stiffnessmaps
