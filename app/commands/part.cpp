// palpa part info

#include "app/commands/part.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/commands/part_design.h"
#include "files/json.h"
#include "files/printable.h"
#include "files/text.h"
#include "parts/info.h"

namespace palpa::app {
namespace {

struct PartOptions {
    std::string file;
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
    const parts::Part part = read_part_aloud(options.file);
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

}  // namespace

void say_warnings(const parts::Part& part) {
    for (const std::string& warning : part.warnings)
        std::fprintf(stderr, "palpa: warning: %s\n", files::printable(warning).c_str());
}

parts::Part read_part_aloud(const std::string& file) {
    parts::Part part = parts::read_part(file);
    say_warnings(part);
    return part;
}

void add_part(CLI::App& app) {
    CLI::App* part = app.add_subcommand("part", "Multi-material parts: what they are made of, how stiff they are");
    part->require_subcommand(1);
    auto options = std::make_shared<PartOptions>();
    CLI::App* info = part->add_subcommand("info", "Voxels, mass and centroid of a part (docs/parts.md)");
    info->add_option("PART", options->file, "part JSON")->required();
    info->add_flag("--json", options->json, "print one JSON object on standard output");
    info->callback([options] { print_info(*options); });
    add_part_evaluate(*part);
    add_part_button(*part);
    add_part_edit(*part);
    add_part_compare(*part);
    add_part_export(*part);
}

}  // namespace palpa::app
