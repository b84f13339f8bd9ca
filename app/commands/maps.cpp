// palpa maps info | sample | import | generate, and the subcommands of app/commands/maps.h

#include "app/commands/maps.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <thread>

#include "app/commands/command_line.h"
#include "app/commands/map_info.h"
#include "app/commands/option_checks.h"
#include "files/input_error.h"
#include "files/text.h"
#include "stiffnessmaps/field.h"
#include "stiffnessmaps/generate/generate.h"
#include "stiffnessmaps/map_file.h"

namespace palpa::app {
namespace {

void print_info(const stiffnessmaps::Map& map, const files::Json& info) {
    const stiffnessmaps::ForceRange range = stiffnessmaps::force_range(map);
    std::printf("%s: %zu x %zu cells, %zu depths to %s mm\n", map.name.c_str(), map.n_x, map.n_y, map.n_depths(),
                files::short_number(1e3 * map.depths_m.back()).c_str());
    std::printf("  cells       %s x %s mm from x %s, y %s mm\n", files::short_number(1e3 * map.spacing_m[0]).c_str(),
                files::short_number(1e3 * map.spacing_m[1]).c_str(), files::short_number(1e3 * map.origin_m[0]).c_str(),
                files::short_number(1e3 * map.origin_m[1]).c_str());
    std::printf("  force       %s to %s N, %zu of %zu not measured\n", files::short_number(range.lowest_N).c_str(),
                files::short_number(range.highest_N).c_str(), stiffnessmaps::missing_count(map), map.normal_N.size());
    std::printf("  isotonic    %s forces changed at look-up, so that none is below a shallower one (raw values kept)\n",
                info["changed_by_isotonic_regression"].dump().c_str());
    std::printf("  noise       %s; the avatar's laws then smooth by %s mm\n",
                info["noise_N"].is_null() ? "not known (too few neighbours)"
                                          : ("about " + files::short_number(1e3 * info["noise_N"].get<double>()) +
                                             " mN (changes of the tissue between places count too)")
                                                .c_str(),
                files::short_number(info["smoothing_mm"].get<double>()).c_str());
    std::printf("  tangential  %s\n", name_of(map.tangential));
    if (info.contains("tangential_against_energy")) {
        const files::Json& agreement = info["tangential_against_energy"];
        const double r = agreement["correlation"].get<double>();
        const double slope = agreement["slope"].get<double>();
        std::printf("  recorded tangential force against the energy's slope: correlation %.2f, slope %.2f\n", r, slope);
        // in a simulated slide, friction makes the force differ from the slope; that is no error of a recording
        if (map.source.kind == stiffnessmaps::SourceKind::recorded && (r < 0.5 || slope < 0.5 || slope > 2.0)) {
            std::fprintf(stderr, "palpa: warning: recorded tangential force and the work argument disagree\n");
        }
    }
    std::printf("  indenter    %s, radius %s mm\n", name_of(map.indenter),
                files::short_number(1e3 * map.indenter_radius_m).c_str());
    for (const stiffnessmaps::Nodule& nodule : map.nodules) {
        std::printf("  nodule %-4s (%s, %s) mm, %s\n", nodule.id.c_str(), files::short_number(1e3 * nodule.x_m).c_str(),
                    files::short_number(1e3 * nodule.y_m).c_str(), nodule.placed ? "placed" : "detected");
    }
    std::printf("  source      %s: %s\n", name_of(map.source.kind), map.source.how.c_str());
}

// Such a map is soft everywhere, since look-up takes no force below zero.
void warn_of_sign(const stiffnessmaps::Map& map, const std::string& name) {
    if (stiffnessmaps::force_range(map).highest_N > 0.0) return;
    std::fprintf(stderr, "palpa: warning: %s: found no force above zero, expected pressing to be positive\n",
                 name.c_str());
}

struct InfoOptions {
    std::string map;
    bool json = false;
};

void add_info(CLI::App& maps) {
    auto options = std::make_shared<InfoOptions>();
    CLI::App* command = maps.add_subcommand("info", "Show a map's cells, depths, forces, noise and source");
    command->add_option("MAP", options->map, "map folder")->required();
    command->add_flag("--json", options->json,
                      "print one JSON object: map.json with shape, missing, force_range_N, ...");
    command->callback([options] {
        const stiffnessmaps::Map map = stiffnessmaps::read_map(options->map);
        warn_of_sign(map, options->map);
        const files::Json info = map_info(map, stiffnessmaps::make_field(map, {}));
        if (options->json) {
            std::fputs(files::json_text(info).c_str(), stdout);
        } else {
            print_info(map, info);
        }
    });
}

struct SampleOptions {
    std::string map;
    double x_mm = 0.0;
    double y_mm = 0.0;
    std::optional<double> force_N;
    std::optional<double> depth_mm;
    bool json = false;
};

void sample_map(const SampleOptions& options) {
    const stiffnessmaps::Map map = stiffnessmaps::read_map(options.map);
    warn_of_sign(map, options.map);
    const stiffnessmaps::Field field = stiffnessmaps::make_field(map, {});
    const stiffnessmaps::Place place = stiffnessmaps::place_at(field, {1e-3 * options.x_mm, 1e-3 * options.y_mm});
    stiffnessmaps::DepthAnswer answer;
    if (options.force_N) {
        answer = stiffnessmaps::depth_at(field, place, *options.force_N);
    } else {
        const double greatest_m = stiffnessmaps::greatest_depth_m(field, place);
        answer.saturated = 1e-3 * *options.depth_mm > greatest_m;
        answer.depth_m = std::min(1e-3 * *options.depth_mm, greatest_m);
    }
    const double force_N = options.force_N.value_or(stiffnessmaps::normal_force_N(field, place, answer.depth_m));
    const double along_x_N = stiffnessmaps::tangential_force_N(field, place, {1.0, 0.0}, answer.depth_m);
    const double along_y_N = stiffnessmaps::tangential_force_N(field, place, {0.0, 1.0}, answer.depth_m);
    if (options.json) {
        const files::Json json{{"x_mm", options.x_mm},
                               {"y_mm", options.y_mm},
                               {"force_N", force_N},
                               {"depth_mm", 1e3 * answer.depth_m},
                               {"resists_x_N", along_x_N},
                               {"resists_y_N", along_y_N},
                               {"saturated", answer.saturated},
                               {"inside", place.inside},
                               {"measured", place.measured}};
        std::fputs(files::json_text(json).c_str(), stdout);
    } else {
        std::printf("force %.6g N, depth %.6g mm, resists +x with %.4g N, +y with %.4g N\n", force_N,
                    1e3 * answer.depth_m, along_x_N, along_y_N);
    }
    const char* name = options.map.c_str();
    if (answer.saturated)
        std::fprintf(stderr, "palpa: %s: deeper than recorded here, shown at the greatest depth\n", name);
    if (!place.inside) std::fprintf(stderr, "palpa: %s: outside the map, taken at its edge\n", name);
    if (place.inside && !place.measured)
        std::fprintf(stderr, "palpa: %s: not measured here, taken from the neighbours\n", name);
}

void add_sample(CLI::App& maps) {
    auto options = std::make_shared<SampleOptions>();
    CLI::App* command =
        maps.add_subcommand("sample",
                            "Look up the depth for a force, or the force for a depth, at one place, and how the tissue "
                            "resists the avatar there (by the slope of its energy; the arrays of tangential force are "
                            "shown by `palpa maps export`)");
    command->add_option("MAP", options->map, "map folder")->required();
    command->add_option("--x-mm", options->x_mm, "x of the place in the map's frame")
        ->required()
        ->check(CLI::Range(-1e6, 1e6));
    command->add_option("--y-mm", options->y_mm, "y of the place in the map's frame")
        ->required()
        ->check(CLI::Range(-1e6, 1e6));
    CLI::Option_group* what = command->add_option_group("what", "one of these");
    what->add_option("--force-N", options->force_N, "normal force to look up")->check(CLI::Range(0.0, 1e6));
    what->add_option("--depth-mm", options->depth_mm, "indentation depth to look up")->check(CLI::Range(0.0, 1e6));
    what->require_option(1);
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->callback([options] { sample_map(*options); });
}

struct GenerateArguments {
    stiffnessmaps::GenerateOptions options;
    std::string phantom;
    std::string output;
    std::string method = "fem";
    std::string part;
    int jobs = 0;
    int window = -1;
};

stiffnessmaps::GenerateOptions generate_options(const GenerateArguments& arguments) {
    stiffnessmaps::GenerateOptions options = arguments.options;
    options.phantom = arguments.phantom;
    options.output = arguments.output;
    options.analytic = arguments.method == "analytic";
    if (arguments.window >= 0) options.window = arguments.window;
    if (!arguments.part.empty()) {
        options.part = stiffnessmaps::parse_part(arguments.part);
    } else if (arguments.jobs == 0 && !options.merge && !options.window) {
        options.part = stiffnessmaps::part_from_environment();
    }
    const auto cores = static_cast<int>(std::thread::hardware_concurrency());
    options.jobs = arguments.jobs > 0 ? arguments.jobs : std::max(1, cores);
    return options;
}

void add_generate(CLI::App& maps) {
    auto arguments = std::make_shared<GenerateArguments>();
    stiffnessmaps::GenerateOptions& options = arguments->options;
    CLI::App* command = maps.add_subcommand("generate", "Compute a map from a phantom by virtual rolling indentation");
    command->add_option("PHANTOM", arguments->phantom, "phantom JSON")->required();
    command->add_option("-o,--output", arguments->output, "new map folder NAME.map")->required();
    command
        ->add_option("--method", arguments->method,
                     "fem (finite elements), or analytic (a closed-form stand-in, at once)")
        ->check(one_of({"fem", "analytic"}))
        ->capture_default_str();
    CLI::Option* jobs =
        command->add_option("-j,--jobs", arguments->jobs, "number of processes (default: one for each core)")
            ->check(CLI::Range(1, 1024));
    CLI::Option* part = command->add_option(
        "--part", arguments->part,
        "i/n: compute only this share of the lines, into NAME.map.lines (default on a cluster: from Slurm or OpenMPI)");
    CLI::Option* merge = command->add_flag("--merge", options.merge, "join the finished lines into the map");
    command->add_flag("--check", options.check,
                      "compare the new or existing map with a mesh refined once, at up to 50 points (takes minutes)");
    command
        ->add_option("--coarseness", options.coarseness,
                     "factor on the mesh spacings: 1 for maps, up to 4 for a quick look")
        ->check(CLI::Range(0.5, 4.0))
        ->capture_default_str();
    command->add_option("--window", arguments->window)->check(CLI::Range(0, 1000000))->group("");
    command->add_flag_callback("--refined", [&options] { options.meshes = stiffnessmaps::MeshSet::refined; })
        ->group("");
    command->add_flag_callback("--coarser", [&options] { options.meshes = stiffnessmaps::MeshSet::coarser; })
        ->group("");
    part->excludes(jobs)->excludes(merge);
    command->callback([command, arguments] {
        for (const char* name : {"--jobs", "--part", "--merge", "--check", "--coarseness"}) {
            if (arguments->method == "analytic" && command->count(name) > 0)
                throw files::InputError(std::string(name) + ": found with --method analytic, expected --method fem");
        }
        const stiffnessmaps::GenerateOptions asked = generate_options(*arguments);
        if (asked.check && asked.part)
            throw files::InputError(
                "--check: found with a part (of --part, SLURM_ARRAY_TASK_ID or OMPI_COMM_WORLD_RANK), expected a "
                "whole map: check it once its parts are joined");
        if (asked.analytic && asked.part)
            throw files::InputError(
                "SLURM_ARRAY_TASK_ID or OMPI_COMM_WORLD_RANK: found with --method analytic, expected "
                "one process, since such a map has no parts");
        stiffnessmaps::generate_map(asked);
    });
}

}  // namespace

void add_maps(CLI::App& app) {
    CLI::App* maps =
        app.add_subcommand("maps", "Stiffness maps: info, sample, import, generate, detect, plot, export, compare");
    maps->require_subcommand(1);
    add_info(*maps);
    add_sample(*maps);
    add_maps_import(*maps);
    add_generate(*maps);
    add_maps_detect(*maps);
    add_maps_plot(*maps);
    add_maps_export(*maps);
    add_maps_compare(*maps);
}

}  // namespace palpa::app
