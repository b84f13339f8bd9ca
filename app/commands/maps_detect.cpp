// palpa maps detect

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/commands/detect_report.h"
#include "app/commands/maps.h"
#include "files/text.h"
#include "stiffnessmaps/map_file.h"

namespace palpa::app {
namespace {

struct DetectArguments {
    std::string map;
    double threshold = 0.0;
    double window_mm = 20.0;
    double smoothing_mm = 0.0;
    double smallest_mm = 0.0;
    double deepest_mm = 0.0;
    bool write = false;
    bool json = false;
};

void run_detect(const CLI::App& command, const DetectArguments& arguments) {
    stiffnessmaps::Map map = stiffnessmaps::read_map(arguments.map);
    stiffnessmaps::DetectOptions options;
    options.window_m = 1e-3 * arguments.window_mm;
    if (command.count("--threshold") > 0) options.threshold = arguments.threshold;
    if (command.count("--smoothing-mm") > 0) options.smoothing_m = 1e-3 * arguments.smoothing_mm;
    if (command.count("--smallest-mm") > 0) options.smallest_m = 1e-3 * arguments.smallest_mm;
    if (command.count("--deepest-mm") > 0) options.deepest_m = 1e-3 * arguments.deepest_mm;
    const stiffnessmaps::Detection detection = stiffnessmaps::detect_regions(map, arguments.map, options);
    if (arguments.write) {
        stiffnessmaps::keep_regions(detection, map);
        stiffnessmaps::replace_map_json(map, arguments.map);
    }
    if (arguments.json) {
        std::fputs(files::json_text(detection_json(map, detection)).c_str(), stdout);
    } else {
        std::fputs(detection_text(map, detection).c_str(), stdout);
        if (arguments.write)
            std::printf("%s: map.json now holds %zu detected\n", arguments.map.c_str(), detection.sure());
    }
    for (const std::string& warning : detection_warnings(detection)) {
        std::fprintf(stderr, "palpa: warning: %s: %s\n", arguments.map.c_str(), warning.c_str());
    }
}

}  // namespace

void add_maps_detect(CLI::App& maps) {
    auto arguments = std::make_shared<DetectArguments>();
    CLI::App* command =
        maps.add_subcommand("detect", "Find the stiff regions of a map, and whether its noise allows the claim");
    command->add_option("MAP", arguments->map, "map folder")->required();
    command
        ->add_option("--threshold", arguments->threshold,
                     "stiffness / background from which a cell counts, above 1 (default: 3 spreads of the excess, at "
                     "least 1.03)")
        ->check(CLI::Range(1.0, 1e6));
    command
        ->add_option("--window-mm", arguments->window_mm,
                     "radius of the background's running median; a region may take up to half of it")
        ->check(CLI::Range(1e-3, 1e6))
        ->capture_default_str();
    command
        ->add_option("--smoothing-mm", arguments->smoothing_mm,
                     "sigma of the Gaussian smoothing (default: half the indenter's radius)")
        ->check(CLI::Range(0.0, 1e3));
    command
        ->add_option("--smallest-mm", arguments->smallest_mm,
                     "diameter of a disc; regions of a smaller area are left out (default: the indenter's radius)")
        ->check(CLI::Range(0.0, 1e6));
    command->add_option("--deepest-mm", arguments->deepest_mm, "leave out forces deeper than this (default: use all)")
        ->check(CLI::Range(0.0, 1e6));
    command->add_flag("--write", arguments->write,
                      "store the sure regions in map.json as nodules of origin `detected`; they replace earlier "
                      "detected ones, placed ones stay");
    command->add_flag("--json", arguments->json, "print one JSON object on standard output");
    command->callback([command, arguments] { run_detect(*command, *arguments); });
}

}  // namespace palpa::app
