#pragma once

#include <string>

#include "parts/part_file.h"

namespace CLI {
class App;
}

namespace palpa::app {

// Adds `palpa part`, as the functions of command_line.h add theirs.
void add_part(CLI::App& app);

// Prints a part's warnings.
void say_warnings(const parts::Part& part);
// Reads a part (parts/part_file.h) and prints its warnings.
parts::Part read_part_aloud(const std::string& file);

// Add commands of `palpa part` to it.
void add_part_evaluate(CLI::App& part);
void add_part_button(CLI::App& part);

}  // namespace palpa::app
