// palpa bench accuracy mechanics|parts|tactile|tangible

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "accuracy/accuracy.h"
#include "accuracy/mechanics.h"
#include "accuracy/parts.h"
#include "accuracy/tactile.h"
#ifdef PALPA_TANGIBLE
#include "accuracy/tangible.h"
#endif
#include "app/assets.h"
#include "app/commands/command_line.h"
#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/text.h"

namespace palpa::app {
namespace {

struct AccuracyOptions {
    std::string folder;
    bool quick = false;
    bool json = false;
};

// Checked before the minutes of measuring, not after them.
void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder))
        throw files::InputError("-o " + folder.string() + ": found " + (error ? error.message() : "a file") +
                                ", expected a folder or a name for one");
}

using Measurements = std::vector<accuracy::Measurement>;

accuracy::Effort effort_of(const AccuracyOptions& options) {
    return {options.quick, options.quick ? 0.05 : 0.8, options.quick ? 0.05 : 0.6};
}

Measurements mechanics_list(const accuracy::Effort& effort) {
    Measurements list = accuracy::slab_measurements(effort);
    for (const auto& more : {accuracy::contact_measurements(effort), accuracy::step_measurements(effort)})
        list.insert(list.end(), more.begin(), more.end());
    return list;
}

// Measures a list and writes NAME.csv; all but the shape display have a figure too.
void run_accuracy(const AccuracyOptions& options, const Measurements& list, const std::string& name) {
    if (!options.folder.empty()) {
        files::check_output_folder(options.folder);
        make_folder(options.folder);
        files::check_new(std::filesystem::path(options.folder) / (name + ".csv"));  // an earlier run took minutes too
    }
    const accuracy::Machine machine = accuracy::this_machine();
    const std::vector<accuracy::AccuracyRow> rows = accuracy::run_measurements(list);
    if (options.json) {
        std::printf("%s\n", accuracy::accuracy_json(rows, machine).dump(2).c_str());
    } else {
        std::printf("%s, %u threads, load %s, %s\n%s", machine.processor.c_str(), machine.threads,
                    files::short_number(machine.load).c_str(), machine.date.c_str(),
                    accuracy::accuracy_table(rows).c_str());
    }
    if (options.folder.empty()) return;
    files::write_text_atomically(std::filesystem::path(options.folder) / (name + ".csv"), accuracy::accuracy_csv(rows));
    std::string trouble = "no figure";
    if (name == "mechanics") trouble = accuracy::plot_mechanics(options.folder, machine);
    if (name == "parts") trouble = accuracy::plot_parts(options.folder, machine);
#ifdef PALPA_TANGIBLE
    if (name == "tangible") trouble = accuracy::plot_tangible(options.folder, machine);
#endif
    if (name == "tactile")
        std::fprintf(stderr, "%s: tactile.csv\n", options.folder.c_str());
    else if (!trouble.empty())
        std::fprintf(stderr, "palpa: %s\n", trouble.c_str());
    else
        std::fprintf(stderr, "%s: %s.csv, .gp, .png, .svg, .pdf\n", options.folder.c_str(), name.c_str());
}

}  // namespace

void add_bench_accuracy(CLI::App& bench) {
    auto options = std::make_shared<AccuracyOptions>();
    CLI::App* accuracy = bench.add_subcommand("accuracy", "Measure what accuracy costs in time");
    accuracy->require_subcommand(1);
    CLI::App* mechanics = accuracy->add_subcommand(
        "mechanics",
        "Measure error and cost of each choice: element, mesh, contact, friction, solver, precomputed or live");
    mechanics->add_option("-o,--output", options->folder,
                          "folder for mechanics.csv and its figure (default: nothing is written)");
    mechanics->add_flag("--quick", options->quick,
                        "use small meshes only, which takes under 20 s (all meshes: 4 minutes)");
    mechanics->add_flag("--json", options->json, "print one JSON object on standard output");
    mechanics->callback([options] { run_accuracy(*options, mechanics_list(effort_of(*options)), "mechanics"); });
    CLI::App* parts = accuracy->add_subcommand(
        "parts", "Measure error and cost of multi-material parts: beams, finite cells, buttons, multigrid");
    parts->add_option("-o,--output", options->folder,
                      "folder for parts.csv and its figure (default: nothing is written)");
    parts->add_flag("--quick", options->quick, "use small meshes only (10 s; all meshes: two minutes)");
    parts->add_flag("--json", options->json, "print one JSON object on standard output");
    parts->callback([options] { run_accuracy(*options, accuracy::part_measurements(effort_of(*options)), "parts"); });
    CLI::App* tactile = accuracy->add_subcommand(
        "tactile", "Measure error and cost of the shape display's choices: contact, table, sheet, steps, schedule");
    tactile->add_option("-o,--output", options->folder, "folder for tactile.csv (default: nothing is written)");
    tactile->add_flag("--quick", options->quick, "use small meshes only (10 s; all meshes: a minute)");
    tactile->add_flag("--json", options->json, "print one JSON object on standard output");
    tactile->callback(
        [options] { run_accuracy(*options, accuracy::tactile_measurements(effort_of(*options)), "tactile"); });
#ifdef PALPA_TANGIBLE
    CLI::App* tangible = accuracy->add_subcommand(
        "tangible",
        "Measure the rendered force and the cost of a soft device's choices: mesh, law, fidelity, command, sensor");
    tangible->add_option("-o,--output", options->folder,
                         "folder for tangible.csv and its figure (default: nothing is written)");
    tangible->add_flag("--quick", options->quick, "use faster presses and fewer meshes");
    tangible->add_flag("--json", options->json, "print one JSON object on standard output");
    tangible->callback([options] {
        run_accuracy(*options, accuracy::tangible_measurements(effort_of(*options), assets_folder() / "devices"),
                     "tangible");
    });
#endif
}

}  // namespace palpa::app
