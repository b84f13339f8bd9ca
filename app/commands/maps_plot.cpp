// palpa maps plot

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>

#include "app/commands/maps.h"
#include "app/commands/option_checks.h"
#include "figures/gnuplot.h"
#include "figures/map_figures.h"
#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "stiffnessmaps/map_file.h"

namespace palpa::app {
namespace {

struct PlotArguments {
    std::string map;
    std::string output;
    std::string what = "all";
    std::vector<std::string> at;
    double force_N = 0.0;
};

Eigen::Vector2d place_of(const std::string& text) {
    const auto comma = text.find(',');
    double x_mm = 0.0;
    double y_mm = 0.0;
    const bool read = comma != std::string::npos &&
                      files::parse_number(std::string_view(text).substr(0, comma), x_mm) &&
                      files::parse_number(std::string_view(text).substr(comma + 1), y_mm);
    if (!read || !std::isfinite(x_mm + y_mm))
        throw files::bad_input("--at", "", files::shown(text), "X,Y in mm, such as 35,42.5");
    return {1e-3 * x_mm, 1e-3 * y_mm};
}

// A depth slice at a force that no place has reached would show nothing.
void check_force(const figures::PlotOptions& options, const stiffnessmaps::Map& map) {
    float most_N = 0.0F;
    for (const float force_N : map.normal_N) most_N = std::isnan(force_N) ? most_N : std::max(most_N, force_N);
    if (!options.force_N || *options.force_N <= static_cast<double>(most_N)) return;
    throw files::bad_input(
        "--force-N", "", files::short_number(*options.force_N),
        "at most " + files::short_number(static_cast<double>(most_N)) + ", the map's greatest force");
}

void run_plot(const CLI::App& command, const PlotArguments& arguments) {
    figures::check_figure(arguments.output);
    files::check_output(arguments.output, {arguments.map});
    figures::PlotOptions options;
    constexpr const char* kWhat[] = {"all", "matrices", "stiffness", "slice", "curves", "nodules"};
    for (int i = 0; i < 6; ++i) {
        if (arguments.what == kWhat[i]) options.what = static_cast<figures::PlotWhat>(i);
    }
    const bool curves = arguments.what == "curves" || arguments.what == "all";
    const bool slice = arguments.what == "slice" || arguments.what == "all";
    if (!arguments.at.empty() && !curves)
        throw files::InputError("--at: found with --what " + arguments.what + ", expected curves or all");
    if (command.count("--force-N") > 0 && !slice)
        throw files::InputError("--force-N: found with --what " + arguments.what + ", expected slice or all");
    for (const std::string& at : arguments.at) options.at_m.push_back(place_of(at));
    if (command.count("--force-N") > 0) options.force_N = arguments.force_N;
    const stiffnessmaps::Map map = stiffnessmaps::read_map(arguments.map);
    check_force(options, map);
    figures::plot_map(map, stiffnessmaps::detect_regions(map, arguments.map, {}), options, arguments.output);
}

}  // namespace

void add_maps_plot(CLI::App& maps) {
    auto arguments = std::make_shared<PlotArguments>();
    CLI::App* command = maps.add_subcommand(
        "plot", "Draw figures of a map: matrices, stiffness, depth, section, curves, nodules (with gnuplot)");
    command->add_option("MAP", arguments->map, "map folder")->required();
    command->add_option("-o,--output", arguments->output, "FILE.png, .svg or .pdf")->required();
    command
        ->add_option(
            "--what", arguments->what,
            "matrices (every depth, normal and tangential), stiffness, slice (depth at a force, section through the "
            "stiffest place), curves, nodules (with the regions that `maps detect` finds), or all")
        ->check(one_of({"all", "matrices", "stiffness", "slice", "curves", "nodules"}))
        ->capture_default_str();
    command
        ->add_option("--at", arguments->at,
                     "X,Y in mm: draw the curve at this place; repeatable (default: the stiff places and one of median "
                     "stiffness)")
        ->take_all();
    command
        ->add_option("--force-N", arguments->force_N,
                     "force of the depth slice (default: half of the cells' median greatest force)")
        ->check(CLI::Range(1e-6, 1e6));
    command->callback([command, arguments] { run_plot(*command, *arguments); });
}

}  // namespace palpa::app
