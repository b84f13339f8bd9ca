// palpa maps export

#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands/maps.h"
#include "app/commands/option_checks.h"
#include "files/input_error.h"
#include "files/regular_file.h"
#include "stiffnessmaps/export.h"
#include "stiffnessmaps/map_file.h"

namespace palpa::app {

void add_maps_export(CLI::App& maps) {
    struct Arguments {
        std::string map;
        std::string output;
        std::string array = "normal_N";
    };
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command = maps.add_subcommand("export", "Export a map's arrays for other programs: NumPy, CSV, MATLAB");
    command->add_option("MAP", arguments->map, "map folder")->required();
    command
        ->add_option("-o,--output", arguments->output,
                     "FILE.npy (one array [n_depth, n_y, n_x]), FILE.csv (a row per place and depth), FILE.mat (MATLAB "
                     "5), or a new "
                     "folder of .npy")
        ->required();
    command->add_option("--array", arguments->array, "array to write to FILE.npy")
        ->check(one_of({"normal_N", "tangential_x_N", "tangential_y_N"}))
        ->capture_default_str();
    command->callback([command, arguments] {
        const std::filesystem::path output = arguments->output;
        if (command->count("--array") > 0 && output.extension() != ".npy")
            throw files::InputError("--array: found with " + files::shown(arguments->output) +
                                    ", expected FILE.npy (other files hold all arrays)");
        if (output.has_extension()) files::check_output(arguments->output, {arguments->map});
        files::check_new(output);  // it may be the recording that the map was imported from
        stiffnessmaps::export_map(stiffnessmaps::read_map(arguments->map), arguments->array, arguments->output);
    });
}

}  // namespace palpa::app
