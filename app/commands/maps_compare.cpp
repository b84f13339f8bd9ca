// palpa maps compare

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>

#include "app/commands/maps.h"
#include "figures/gnuplot.h"
#include "figures/map_figures.h"
#include "files/json.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "stiffnessmaps/map_file.h"

namespace palpa::app {
namespace {

struct CompareArguments {
    std::string a;
    std::string b;
    std::string output;
    bool json = false;
};

files::Json depth_json(const stiffnessmaps::DepthDifference& d) {
    if (d.n == 0) return {{"depth_mm", 1e3 * d.depth_m}, {"n", 0}};
    return {{"depth_mm", 1e3 * d.depth_m}, {"n", d.n},
            {"mean_a_N", d.mean_a_N},      {"bias_N", d.bias_N},
            {"median_N", d.median_N},      {"rms_N", d.rms_N},
            {"greatest_N", d.greatest_N},  {"at_mm", {1e3 * d.at_x_m, 1e3 * d.at_y_m}}};
}

files::Json difference_json(const stiffnessmaps::MapDifference& d) {
    files::Json json{{"a", d.a.name}, {"b", d.b.name}, {"grid_of", d.grid_of}, {"depths_of", d.depths_of}};
    json["shape"] = {d.a.n_depths(), d.a.n_y, d.a.n_x};
    json["origin_mm"] = {1e3 * d.a.origin_m[0], 1e3 * d.a.origin_m[1]};
    json["spacing_mm"] = {1e3 * d.a.spacing_m[0], 1e3 * d.a.spacing_m[1]};
    json["all"] = depth_json(d.all);
    json["relative"] = files::number_or_null(d.relative);
    json["correlation"] = files::number_or_null(d.correlation);
    json["depths"] = files::Json::array();
    for (const stiffnessmaps::DepthDifference& depth : d.depths) json["depths"].push_back(depth_json(depth));
    return json;
}

void print_difference(const stiffnessmaps::MapDifference& d) {
    const auto text = [](double v) { return std::isnan(v) ? std::string("n/a") : files::short_number(v); };
    std::printf("B (%s) - A (%s), normal force: %zu x %zu places of map %s (%s x %s mm), %zu depths of map %s\n",
                d.b.name.c_str(), d.a.name.c_str(), d.a.n_x, d.a.n_y, d.grid_of == "a" ? "A" : "B",
                text(1e3 * d.a.spacing_m[0]).c_str(), text(1e3 * d.a.spacing_m[1]).c_str(), d.a.n_depths(),
                d.depths_of == "a" ? "A" : "B");
    std::printf("  bias %s N, median %s N, RMS %s N (%s of A's RMS), correlation %s\n", text(d.all.bias_N).c_str(),
                text(d.all.median_N).c_str(), text(d.all.rms_N).c_str(),
                (std::isnan(d.relative) ? text(d.relative) : text(100.0 * d.relative) + " %").c_str(),
                text(d.correlation).c_str());
    std::printf("  greatest %s N at (%s, %s) mm, %s mm deep\n", text(d.all.greatest_N).c_str(),
                text(1e3 * d.all.at_x_m).c_str(), text(1e3 * d.all.at_y_m).c_str(), text(1e3 * d.all.depth_m).c_str());
    std::printf("  depth mm   places   mean of A N      bias N    median N       RMS N  greatest N\n");
    for (const stiffnessmaps::DepthDifference& depth : d.depths) {
        std::printf("  %8s %8zu %13s %11s %11s %11s %11s\n", text(1e3 * depth.depth_m).c_str(), depth.n,
                    text(depth.mean_a_N).c_str(), text(depth.bias_N).c_str(), text(depth.median_N).c_str(),
                    text(depth.rms_N).c_str(), text(depth.greatest_N).c_str());
    }
}

void run_compare(const CompareArguments& arguments) {
    if (!arguments.output.empty()) {
        figures::check_figure(arguments.output);
        files::check_output(arguments.output, {arguments.a, arguments.b});
    }
    const stiffnessmaps::MapDifference difference = stiffnessmaps::compare_maps(
        stiffnessmaps::read_map(arguments.a), arguments.a, stiffnessmaps::read_map(arguments.b), arguments.b);
    if (arguments.json) {
        std::fputs(files::json_text(difference_json(difference)).c_str(), stdout);
    } else {
        print_difference(difference);
    }
    if (!arguments.output.empty()) figures::plot_difference(difference, arguments.output);
}

}  // namespace

void add_maps_compare(CLI::App& maps) {
    auto arguments = std::make_shared<CompareArguments>();
    CLI::App* command = maps.add_subcommand("compare", "Compute the difference of two maps where both were measured");
    command->add_option("A", arguments->a, "map folder")->required();
    command->add_option("B", arguments->b, "map folder")->required();
    command->add_option("-o,--output", arguments->output, "also draw a figure: FILE.png, .svg or .pdf");
    command->add_flag("--json", arguments->json, "print one JSON object on standard output");
    command->callback([arguments] { run_compare(*arguments); });
}

}  // namespace palpa::app
