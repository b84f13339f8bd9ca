#include "parts/region_file.h"

#include <array>
#include <filesystem>
#include <string>

#include "parts/stl_file.h"

namespace palpa::parts {
namespace {

using namespace mechanics;

constexpr int kDeepest = 16;  // regions within regions

Point point_m(const std::vector<double>& v) { return {1e-3 * v[0], 1e-3 * v[1], 1e-3 * v[2]}; }

BoxRegion read_box(files::JsonReader json) {
    json.only({"min_mm", "max_mm"});
    BoxRegion box{read_point_m(json, "min_mm"), read_point_m(json, "max_mm")};
    for (std::size_t c = 0; c < 3; ++c) {
        if (!(box.min_m[c] < box.max_m[c]))
            json.fail("max_mm", "a corner that is not above min_mm", "max_mm > min_mm in x, y and z");
    }
    return box;
}

BallRegion read_ball(files::JsonReader json) {
    json.only({"centre_mm", "radius_mm"});
    return {read_point_m(json, "centre_mm"), 1e-3 * json.number("radius_mm", files::kPositive)};
}

CylinderRegion read_cylinder(files::JsonReader json) {
    json.only({"from_mm", "to_mm", "radius_mm"});
    CylinderRegion out{read_point_m(json, "from_mm"), read_point_m(json, "to_mm"),
                       1e-3 * json.number("radius_mm", files::kPositive)};
    if (out.from_m == out.to_m) json.fail("to_mm", "the same point as from_mm", "another point");
    return out;
}

BandsRegion read_bands(files::JsonReader json) {
    json.only({"axis", "offset_mm", "period_mm", "width_mm"});
    BandsRegion out;
    out.axis = static_cast<int>(json.choice("axis", {"x", "y", "z"}));
    out.offset_m = 1e-3 * json.number("offset_mm", {-1e6, 1e6}, 0.0);
    out.period_m = 1e-3 * json.number("period_mm", {1e-3, 1e6});
    out.width_m = 1e-3 * json.number("width_mm", {0.0, 1e3 * out.period_m, true});
    return out;
}

SolidRegion read_stl_region(files::JsonReader json) {
    json.only({"file", "unit", "offset_mm"});
    const std::filesystem::path file = json.text("file");
    if (!json.has("unit")) json.fail("unit", "an STL file without it", "what its numbers are: um, mm, cm, m or inch");
    constexpr std::array kUnits_m{1e-6, 1e-3, 1e-2, 1.0, 0.0254};
    const double unit_m = kUnits_m[json.choice("unit", {"um", "mm", "cm", "m", "inch"})];
    const Point offset_m = json.has("offset_mm") ? read_point_m(json, "offset_mm") : Point{};
    return {std::make_shared<TriangleSolid>(read_stl(beside(json, file), unit_m, offset_m))};
}

Region read_nested(files::JsonReader& json, int depth);

BooleanRegion read_boolean(files::JsonReader& json, const char* key, Boolean kind, int depth) {
    BooleanRegion out{kind, {}};
    if (depth >= kDeepest) json.fail(key, "regions nested more than 16 deep", "fewer");
    for (files::JsonReader& part : json.objects(key)) {
        part.only({"all", "box", "sphere", "cylinder", "path", "bands", "stl", "both", "any", "without"});
        out.parts.push_back(read_nested(part, depth + 1));
    }
    if (out.parts.size() < 2) json.fail(key, std::to_string(out.parts.size()) + " regions", "at least 2");
    return out;
}

Region read_nested(files::JsonReader& json, int depth) {
    constexpr std::array kKinds{"all", "box", "sphere", "cylinder", "path", "bands", "stl", "both", "any", "without"};
    int kinds = 0;
    for (const char* kind : kKinds) kinds += json.has(kind) ? 1 : 0;
    if (kinds != 1) {
        json.fail("", std::to_string(kinds) + " regions",
                  "one of all, box, sphere, cylinder, path, bands, stl, both, any, without");
    }
    if (json.has("all")) {
        if (!json.boolean("all", true)) json.fail("all", "false", "true");
        return {EverywhereRegion{}};
    }
    if (json.has("box")) return {read_box(json.object("box"))};
    if (json.has("sphere")) return {read_ball(json.object("sphere"))};
    if (json.has("cylinder")) return {read_cylinder(json.object("cylinder"))};
    if (json.has("path")) return {read_path(json.object("path"))};
    if (json.has("bands")) return {read_bands(json.object("bands"))};
    if (json.has("stl")) return {read_stl_region(json.object("stl"))};
    if (json.has("both")) return {read_boolean(json, "both", Boolean::all, depth)};
    if (json.has("any")) return {read_boolean(json, "any", Boolean::any, depth)};
    return {read_boolean(json, "without", Boolean::without, depth)};
}

}  // namespace

Point read_point_m(files::JsonReader& json, std::string_view key) { return point_m(json.numbers(key, 3, {-1e6, 1e6})); }

PathRegion read_path(files::JsonReader json) {
    json.only({"points_mm", "radius_mm", "ends"});
    PathRegion out;
    const files::Json& points = json.any("points_mm");
    if (!points.is_array() || points.empty())
        json.fail("points_mm", files::described(points), "at least one point [x, y, z]");
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::string index = std::to_string(i);
        files::Json entry = files::Json::object();
        entry[index] = points[i];
        files::JsonReader reader(entry, json.file(), "points_mm");
        out.points_m.push_back(read_point_m(reader, index));
    }
    out.radius_m = 1e-3 * json.number("radius_mm", files::kPositive);
    out.flat_ends = json.has("ends") && json.choice("ends", {"round", "flat"}) == 1;
    if (out.flat_ends && out.points_m.size() < 2)
        json.fail("points_mm", "one point", "two, for a cylinder with flat ends");
    return out;
}

std::filesystem::path beside(const files::JsonReader& json, const std::filesystem::path& file) {
    return std::filesystem::path(json.file()).parent_path() / file;
}

Region read_region(files::JsonReader& json) { return read_nested(json, 0); }

}  // namespace palpa::parts
