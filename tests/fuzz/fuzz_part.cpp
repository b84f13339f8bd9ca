// Part files.

#include "files/json.h"
#include "parts/info.h"
#include "parts/surface.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;

namespace {

constexpr double kMostFuzzVoxels = 1e5;  // larger parts only take longer

bool is_small(const files::Json& json) {
    if (!json.is_object() || !json.contains("voxel_mm") || !json.contains("size_mm")) return true;
    const files::Json &voxel = json["voxel_mm"], &size = json["size_mm"];
    if (!voxel.is_number() || !size.is_array()) return true;
    double n = 1.0;
    for (const files::Json& length : size) n *= length.is_number() ? length.get<double>() / voxel.get<double>() : 1.0;
    return !(n > kMostFuzzVoxels);
}

// No files beside it.
bool names_files(std::string_view text) {
    return text.find("stl") != std::string_view::npos || text.find("runs") != std::string_view::npos ||
           text.find("\\u") != std::string_view::npos;
}

}  // namespace

PALPA_FUZZ_ENTRY(part)(const std::uint8_t* data, std::size_t size) {
    return fuzz::read_or_refuse([&] {
        const std::string_view text = fuzz::text_of(data, size);
        if (names_files(text)) return;
        const files::Json json = files::parse_json(text, "p.json");
        if (!is_small(json)) return;
        const parts::Part part = parts::parse_part(json, "p.json");
        const parts::PartInfo info = parts::info_of(part);
        if (info.voxels < 1 || info.runs < 1 || !(info.mass_kg > 0.0)) fuzz::finding("a part of nothing");
        for (const mechanics::Run& run : part.voxels.lines.front()) {
            if (run.x0 >= run.x1 || run.x1 > part.voxels.size[0]) fuzz::finding("a run beyond its line");
        }
        parts::surfaces_of(part.voxels);
    });
}
