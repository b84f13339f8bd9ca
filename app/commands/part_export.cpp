// palpa part export

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/commands/option_checks.h"
#include "app/commands/part.h"
#include "app/commands/part_design.h"
#include "files/input_error.h"
#include "files/printable.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "mechanics/error.h"
#include "parts/edit.h"
#include "parts/export/export.h"
#include "parts/runs_file.h"

namespace palpa::app {
namespace {

struct ExportOptions {
    std::string file, output, as;
    std::vector<double> pitch_um;
    bool smooth = false;
    bool json = false;
};

enum class ExportKind { runs, three_mf, stl, slices };

ExportKind kind_of(const ExportOptions& options) {
    const std::string ending = std::filesystem::path(options.output).extension().string();
    const bool one_file = ending == ".npy" || ending == ".3mf";
    if (one_file != options.as.empty()) {
        throw files::bad_input("--as", "", options.as.empty() ? "nothing" : files::shown(options.as) + " for a file",
                               "stl or slices, for a folder; neither for FILE.3mf and FILE.npy");
    }
    const ExportKind kind = ending == ".npy"      ? ExportKind::runs
                            : ending == ".3mf"    ? ExportKind::three_mf
                            : options.as == "stl" ? ExportKind::stl
                                                  : ExportKind::slices;
    if (kind != ExportKind::slices && !options.pitch_um.empty())
        throw files::bad_input("--pitch-um", "", "a pitch", "none, except for slices");
    if (options.smooth && kind != ExportKind::stl && kind != ExportKind::three_mf)
        throw files::bad_input("--smooth", "", "it", "it for STL and 3MF only");
    return kind;
}

std::vector<parts::Surface> surfaces_for(const parts::Part& part, bool smooth) {
    try {
        return parts::surfaces_of(part.voxels, smooth);
    } catch (const mechanics::MeshError& error) {
        throw files::InputError(part.file + ": " + error.what());
    }
}

std::vector<parts::ExportedFile> write_files(const parts::Part& part, const ExportOptions& options, ExportKind kind) {
    switch (kind) {
        case ExportKind::three_mf:
            return parts::export_three_mf(part, surfaces_for(part, options.smooth), options.output);
        case ExportKind::stl:
            return parts::export_stl(part, surfaces_for(part, options.smooth), options.output);
        case ExportKind::slices: {
            const double voxel_m = part.voxels.frame.pitch_m;
            parts::SlicePitch pitch{voxel_m, voxel_m, voxel_m};
            if (!options.pitch_um.empty())
                pitch = {1e-6 * options.pitch_um[0], 1e-6 * options.pitch_um[1], 1e-6 * options.pitch_um[2]};
            return parts::export_slices(part, pitch, options.output);
        }
        case ExportKind::runs:
            break;
    }
    parts::write_runs(part.voxels, options.output);
    const double pitch_m = part.voxels.frame.pitch_m;
    const auto voxels = static_cast<double>(count(part.voxels, 0).voxels);
    return {{options.output, "", 0, 0, voxels * pitch_m * pitch_m * pitch_m}};
}

files::Json file_json(const parts::ExportedFile& file, ExportKind kind) {
    files::Json json{{"file", file.file}};
    json["material"] = file.material.empty() ? files::Json(nullptr) : files::Json(file.material);
    if (kind == ExportKind::stl || kind == ExportKind::three_mf) json["triangles"] = file.triangles;
    if (kind == ExportKind::slices) json["pixels"] = file.pixels;
    json["volume_mm3"] = 1e9 * file.volume_m3;
    return json;
}

void export_part(const ExportOptions& options) {
    const ExportKind kind = kind_of(options);
    if (kind == ExportKind::stl || kind == ExportKind::slices) {
        files::check_output_folder(options.output, parts::files_of_part(options.file));
    } else {
        files::check_output(options.output, parts::files_of_part(options.file));
    }
    const parts::Part part = read_part_aloud(options.file);
    const std::vector<parts::ExportedFile> written = write_files(part, options, kind);
    if (options.json) {
        files::Json json{{"part", part.file}, {"files", files::Json::array()}};
        for (const parts::ExportedFile& file : written) json["files"].push_back(file_json(file, kind));
        std::printf("%s", files::json_text(json).c_str());
        return;
    }
    if (kind == ExportKind::slices) {
        std::printf("%s: %s\n", files::printable(options.output).c_str(),
                    files::counted(static_cast<std::int64_t>(written.size()), "image").c_str());
        return;
    }
    for (const parts::ExportedFile& file : written) {
        std::printf("%s", files::printable(file.file).c_str());
        if (!file.material.empty())
            std::printf(", %s: %lld triangles", files::printable(file.material).c_str(),
                        static_cast<long long>(file.triangles));
        std::printf(", %s mm3\n", files::short_number(1e9 * file.volume_m3).c_str());
    }
}

}  // namespace

void add_part_export(CLI::App& part) {
    auto options = std::make_shared<ExportOptions>();
    CLI::App* command = part.add_subcommand("export", "A part for the printer: 3MF, STL, slices; or its runs");
    command->add_option("PART", options->file, "part JSON")->required();
    command->add_option("-o,--output", options->output, "FILE.3mf, FILE.npy (runs), or a new folder with --as")
        ->required();
    command->add_option("--as", options->as, "stl or slices, into a folder")->check(one_of({"stl", "slices"}));
    command->add_option("--pitch-um", options->pitch_um, "the printer's pixel and layer X,Y,Z (default: the voxels')")
        ->delimiter(',')
        ->expected(3)
        ->check(CLI::Range(0.1, 1e5));
    command->add_flag("--smooth", options->smooth, "move corners by up to half a voxel (STL and 3MF)");
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->callback([options] { export_part(*options); });
}

}  // namespace palpa::app
