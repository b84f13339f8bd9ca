#include "parts/part_file.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "files/input_error.h"
#include "files/text.h"
#include "mechanics/error.h"
#include "parts/button_file.h"
#include "parts/region_file.h"
#include "parts/shape_file.h"

namespace palpa::parts {
namespace {

using namespace mechanics;

PartMaterial read_material(files::JsonReader json, const std::string& name) {
    json.only({"young_Pa", "shore_A", "poisson", "density_kg_per_m3", "colour", "source"});
    PartMaterial out;
    out.name = name;
    if (json.has("young_Pa") == json.has("shore_A")) {
        json.fail("young_Pa", json.has("shore_A") ? "shore_A beside it" : "neither it nor shore_A",
                  "one of young_Pa and shore_A");
    }
    out.elastic.young_Pa = json.has("young_Pa") ? json.number("young_Pa", {1e-6, 1e15})
                                                : young_Pa_of_shore_A(json.number("shore_A", {1.0, 99.0}));
    out.elastic.poisson = json.number("poisson", files::kAnyNumber);
    if (!(out.elastic.poisson > -1.0 && out.elastic.poisson <= 0.4999)) {
        json.fail("poisson", files::number_text(out.elastic.poisson),
                  "a number > -1 and <= 0.4999 (which stands for incompressible)");
    }
    out.density_kg_per_m3 = json.number("density_kg_per_m3", files::kPositive);
    out.colour = json.text("colour", "#c0c0c0");
    const bool colour = out.colour.size() == 7 && out.colour[0] == '#' &&
                        out.colour.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
    if (!colour) json.fail("colour", files::shown(out.colour), "\"#rrggbb\"");
    json.text("source", "");
    return out;
}

void read_materials(files::JsonReader& json, Part& part) {
    const files::Json& list = json.any("materials");
    if (!list.is_object() || list.empty()) json.fail("materials", files::described(list), "at least one material");
    for (const auto& item : list.items()) {
        part.materials.push_back(
            read_material(files::JsonReader(item.value(), json.file(), "materials." + item.key()), item.key()));
    }
}

int voxels_along(files::JsonReader& json, const char* key, double size_mm, double voxel_mm) {
    const double n = std::round(size_mm / voxel_mm);
    if (!(n >= 1.0 && n <= kMostVoxelsAlong)) {
        json.fail(key, files::short_number(size_mm / voxel_mm) + " voxels along an axis",
                  "1 to " + std::to_string(kMostVoxelsAlong));
    }
    if (std::abs(n * voxel_mm - size_mm) > 1e-6 * size_mm) {
        json.fail(key,
                  files::number_text(size_mm) + " mm, which is " + files::short_number(size_mm / voxel_mm) +
                      " voxels of " + files::number_text(voxel_mm) + " mm",
                  "a whole number of voxels");
    }
    return static_cast<int>(n);
}

void make_voxels(files::JsonReader& json, Part& part) {
    const double voxel_mm = json.number("voxel_mm", {1e-4, 1e3});
    const std::vector<double> size_mm = json.numbers("size_mm", 3, files::kPositive);
    std::array<int, 3> size{};
    for (std::size_t c = 0; c < 3; ++c) size[c] = voxels_along(json, "size_mm", size_mm[c], voxel_mm);
    if (std::int64_t{size[1]} * size[2] > kMostVoxelLines) {
        json.fail("size_mm", std::to_string(std::int64_t{size[1]} * size[2]) + " lines of voxels along x",
                  "at most " + std::to_string(kMostVoxelLines) + " (larger voxels, or the longest side along x)");
    }
    part.voxels = empty_voxels(size, {1e-3 * voxel_mm, {0.0, 0.0, 0.0}});
    const double cell_mm = json.number("cell_mm", {voxel_mm * (1.0 - 1e-6), 1e6}, voxel_mm);
    part.voxels_per_cell = voxels_along(json, "cell_mm", cell_mm, voxel_mm);
}

void make_shape(files::JsonReader& json, Part& part) {
    auto operations = json.objects("shape");
    if (operations.empty()) json.fail("shape", "no operation", "at least one");
    for (files::JsonReader& operation : operations) apply_operation(operation, part);
    check_shape(part);
}

Side read_side(files::JsonReader& json) {
    return static_cast<Side>(json.choice("face", {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"}));
}

PartSupport read_support(files::JsonReader& json) {
    json.only({"face", "fix", "all", "box", "sphere", "cylinder", "path", "bands", "stl", "both", "any", "without"});
    PartSupport out;
    if (json.has("face")) {
        out.face = read_side(json);
    } else {
        out.region = read_region(json);
    }
    const std::string fix = json.text("fix", "xyz");
    out.axes = 0;
    for (const char letter : fix) {
        const std::uint8_t bit = letter == 'x' ? 1 : letter == 'y' ? 2 : letter == 'z' ? 4 : 0;
        if (bit == 0 || (out.axes & bit) != 0)
            json.fail("fix", files::shown(fix), "some of x, y and z, each once: \"xyz\", \"z\"");
        out.axes = static_cast<std::uint8_t>(out.axes | bit);
    }
    if (out.axes == 0) json.fail("fix", "''", "some of x, y and z");
    json.finish();
    return out;
}

Point read_direction(files::JsonReader& json) {
    if (!json.any("direction").is_array()) {
        const auto choice = json.choice("direction", {"x", "-x", "y", "-y", "z", "-z"});
        Point out{};
        out[choice / 2] = choice % 2 == 0 ? 1.0 : -1.0;
        return out;
    }
    const auto v = json.numbers("direction", 3, {-1e6, 1e6});
    const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!(length > 1e-9)) json.fail("direction", "a vector of length 0", "a direction");
    return {v[0] / length, v[1] / length, v[2] / length};
}

PartLoad read_load(files::JsonReader json, const std::string& name) {
    json.only({"face", "at_mm", "patch_mm", "direction", "force_N"});
    PartLoad out;
    out.name = name;
    if (json.has("face")) {
        if (json.has("at_mm")) json.fail("at_mm", "a place beside face", "one of both");
        out.face = read_side(json);
    } else {
        out.at_m = read_point_m(json, "at_mm");
        out.patch_m = 1e-3 * json.number("patch_mm", files::kPositive);
    }
    out.direction = read_direction(json);
    out.force_N = json.number("force_N", files::kPositive, 1.0);
    json.finish();
    return out;
}

void read_loads(files::JsonReader& json, Part& part) {
    if (!json.has("loads")) return;
    const files::Json& list = json.any("loads");
    if (!list.is_object()) json.fail("loads", files::described(list), "an object: {\"head\": {...}}");
    for (const auto& item : list.items())
        part.loads.push_back(
            read_load(files::JsonReader(item.value(), json.file(), "loads." + item.key()), item.key()));
}

}  // namespace

double young_Pa_of_shore_A(double shore_A) {
    return 1e6 * 0.0981 * (56.0 + 7.62336 * shore_A) / (0.137505 * (254.0 - 2.54 * shore_A));
}

std::vector<Material> elastic_of(const Part& part) {
    std::vector<Material> out;
    for (const PartMaterial& material : part.materials) out.push_back(material.elastic);
    return out;
}

Part parse_part(const files::Json& value, const std::string& file_name) {
    files::JsonReader json(value, file_name);
    json.only({"name", "voxel_mm", "size_mm", "cell_mm", "materials", "shape", "supports", "loads", "axis", "button"});
    Part part;
    part.file = file_name;
    part.name = json.text("name", file_name);
    read_materials(json, part);
    make_voxels(json, part);
    make_shape(json, part);
    for (files::JsonReader& support : json.objects("supports")) part.supports.push_back(read_support(support));
    read_loads(json, part);
    if (json.has("axis")) part.axis = static_cast<int>(json.choice("axis", {"x", "y", "z"}));
    if (auto button = json.optional_object("button")) part.button = read_button(*button, part);
    return part;
}

Part read_part(const std::filesystem::path& path) { return parse_part(files::read_json(path), path.string()); }

}  // namespace palpa::parts
