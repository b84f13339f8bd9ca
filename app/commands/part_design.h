#pragma once

namespace CLI {
class App;
}

namespace palpa::app {

// Add `palpa part edit`, `compare` and `export` to `palpa part`.
void add_part_edit(CLI::App& part);
void add_part_compare(CLI::App& part);
void add_part_export(CLI::App& part);

}  // namespace palpa::app
