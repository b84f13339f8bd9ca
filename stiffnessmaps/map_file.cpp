#include "stiffnessmaps/map_file.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unistd.h>

#include "files/input_error.h"
#include "files/npy.h"
#include "files/regular_file.h"
#include "files/text.h"

namespace palpa::stiffnessmaps {
namespace {

namespace fs = std::filesystem;

constexpr files::Bounds kLength_mm{-1e5, 1e5};
constexpr double kDeepest_m = 10.0;
constexpr files::Bounds kSpacing_mm{1e-3, 1e4};

double mm(double metres) {
    // rounded, so that 0.004 m is written as 4 mm, not 4.000000000000001
    return std::round(metres * 1e12) / 1e9;
}

std::optional<double> optional_length_m(files::JsonReader& json, std::string_view key) {
    if (!json.has(key)) return std::nullopt;
    return 1e-3 * json.number(key, files::kNotNegative);
}

Nodule read_nodule(files::JsonReader json) {
    json.only({"id", "origin", "x_mm", "y_mm", "top_depth_mm", "diameter_mm", "length_mm", "angle_deg"});
    Nodule nodule;
    nodule.id = json.text("id");
    nodule.placed = json.choice("origin", {"placed", "detected"}) == 0;
    nodule.x_m = 1e-3 * json.number("x_mm", kLength_mm);
    nodule.y_m = 1e-3 * json.number("y_mm", kLength_mm);
    nodule.top_depth_m = optional_length_m(json, "top_depth_mm");
    nodule.diameter_m = optional_length_m(json, "diameter_mm");
    nodule.length_m = optional_length_m(json, "length_mm");
    if (json.has("angle_deg")) nodule.angle_deg = json.number("angle_deg", {-360.0, 360.0});
    json.finish();
    return nodule;
}

SourceChoice read_choice(files::JsonReader json) {
    json.only({"key", "value", "how", "option"});
    SourceChoice choice;
    choice.key = json.text("key");
    const files::Json& value = json.any("value");
    if (value.is_number()) {
        choice.value = json.number("value", files::kAnyNumber);
    } else if (value.is_array()) {
        choice.value = json.numbers("value", 0, files::kAnyNumber);
    } else {
        choice.value = json.text("value");
    }
    choice.how = json.text("how", "");
    choice.option = json.text("option", "");
    json.finish();
    return choice;
}

MapSource read_source(files::JsonReader json) {
    json.only({"kind", "how", "from", "licence", "choices"});
    MapSource source;
    source.kind = static_cast<SourceKind>(json.choice("kind", {"recorded", "simulated", "analytic"}));
    source.how = json.text("how", "");
    source.from = json.text("from", "");
    source.licence = json.text("licence", "");
    for (files::JsonReader& choice : json.objects("choices")) source.choices.push_back(read_choice(choice));
    json.finish();
    return source;
}

void read_depths(files::JsonReader& json, Map& map) {
    for (const double depth_mm : json.numbers("depths_mm", 0, {0.0, 1e4, true})) {
        if (!map.depths_m.empty() && 1e-3 * depth_mm <= map.depths_m.back()) {
            json.fail("depths_mm",
                      files::short_number(depth_mm) + " after " + files::short_number(1e3 * map.depths_m.back()),
                      "ascending depths");
        }
        map.depths_m.push_back(1e-3 * depth_mm);
    }
}

void check_forces(const std::vector<float>& forces_N, const std::string& file) {
    constexpr float kAbsurd_N = 1e5f;
    for (std::size_t i = 0; i < forces_N.size(); ++i) {
        if (!std::isnan(forces_N[i]) && !(std::abs(forces_N[i]) < kAbsurd_N)) {
            throw files::bad_input(file, "value " + std::to_string(i),
                                   files::short_number(static_cast<double>(forces_N[i])),
                                   "forces in newtons, below 1e5");
        }
    }
}

std::vector<float> read_forces(const fs::path& path, const Map& map, std::vector<std::size_t>& shape) {
    files::NpyArray array = files::read_npy(path);
    if (array.shape.size() != 3 || array.shape[0] != map.n_depths()) {
        throw files::bad_input(
            path.string(), "shape", files::shape_text(array.shape),
            "(" + std::to_string(map.n_depths()) + ", n_y, n_x) for " + std::to_string(map.n_depths()) + " depths");
    }
    if (shape.empty()) shape = array.shape;
    if (array.shape != shape)
        throw files::bad_input(path.string(), "shape", files::shape_text(array.shape), files::shape_text(shape));
    check_forces(array.values, path.string());
    return std::move(array.values);
}

void check_filled(const Map& map, const std::string& file) {
    if (map.filled_normal_N.empty()) return;
    for (std::size_t i = 0; i < map.normal_N.size(); ++i) {
        const float filled = map.filled_normal_N[i];
        if (std::isnan(filled) || (!std::isnan(map.normal_N[i]) && filled != map.normal_N[i])) {
            throw files::bad_input(file, "value " + std::to_string(i), files::short_number(static_cast<double>(filled)),
                                   "the force of normal_N.npy where it was measured, and a number where it was not");
        }
    }
}

void check_area(const Map& map, const std::string& file) {
    const double x_end = map.x_of(map.n_x - 1);
    const double y_end = map.y_of(map.n_y - 1);
    for (const Nodule& nodule : map.nodules) {
        const bool inside = nodule.x_m >= map.origin_m[0] - map.spacing_m[0] &&
                            nodule.x_m <= x_end + map.spacing_m[0] &&
                            nodule.y_m >= map.origin_m[1] - map.spacing_m[1] && nodule.y_m <= y_end + map.spacing_m[1];
        if (!inside) {
            throw files::bad_input(
                file, "nodules " + nodule.id,
                "x " + files::short_number(1e3 * nodule.x_m) + ", y " + files::short_number(1e3 * nodule.y_m) + " mm",
                "a place on the map, which ends at x " + files::short_number(1e3 * x_end) + ", y " +
                    files::short_number(1e3 * y_end) + " mm (are x and y of the arrays exchanged?)");
        }
    }
}

}  // namespace

Map read_map(const fs::path& folder) {
    if (!fs::is_directory(folder)) {
        const std::string_view kind = fs::exists(folder) ? files::irregular_kind(folder) : "nothing";
        throw files::bad_input(folder.string(), "", kind.empty() ? "a file" : kind,
                               "a map folder NAME.map with a map.json");
    }
    const fs::path file = folder / "map.json";
    const files::Json root = files::read_json(file);
    files::JsonReader json(root, file.string());
    json.only({"name", "origin_mm", "spacing_mm", "count", "depths_mm", "tangential", "indenter", "nodules", "source",
               "noise_N"});
    Map map;
    map.name = json.text("name");
    const auto origin_mm = json.numbers("origin_mm", 2, kLength_mm);
    const auto spacing_mm = json.numbers("spacing_mm", 2, kSpacing_mm);
    for (std::size_t i = 0; i < 2; ++i) {
        map.origin_m[i] = 1e-3 * origin_mm[i];
        map.spacing_m[i] = 1e-3 * spacing_mm[i];
    }
    read_depths(json, map);
    map.tangential = static_cast<TangentialKind>(json.choice("tangential", {"recorded", "energy", "none"}));
    files::JsonReader indenter = json.object("indenter");
    indenter.only({"shape", "radius_mm"});
    map.indenter = static_cast<IndenterShape>(indenter.choice("shape", {"sphere", "cylinder"}));
    map.indenter_radius_m = 1e-3 * indenter.number("radius_mm", {0.0, 1e3, true});
    indenter.finish();
    map.nodules_known = json.has("nodules");
    for (files::JsonReader& nodule : json.objects("nodules")) {
        const Nodule read = read_nodule(nodule);
        const auto same = [&](const Nodule& other) { return other.id == read.id && other.placed == read.placed; };
        if (std::any_of(map.nodules.begin(), map.nodules.end(), same))
            nodule.fail("id", files::shown(read.id) + " twice", "an id of its own for each nodule");
        map.nodules.push_back(read);
    }
    map.source = read_source(json.object("source"));

    if (json.has("noise_N")) map.noise_N = json.number("noise_N", {0.0, 1e5});

    std::vector<std::size_t> shape;
    if (json.has("count")) {
        const int n_x = static_cast<int>(json.numbers("count", 2, {1.0, 1e6})[0]);
        const int n_y = static_cast<int>(json.numbers("count", 2, {1.0, 1e6})[1]);
        shape = {map.n_depths(), static_cast<std::size_t>(n_y), static_cast<std::size_t>(n_x)};
    }
    json.finish();

    map.normal_N = read_forces(folder / "normal_N.npy", map, shape);
    map.n_y = shape[1];
    map.n_x = shape[2];
    if (map.n_cells() == 0)
        throw files::bad_input((folder / "normal_N.npy").string(), "shape", files::shape_text(shape), "cells");
    for (const bool along_y : {false, true}) {
        const fs::path path = folder / (along_y ? "tangential_y_N.npy" : "tangential_x_N.npy");
        if (fs::exists(path)) (along_y ? map.tangential_y_N : map.tangential_x_N) = read_forces(path, map, shape);
    }
    if (map.tangential == TangentialKind::recorded && map.tangential_x_N.empty() && map.tangential_y_N.empty()) {
        throw files::bad_input(file.string(), "tangential", "recorded",
                               "tangential_x_N.npy or tangential_y_N.npy beside it");
    }
    if (const fs::path path = folder / "filled_normal_N.npy"; fs::exists(path)) {
        map.filled_normal_N = read_forces(path, map, shape);
        check_filled(map, path.string());
    }
    check_area(map, file.string());
    if (missing_count(map) == map.normal_N.size()) {
        throw files::bad_input((folder / "normal_N.npy").string(), "", "no force that was measured", "at least one");
    }
    return map;
}

namespace {

files::Json choices_json(const std::vector<SourceChoice>& choices) {
    files::Json json = files::Json::array();
    for (const SourceChoice& choice : choices) {
        files::Json entry{{"key", choice.key}};
        std::visit([&](const auto& value) { entry["value"] = value; }, choice.value);
        entry["how"] = choice.how;
        entry["option"] = choice.option;
        json.push_back(entry);
    }
    return json;
}

}  // namespace

files::Json map_json(const Map& map) {
    files::Json json;
    json["name"] = map.name;
    json["origin_mm"] = {mm(map.origin_m[0]), mm(map.origin_m[1])};
    json["spacing_mm"] = {mm(map.spacing_m[0]), mm(map.spacing_m[1])};
    json["count"] = {map.n_x, map.n_y};
    json["depths_mm"] = files::Json::array();
    for (const double depth_m : map.depths_m) json["depths_mm"].push_back(mm(depth_m));
    json["tangential"] = name_of(map.tangential);
    json["indenter"] = {{"shape", name_of(map.indenter)}, {"radius_mm", mm(map.indenter_radius_m)}};
    if (map.noise_N) json["noise_N"] = *map.noise_N;
    if (map.nodules_known || !map.nodules.empty()) json["nodules"] = files::Json::array();
    for (const Nodule& nodule : map.nodules) {
        files::Json entry{{"id", nodule.id},
                          {"origin", nodule.placed ? "placed" : "detected"},
                          {"x_mm", mm(nodule.x_m)},
                          {"y_mm", mm(nodule.y_m)}};
        if (nodule.top_depth_m) entry["top_depth_mm"] = mm(*nodule.top_depth_m);
        if (nodule.diameter_m) entry["diameter_mm"] = mm(*nodule.diameter_m);
        if (nodule.length_m) entry["length_mm"] = mm(*nodule.length_m);
        if (nodule.angle_deg) entry["angle_deg"] = *nodule.angle_deg;
        json["nodules"].push_back(entry);
    }
    json["source"] = {{"kind", name_of(map.source.kind)},
                      {"how", map.source.how},
                      {"from", map.source.from},
                      {"licence", map.source.licence}};
    if (!map.source.choices.empty()) json["source"]["choices"] = choices_json(map.source.choices);
    return json;
}

void check_map(const Map& map, const std::string& file) {
    const auto in = [](double mm, files::Bounds bounds) { return mm >= bounds.lowest && mm <= bounds.highest; };
    for (int i = 0; i < 2; ++i) {
        if (!in(1e3 * map.origin_m[i], kLength_mm))
            throw files::bad_input(file, "origin", files::short_number(1e3 * map.origin_m[i]) + " mm", "within 100 m");
        if (!in(1e3 * map.spacing_m[i], kSpacing_mm)) {
            throw files::bad_input(file, "spacing", files::short_number(1e3 * map.spacing_m[i]) + " mm",
                                   "from 0.001 to 10000 mm");
        }
    }
    if (!(map.depths_m.back() <= kDeepest_m)) {
        throw files::bad_input(file, "depth", files::short_number(1e3 * map.depths_m.back()) + " mm",
                               "at most 10000 mm");
    }
    check_forces(map.normal_N, file);
    check_forces(map.tangential_x_N, file);
    check_forces(map.tangential_y_N, file);
    check_filled(map, file);
    check_area(map, file);
}

void write_map(const Map& map, const fs::path& folder) {
    check_map(map, folder.string());
    if (folder.empty() || !fs::is_directory(folder.has_parent_path() ? folder.parent_path() : ".")) {
        throw files::bad_input(files::shown(folder.string()), "", "no folder to put it into",
                               "a new map folder in a folder that exists");
    }
    files::check_new(folder);
    fs::path aside = folder;
    if (!aside.has_filename()) aside = aside.parent_path();
    const fs::path target = aside;
    aside += ".part-" + std::to_string(::getpid());
    const auto write_array = [&](const char* name, const std::vector<float>& values) {
        if (values.empty()) return;
        files::write_npy(aside / name, {map.n_depths(), map.n_y, map.n_x}, values);
    };
    try {
        fs::create_directory(aside);
        write_array("normal_N.npy", map.normal_N);
        write_array("tangential_x_N.npy", map.tangential_x_N);
        write_array("tangential_y_N.npy", map.tangential_y_N);
        write_array("filled_normal_N.npy", map.filled_normal_N);
        files::write_text_atomically(aside / "map.json", files::json_text(map_json(map)));
        fs::rename(aside, target);
    } catch (const std::exception&) {
        std::error_code ignored;
        fs::remove_all(aside, ignored);
        throw;
    }
}

void replace_map_json(const Map& map, const fs::path& folder) {
    check_map(map, folder.string());
    files::write_text_atomically(folder / "map.json", files::json_text(map_json(map)));
}

}  // namespace palpa::stiffnessmaps
