// palpa part evaluate

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "app/commands/option_checks.h"
#include "app/commands/part.h"
#include "files/input_error.h"
#include "files/json.h"
#include "files/printable.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "parts/edit.h"
#include "parts/stiffness.h"

namespace palpa::app {
namespace {

using parts::Method;

struct EvaluateOptions {
    std::string file;
    std::string out;
    std::string load;
    std::vector<std::string> methods;
    double cell_mm = 0.0;  // 0: the part's
    double tolerance = 1e-3;
    bool json = false;
};

const parts::PartLoad& load_named(const parts::Part& part, const std::string& name) {
    std::string known;
    for (const parts::PartLoad& load : part.loads) {
        if (load.name == name || (name.empty() && part.loads.size() == 1)) return load;
        known += (known.empty() ? "" : ", ") + load.name;
    }
    if (part.loads.empty()) throw files::bad_input(part.file, "loads", "no load", "at least one");
    throw files::bad_input(part.file, "--load", name.empty() ? "several loads" : files::shown(name), "one of " + known);
}

std::vector<Method> methods_of(const std::vector<std::string>& names) {
    std::vector<Method> out;
    for (const Method method : {Method::paper, Method::euler_bernoulli, Method::timoshenko, Method::elastica,
                                Method::voxels, Method::factorised}) {
        const bool named = std::find(names.begin(), names.end(), parts::name_of(method)) != names.end();
        if (named || (names.empty() && method != Method::factorised)) out.push_back(method);
    }
    return out;
}

files::Json json_of(const parts::MethodResult& result) {
    files::Json json;
    const auto or_null = [](bool known, double value) { return known ? files::number_or_null(value) : nullptr; };
    json["displacement_mm"] = or_null(result.answered, 1e3 * result.displacement_m);
    json["stiffness_N_per_m"] = or_null(result.answered, result.stiffness_N_per_m);
    json["applies"] = result.answered && result.why_not.empty();
    json["why_not"] = result.why_not.empty() ? files::Json(nullptr) : files::Json(result.why_not);
    json["error_percent"] = result.error ? files::Json(100.0 * *result.error) : files::Json(nullptr);
    json["error_against"] = result.error ? files::Json(result.against) : files::Json(nullptr);
    const bool cells = result.answered && result.method >= Method::voxels;
    const bool iterates = cells && result.method == Method::voxels;
    json["cells"] = cells ? files::Json(result.cells) : files::Json(nullptr);
    json["on_cells_twice_as_large_percent"] =
        result.coarser ? files::number_or_null(100.0 * *result.coarser) : files::Json(nullptr);
    json["max_strain"] = or_null(cells, result.max_strain);
    json["iterations"] = iterates ? files::Json(result.iterations) : files::Json(nullptr);
    json["energy_error_percent"] = or_null(iterates, 100.0 * result.energy_error);
    json["memory_MB"] = or_null(iterates, 1e-6 * static_cast<double>(result.memory_bytes));
    if (cells && !iterates) json["backward_error"] = files::number_or_null(result.energy_error);
    json["converged"] = result.converged;
    json["time_s"] = result.time_s;
    return json;
}

void print_row(const parts::MethodResult& result) {
    std::printf("  %-16s", parts::name_of(result.method));
    if (result.answered) {
        std::printf(" %12s mm %12s N/m", files::short_number(1e3 * result.displacement_m).c_str(),
                    files::short_number(result.stiffness_N_per_m).c_str());
    }
    if (result.error) std::printf("  displacement %+.2f %% against %s", 100.0 * *result.error, result.against.c_str());
    if (result.method == Method::voxels && result.answered) {
        std::printf("  %lld cells, %d iterations, energy error %s %%", static_cast<long long>(result.cells),
                    result.iterations, files::short_number(100.0 * result.energy_error).c_str());
    }
    if (result.coarser) std::printf(", on cells twice as large %+.2g %%", 100.0 * *result.coarser);
    std::printf("  %s s%s%s\n", files::short_number(result.time_s).c_str(),
                result.why_not.empty() ? "" : "; does not apply: ", files::printable(result.why_not).c_str());
}

void print_stiffness(const EvaluateOptions& options) {
    if (!options.out.empty()) files::check_output(options.out, parts::files_of_part(options.file));
    const parts::Part part = read_part_aloud(options.file);
    const parts::PartLoad& load = load_named(part, options.load);
    parts::StiffnessOptions how{methods_of(options.methods), {}, options.tolerance};
    if (options.cell_mm > 0.0) how.cell_m = 1e-3 * options.cell_mm;
    const std::vector<parts::MethodResult> results = parts::stiffness_of(part, load, how);
    bool converged = true;
    files::Json json{{"part", part.file}, {"load", load.name}, {"force_N", load.force_N}};
    if (!options.json)
        std::printf("%s, %s N at %s\n", files::printable(part.name).c_str(), files::short_number(load.force_N).c_str(),
                    files::printable(load.name).c_str());
    for (const parts::MethodResult& result : results) {
        converged = converged && result.converged;
        json["methods"][parts::name_of(result.method)] = json_of(result);
        if (!options.json) print_row(result);
    }
    if (!options.out.empty()) files::write_text_atomically(options.out, files::json_text(json));
    if (options.json) std::printf("%s", files::json_text(json).c_str());
    if (!converged) throw std::runtime_error(options.file + ": not converged");
}

}  // namespace

void add_part_evaluate(CLI::App& part) {
    auto options = std::make_shared<EvaluateOptions>();
    CLI::App* command = part.add_subcommand("evaluate", "Displacement and stiffness under a load, by several methods");
    command->alias("stiffness");
    command->add_option("PART", options->file, "part JSON")->required();
    command->add_option("-o,--out", options->out, "also write the JSON object to FILE");
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->add_option("--load", options->load, "name of the load (default: the only one)");
    command
        ->add_option(
            "--method", options->methods,
            "paper, euler-bernoulli, timoshenko, elastica, voxels, factorised; several by commas (default: all "
            "but the last)")
        ->delimiter(',')
        ->check(one_of({"paper", "euler-bernoulli", "timoshenko", "elastica", "voxels", "factorised"}));
    command->add_option("--cell-mm", options->cell_mm, "edge of the cells, a whole number of voxels")
        ->check(CLI::Range(1e-4, 1e3));
    command->add_option("--tolerance", options->tolerance, "relative error of the energy at which voxels stops")
        ->check(CLI::Range(1e-14, 0.5))
        ->capture_default_str();
    command->callback([options, command] {
        const auto asked = methods_of(options->methods);
        const bool iterates = std::find(asked.begin(), asked.end(), Method::voxels) != asked.end();
        refuse_unused(*command, "--cell-mm", iterates || asked.back() == Method::factorised,
                      "--method voxels or factorised");
        refuse_unused(*command, "--tolerance", iterates, "--method voxels");
        print_stiffness(*options);
    });
}

}  // namespace palpa::app
