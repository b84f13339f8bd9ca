#pragma once

namespace CLI {
class App;
}

namespace palpa::app {

// Adds `palpa part`, as the functions of command_line.h add theirs.
void add_part(CLI::App& app);

}  // namespace palpa::app
