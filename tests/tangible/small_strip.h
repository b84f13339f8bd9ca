#pragma once
// The strip of the assets with fewer cells, which takes a millisecond a step, and tissues of known force to press.

#include <memory>

#include "files/json.h"
#include "tangible/characterise.h"
#include "tests/assets.h"

namespace palpa::test {

inline files::Json strip_json() { return files::read_json(kAssets / "devices" / "strip.json"); }

// The device keeps the name of the assets' file, so that plants are made from that file: `changes` stand in the plant too.
inline files::Json fewer_cells() { return files::Json::parse(R"({"mesh": {"box": {"elements": [50, 2, 2]}}})"); }

inline std::shared_ptr<const tangible::DeviceModel> small_strip(double modulus_factor = 1.0,
                                                                double friction_share = 0.0, double lag_s = 0.0) {
    files::Json json = strip_json();
    json.merge_patch(fewer_cells());
    tangible::SoftDevice device =
        tangible::parse_soft_device(json, (kAssets / "devices" / "strip.json").string(), kAssets / "devices");
    device.fit.modulus_factor = modulus_factor;
    device.fit.friction_share = friction_share;
    device.fit.lag_s = lag_s;
    return std::make_shared<const tangible::DeviceModel>(tangible::make_device_model(device));
}

inline tangible::PlantOptions small_plant(double modulus_factor = 1.0) {
    tangible::PlantOptions options;
    options.device = fewer_cells();
    options.modulus_factor = modulus_factor;
    return options;
}

// A law of force over depth, kept with the world that points to it.
struct KnownTissue {
    explicit KnownTissue(double stiffness_N_per_mm, double growth_mm = 1e9) {
        scene::ForceCurveOptions options;
        options.curve.stiffness_N_per_m = 1e3 * stiffness_N_per_mm;
        options.curve.growth_m = 1e-3 * growth_mm;
        options.curve.greatest_depth_m = 20e-3;
        tissue = scene::ForceCurveTissue{options};
        world.tissue = &tissue;
    }
    KnownTissue(const KnownTissue&) = delete;
    KnownTissue& operator=(const KnownTissue&) = delete;

    scene::Tissue tissue;
    tangible::World world;
};

inline tangible::PressFigures press_small(double stiffness_N_per_mm, const tangible::PlantOptions& plant,
                                          const tangible::LoopOptions& loop = {}, double friction_share = 0.0,
                                          double growth_mm = 1e9, double lag_s = 0.0) {
    const KnownTissue known(stiffness_N_per_mm, growth_mm);
    const auto model = small_strip(1.0, friction_share, lag_s);
    const tangible::TangiblePlan plan = tangible::make_tangible_plan(model, known.world, {0.0, 0.0}, loop);
    return tangible::run_press(plan, tangible::make_plant(model, plant, loop), {4e-3, 8e-3}, 1);
}

}  // namespace palpa::test
