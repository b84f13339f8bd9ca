#include "stiffnessmaps/phantom.h"

#include <algorithm>

#include "files/input_error.h"
#include "files/json.h"
#include "files/text.h"

namespace palpa::stiffnessmaps {
namespace {

Elastic read_elastic(files::JsonReader& json) {
    Elastic out;
    out.young_Pa = json.number("young_Pa", {0.0, 1e12, true});
    out.poisson = json.number("poisson", {0.0, 0.4999});
    return out;
}

PhantomNodule read_nodule(files::JsonReader json, const Phantom& phantom) {
    json.only({"id", "centre_mm", "diameter_mm", "young_Pa", "poisson"});
    PhantomNodule nodule;
    nodule.id = json.text("id");
    const auto centre_mm = json.numbers("centre_mm", 3, {0.0, 1e4});
    nodule.diameter_m = 1e-3 * json.number("diameter_mm", {0.0, 1e4, true});
    nodule.material = read_elastic(json);
    for (std::size_t i = 0; i < 3; ++i) {
        nodule.centre_m[i] = 1e-3 * centre_mm[i];
        const double radius_m = 0.5 * nodule.diameter_m;
        if (nodule.centre_m[i] < radius_m || nodule.centre_m[i] > phantom.size_m[i] - radius_m) {
            json.fail("centre_mm",
                      files::short_number(centre_mm[i]) + " with a radius of " + files::short_number(1e3 * radius_m),
                      "a sphere inside the block of " + files::short_number(1e3 * phantom.size_m[i]) + " mm");
        }
    }
    json.finish();
    return nodule;
}

void read_grid(files::JsonReader json, Phantom& phantom) {
    json.only({"origin_mm", "spacing_mm", "count"});
    const auto origin_mm = json.numbers("origin_mm", 2, {-1e4, 1e4});
    const auto spacing_mm = json.numbers("spacing_mm", 2, {0.0, 1e4, true});
    const auto count = json.numbers("count", 2, {1.0, 1e4});
    for (std::size_t i = 0; i < 2; ++i) {
        phantom.origin_m[i] = 1e-3 * origin_mm[i];
        phantom.spacing_m[i] = 1e-3 * spacing_mm[i];
        if (count[i] != static_cast<double>(static_cast<std::size_t>(count[i]))) {
            json.fail("count", files::short_number(count[i]), "whole numbers");
        }
    }
    phantom.n_x = static_cast<std::size_t>(count[0]);
    phantom.n_y = static_cast<std::size_t>(count[1]);
    json.finish();
}

}  // namespace

std::vector<Nodule> placed_nodules(const Phantom& phantom) {
    std::vector<Nodule> out;
    for (const PhantomNodule& nodule : phantom.nodules) {
        Nodule placed;
        placed.id = nodule.id;
        placed.x_m = nodule.centre_m[0];
        placed.y_m = nodule.centre_m[1];
        placed.diameter_m = nodule.diameter_m;
        placed.top_depth_m = nodule.centre_m[2] - 0.5 * nodule.diameter_m;
        out.push_back(placed);
    }
    return out;
}

Phantom read_phantom(const std::filesystem::path& path) {
    const files::Json root = files::read_json(path);
    files::JsonReader json(root, path.string());
    json.only({"size_mm", "tissue", "nodules", "indenter", "depths_mm", "grid"});
    Phantom phantom;
    phantom.name = path.stem().string();
    const auto size_mm = json.numbers("size_mm", 3, {0.0, 1e4, true});
    for (std::size_t i = 0; i < 3; ++i) phantom.size_m[i] = 1e-3 * size_mm[i];
    files::JsonReader tissue = json.object("tissue");
    tissue.only({"young_Pa", "poisson", "assumed"});
    phantom.tissue = read_elastic(tissue);
    phantom.tissue.assumed = tissue.boolean("assumed", false);
    tissue.finish();
    for (files::JsonReader& nodule : json.objects("nodules")) {
        const PhantomNodule read = read_nodule(nodule, phantom);
        const auto same = [&](const PhantomNodule& other) { return other.id == read.id; };
        if (std::any_of(phantom.nodules.begin(), phantom.nodules.end(), same))
            nodule.fail("id", files::shown(read.id) + " twice", "an id of its own for each nodule");
        phantom.nodules.push_back(read);
    }

    files::JsonReader indenter = json.object("indenter");
    indenter.only({"shape", "radius_mm", "length_mm", "contact", "friction"});
    phantom.indenter = static_cast<IndenterShape>(indenter.choice("shape", {"sphere", "cylinder"}));
    phantom.indenter_radius_m = 1e-3 * indenter.number("radius_mm", {0.0, 1e3, true});
    if (phantom.indenter == IndenterShape::cylinder) {
        phantom.indenter_length_m = 1e-3 * indenter.number("length_mm", {0.0, 1e4, true});
    } else if (indenter.has("length_mm")) {
        indenter.fail("length_mm", files::short_number(indenter.number("length_mm", {-1e9, 1e9})),
                      "none: a sphere has no length");
    }
    phantom.rolling = indenter.choice("contact", {"rolling", "sliding"}) == 0;
    phantom.friction = indenter.number("friction", {0.0, 10.0}, 0.0);
    indenter.finish();

    for (const double depth_mm : json.numbers("depths_mm", 0, {0.0, size_mm[2], true})) {
        if (!phantom.depths_m.empty() && 1e-3 * depth_mm <= phantom.depths_m.back()) {
            json.fail("depths_mm", files::short_number(depth_mm), "ascending depths");
        }
        phantom.depths_m.push_back(1e-3 * depth_mm);
    }
    read_grid(json.object("grid"), phantom);
    json.finish();
    return phantom;
}

Map map_of_phantom(const Phantom& phantom) {
    Map map;
    map.name = phantom.name;
    for (int i = 0; i < 2; ++i) {
        map.origin_m[i] = phantom.origin_m[i];
        map.spacing_m[i] = phantom.spacing_m[i];
    }
    map.n_x = phantom.n_x;
    map.n_y = phantom.n_y;
    map.depths_m = phantom.depths_m;
    map.indenter = phantom.indenter;
    map.indenter_radius_m = phantom.indenter_radius_m;
    map.tangential = TangentialKind::energy;
    map.nodules = placed_nodules(phantom);
    return map;
}

}  // namespace palpa::stiffnessmaps
