// palpa part info, palpa part stiffness

#include "app/commands/part.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "app/commands/option_checks.h"
#include "app/commands/part_design.h"
#include "files/input_error.h"
#include "files/printable.h"
#include "files/text.h"
#include "parts/info.h"
#include "parts/stiffness.h"

namespace palpa::app {
namespace {

using parts::Method;

struct PartOptions {
    std::string file;
    std::string load;
    std::vector<std::string> methods;
    double cell_mm = 0.0;  // 0: the part's
    double tolerance = 1e-3;
    bool json = false;
};

files::Json json_of(const parts::Part& part, const parts::PartInfo& info) {
    files::Json json;
    json["part"] = part.file;
    json["name"] = part.name;
    json["voxels"] = info.voxels;
    json["runs"] = info.runs;
    json["memory_bytes"] = info.memory_bytes;
    json["plain_bytes"] = info.plain_bytes;
    json["volume_mm3"] = 1e9 * info.volume_m3;
    json["mass_g"] = 1e3 * info.mass_kg;
    json["centroid_mm"] = {1e3 * info.centroid_m[0], 1e3 * info.centroid_m[1], 1e3 * info.centroid_m[2]};
    for (std::size_t m = 0; m < part.materials.size(); ++m)
        json["voxels_of_material"][part.materials[m].name] = info.voxels_of_material[m];
    json["runs_sha256"] = info.runs_sha256;
    return json;
}

void print_info(const PartOptions& options) {
    const parts::Part part = parts::read_part(options.file);
    const parts::PartInfo info = parts::info_of(part);
    if (options.json) {
        std::printf("%s", files::json_text(json_of(part, info)).c_str());
        return;
    }
    std::printf("%s\n", files::printable(part.name).c_str());
    std::printf("  %lld voxels of %s mm in %lld runs, %zu bytes (%zu with a byte per voxel)\n",
                static_cast<long long>(info.voxels), files::short_number(1e3 * part.voxels.frame.pitch_m).c_str(),
                static_cast<long long>(info.runs), info.memory_bytes, info.plain_bytes);
    std::printf("  %s mm3, %s g, centroid (%s, %s, %s) mm\n", files::short_number(1e9 * info.volume_m3).c_str(),
                files::short_number(1e3 * info.mass_kg).c_str(), files::short_number(1e3 * info.centroid_m[0]).c_str(),
                files::short_number(1e3 * info.centroid_m[1]).c_str(),
                files::short_number(1e3 * info.centroid_m[2]).c_str());
    for (std::size_t m = 0; m < part.materials.size(); ++m) {
        std::printf("  %lld voxels of %s\n", static_cast<long long>(info.voxels_of_material[m]),
                    files::printable(part.materials[m].name).c_str());
    }
}

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
    for (const Method method : {Method::euler_bernoulli, Method::timoshenko, Method::voxels, Method::factorised}) {
        const bool named = std::find(names.begin(), names.end(), parts::name_of(method)) != names.end();
        if (named || (names.empty() && method != Method::factorised)) out.push_back(method);
    }
    return out;
}

files::Json json_of(const parts::MethodResult& result) {
    files::Json json;
    json["displacement_mm"] = result.answered ? files::number_or_null(1e3 * result.displacement_m) : nullptr;
    json["stiffness_N_per_m"] = result.answered ? files::number_or_null(result.stiffness_N_per_m) : nullptr;
    json["applies"] = result.answered && result.why_not.empty();
    if (!result.why_not.empty()) json["why_not"] = result.why_not;
    json["error_percent"] = result.error ? files::Json(100.0 * *result.error) : files::Json(nullptr);
    json["error_against"] = result.error ? files::Json(result.against) : files::Json(nullptr);
    if (result.method >= Method::voxels) {
        json["cells"] = result.cells;
        json["max_strain"] = files::number_or_null(result.max_strain);
        if (result.method == Method::voxels) {
            json["iterations"] = result.iterations;
            json["energy_error_percent"] = files::number_or_null(100.0 * result.energy_error);
            json["memory_MB"] = 1e-6 * static_cast<double>(result.memory_bytes);
        } else {
            json["backward_error"] = files::number_or_null(result.energy_error);
        }
    }
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
    if (result.error) std::printf("  %+.2f %% against %s", 100.0 * *result.error, result.against.c_str());
    if (result.method == Method::voxels && result.answered) {
        std::printf("  %lld cells, %d iterations, energy error %s %%", static_cast<long long>(result.cells),
                    result.iterations, files::short_number(100.0 * result.energy_error).c_str());
    }
    std::printf("  %s s%s%s\n", files::short_number(result.time_s).c_str(),
                result.why_not.empty() ? "" : "; does not apply: ", files::printable(result.why_not).c_str());
}

void print_stiffness(const PartOptions& options) {
    const parts::Part part = parts::read_part(options.file);
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
        if (options.json) {
            json["methods"][parts::name_of(result.method)] = json_of(result);
        } else {
            print_row(result);
        }
    }
    if (options.json) std::printf("%s", files::json_text(json).c_str());
    if (!converged) throw std::runtime_error(options.file + ": not converged");
}

}  // namespace

void add_part(CLI::App& app) {
    CLI::App* part = app.add_subcommand("part", "Multi-material parts: what they are made of, how stiff they are");
    part->require_subcommand(1);
    auto options = std::make_shared<PartOptions>();
    CLI::App* info = part->add_subcommand("info", "Voxels, mass and centroid of a part (docs/parts.md)");
    CLI::App* stiffness =
        part->add_subcommand("stiffness", "Displacement and stiffness under a load, by several methods");
    stiffness->alias("evaluate");
    for (CLI::App* command : {info, stiffness}) {
        command->add_option("PART", options->file, "part JSON")->required();
        command->add_flag("--json", options->json, "print one JSON object on standard output");
    }
    stiffness->add_option("--load", options->load, "name of the load (default: the only one)");
    stiffness
        ->add_option("--method", options->methods,
                     "euler-bernoulli, timoshenko, voxels, factorised; several by commas (default: the first three)")
        ->delimiter(',')
        ->check(one_of({"euler-bernoulli", "timoshenko", "voxels", "factorised"}));
    stiffness->add_option("--cell-mm", options->cell_mm, "edge of the cells, a whole number of voxels")
        ->check(CLI::Range(1e-4, 1e3));
    stiffness->add_option("--tolerance", options->tolerance, "relative error of the energy at which voxels stops")
        ->check(CLI::Range(1e-14, 0.5))
        ->capture_default_str();
    info->callback([options] { print_info(*options); });
    stiffness->callback([options] { print_stiffness(*options); });
    add_part_edit(*part);
    add_part_compare(*part);
    add_part_export(*part);
}

}  // namespace palpa::app
