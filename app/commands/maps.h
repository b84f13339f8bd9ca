#pragma once

namespace CLI {
class App;
}

namespace palpa::app {

// Subcommands of `palpa maps` that have files of their own.
void add_maps_detect(CLI::App& maps);
void add_maps_plot(CLI::App& maps);
void add_maps_export(CLI::App& maps);
void add_maps_compare(CLI::App& maps);

}  // namespace palpa::app
