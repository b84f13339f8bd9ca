#include "parts/shape_file.h"

#include <array>

#include "files/input_error.h"
#include "files/text.h"
#include "mechanics/error.h"
#include "parts/region_file.h"
#include "parts/runs_file.h"

namespace palpa::parts {
namespace {

using namespace mechanics;

int read_material_name(files::JsonReader& json, const char* key, const Part& part) {
    const std::string name = json.text(key);
    std::string known;
    for (std::size_t m = 0; m < part.materials.size(); ++m) {
        if (part.materials[m].name == name) return static_cast<int>(m);
        known += (known.empty() ? "" : ", ") + part.materials[m].name;
    }
    json.fail(key, files::shown(name), "one of the materials: " + known);
}

// Says whether a region has a voxel's centre in it.
bool reaches(const Region& region, const Voxels& voxels) {
    std::vector<Span> spans;
    const LineRange range = lines_of(region, voxels.frame, voxels.size[1], voxels.size[2]);
    for (int z = range.z0; z < range.z1; ++z) {
        for (int y = range.y0; y < range.y1; ++y) {
            spans_of(region, voxels.frame, voxels.size[0], y, z, spans);
            if (!spans.empty()) return true;
        }
    }
    return false;
}

// Returns which of the operations an object holds.
std::string operation_of(files::JsonReader& json) {
    constexpr std::array kOperations{"add", "remove", "permute", "sculpt", "runs"};
    int kinds = 0;
    std::string key;
    for (const char* operation : kOperations) {
        if (!json.has(operation)) continue;
        key = operation;
        ++kinds;
    }
    if (kinds != 1) json.fail("", std::to_string(kinds) + " operations", "one of add, remove, permute, sculpt, runs");
    return key;
}

VoxelEdit read_edit(files::JsonReader& json, const std::string& key, const Part& part) {
    VoxelEdit edit;
    edit.kind = key == "add" ? EditKind::add : key == "permute" ? EditKind::permute : EditKind::remove;
    if (key == "sculpt") {
        edit.region = {read_path(json.object(key))};
    } else {
        files::JsonReader region = json.object(key);
        region.only({"all", "box", "sphere", "cylinder", "path", "bands", "stl", "both", "any", "without"});
        edit.region = read_region(region);
    }
    if (edit.kind != EditKind::remove) edit.material = read_material_name(json, "material", part);
    if (edit.kind == EditKind::permute && json.has("from")) edit.from = read_material_name(json, "from", part);
    json.finish();
    if (!reaches(edit.region, part.voxels))
        json.fail(key, "a volume outside: no voxel's centre is in it", "a region in size_mm, larger than a voxel");
    return edit;
}

// Says where a solid that is added reaches out of the space of the voxels: often its unit is another.
std::string cut_off_text(const VoxelEdit& edit, const Voxels& voxels) {
    const auto* added = std::get_if<mechanics::SolidRegion>(&edit.region.shape);
    if (added == nullptr || edit.kind != EditKind::add) return "";
    const auto mm = [](double metres) { return files::short_number(1e3 * metres); };
    for (std::size_t c = 0; c < 3; ++c) {
        const double pitch_m = voxels.frame.pitch_m;
        const double low_m = voxels.frame.origin_m[c], high_m = low_m + pitch_m * voxels.size[c];
        const double from_m = added->solid->low_m[c], to_m = added->solid->high_m[c];
        if (from_m < low_m - 0.5 * pitch_m || to_m > high_m + 0.5 * pitch_m) {
            return std::string("the STL file reaches from ") + mm(from_m) + " to " + mm(to_m) + " mm along " +
                   "xyz"[c] + ", and is cut off at " + mm(low_m) + " and " + mm(high_m) + " mm: is its unit right?";
        }
    }
    return "";
}

}  // namespace

std::int64_t apply_operation(files::JsonReader& json, Part& part) {
    json.only({"add", "remove", "permute", "sculpt", "runs", "material", "from"});
    const std::string key = operation_of(json);
    if (key != "runs") {
        const VoxelEdit edit = read_edit(json, key, part);
        const std::string cut_off = cut_off_text(edit, part.voxels);
        if (!cut_off.empty()) part.warnings.push_back(part.name + ": " + cut_off);
        return apply(edit, part.voxels, part.history);
    }
    const std::filesystem::path file = beside(json, json.text("runs"));
    json.finish();
    return overlay(read_runs(file, part.voxels, static_cast<int>(part.materials.size())), part.voxels, part.history);
}

void check_shape(const Part& part) {
    const int bodies = count_bodies(part.voxels);
    if (bodies == 0) throw files::bad_input(part.file, "shape", "nothing left", "at least one voxel");
    if (bodies > 1) {
        throw files::bad_input(part.file, "shape", std::to_string(bodies) + " bodies that share no face of a voxel",
                               "one body");
    }
}

}  // namespace palpa::parts
