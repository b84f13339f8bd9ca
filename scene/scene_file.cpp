#include <array>

#include "files/input_error.h"
#include "files/json.h"
#include "scene/find_file.h"
#include "scene/scene.h"
#include "scene/tissue.h"

namespace palpa::scene {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDefaultProfile = "s-pen.json";

Mapping read_mapping(files::JsonReader json) {
    json.only({"kind", "rotate_deg", "flip", "random_turn", "true_size", "tissue_mm"});
    Mapping mapping;
    mapping.kind = static_cast<MappingKind>(json.choice("kind", {"direct", "indirect"}));
    if (json.has("rotate_deg")) {
        mapping.rotate_deg = json.integer("rotate_deg", 0, 270);
        if (mapping.rotate_deg % 90 != 0) {
            json.fail("rotate_deg", std::to_string(mapping.rotate_deg), "0, 90, 180 or 270");
        }
    }
    mapping.flip = json.boolean("flip", false);
    mapping.random_turn = json.boolean("random_turn", false);
    mapping.true_size = json.boolean("true_size", true);
    if (json.has("tissue_mm")) {
        const auto size_mm = json.numbers("tissue_mm", 2, {0.0, 1e4, true});
        mapping.tissue_m = Eigen::Vector2d(1e-3 * size_mm[0], 1e-3 * size_mm[1]);
    }
    json.finish();
    return mapping;
}

void read_law_options(files::JsonReader& json, avatar::PathParameters& path, TangentialOptions& tangential) {
    constexpr files::Bounds kLength_mm{0.0, 100.0, true};
    path.reference_m = 1e-3 * json.number("s_ref_mm", kLength_mm, 1e3 * path.reference_m);
    path.dead_band_m = 1e-3 * json.number("dead_band_mm", {0.0, 10.0}, 1e3 * path.dead_band_m);
    if (json.has("force")) {
        tangential.force = static_cast<stiffnessmaps::TangentialForce>(json.choice("force", {"energy", "recorded"}));
    }
    tangential.per_newton = json.boolean("per_newton", tangential.per_newton);
    if (json.has("smoothing_mm")) tangential.smoothing_m = 1e-3 * json.number("smoothing_mm", {0.0, 100.0});
}

// Returns the strength of a law, if the file states one. `instead`: the parameter that it stands for.
std::optional<double> read_strength(files::JsonReader& json, const char* instead) {
    constexpr double kGreatest = 100.0;
    if (!json.has("strength")) return std::nullopt;
    if (json.has(instead)) json.fail("strength", "a strength beside " + std::string(instead), "one of the two");
    return json.number("strength", {0.0, kGreatest});
}

// Returns nothing for a law of strength 0, whose other keys then count no more than if the law were absent.
std::optional<avatar::DisplayRatio> read_display_ratio(files::JsonReader json, TangentialOptions& tangential) {
    json.only({"preset", "strength", "f_0_N", "cap_mm", "release", "gate_N", "hold_s", "pause_decay_s", "s_ref_mm",
               "dead_band_mm", "force", "smoothing_mm", "per_newton"});
    constexpr std::array kPresets{avatar::display_ratio_clear, avatar::display_ratio_paper,
                                  avatar::display_ratio_strong};
    avatar::DisplayRatio law = kPresets[json.choice("preset", {"clear", "paper", "strong"})]();
    const std::optional<double> strength = read_strength(json, "f_0_N");
    if (strength > 0.0) avatar::set_strength(*strength, law);
    law.f_0_N = json.number("f_0_N", files::kPositive, law.f_0_N);
    if (json.has("cap_mm")) {
        const bool none = json.any("cap_mm").is_null();
        law.cap_m = none ? std::nullopt : std::optional(1e-3 * json.number("cap_mm", {0.0, 1e3, true}));
    }
    law.release = json.number("release", files::kPositive, law.release);
    law.gate_N = json.number("gate_N", files::kPositive, law.gate_N);
    law.hold_s = json.number("hold_s", files::kNotNegative, law.hold_s);
    law.pause_decay_s = json.number("pause_decay_s", files::kPositive, law.pause_decay_s);
    TangentialOptions options;
    read_law_options(json, law.path, options);
    json.finish();
    if (strength == 0.0) return std::nullopt;
    tangential = options;
    return law;
}

std::optional<avatar::Delay> read_delay(files::JsonReader json, TangentialOptions& tangential) {
    json.only({"preset", "strength", "m_ms_per_N", "cap_ms", "rise", "fall", "hold_s", "s_ref_mm", "dead_band_mm",
               "force", "smoothing_mm", "per_newton"});
    constexpr std::array kPresets{avatar::delay_clear, avatar::delay_paper, avatar::delay_strong};
    avatar::Delay law = kPresets[json.choice("preset", {"clear", "paper", "strong"})]();
    const std::optional<double> strength = read_strength(json, "m_ms_per_N");
    if (strength > 0.0) avatar::set_strength(*strength, law);
    law.m_s_per_N = 1e-3 * json.number("m_ms_per_N", files::kNotNegative, 1e3 * law.m_s_per_N);
    // at most as long as the ring of remembered samples is at 2,000 Hz (avatar/delay.h)
    law.cap_s = 1e-3 * json.number("cap_ms", {0.0, 500.0}, 1e3 * law.cap_s);
    law.rise = json.number("rise", {0.0, 0.999, true}, law.rise);
    law.fall = json.number("fall", {0.0, 100.0, true}, law.fall);
    law.hold_s = json.number("hold_s", files::kNotNegative, law.hold_s);
    TangentialOptions options;
    read_law_options(json, law.path, options);
    json.finish();
    if (strength == 0.0) return std::nullopt;
    tangential = options;
    return law;
}

// Whether the centre is on the block is known only with the phantom (make_linear_tissue).
mechanics::Grading read_grading(files::JsonReader json, double spacing_m) {
    json.only({"centre_mm", "finest_mm"});
    const auto centre_mm = json.numbers("centre_mm", 2, files::kNotNegative);
    const double finest_mm = json.number("finest_mm", {0.1, 1e3 * spacing_m});
    json.finish();
    return {{1e-3 * centre_mm[0], 1e-3 * centre_mm[1]}, 1e-3 * finest_mm};
}

std::array<int, 2> read_view(files::JsonReader& json) {
    if (!json.has("view")) return {0, 2};
    const files::Json& view = json.any("view");
    const std::string axes = "xyz";
    std::array<int, 2> out{};
    for (std::size_t k = 0; k < 2; ++k) {
        const bool letter = view.is_array() && view.size() == 2 && view[k].is_string() &&
                            view[k].get<std::string>().size() == 1 &&
                            axes.find(view[k].get<std::string>()) != std::string::npos;
        if (!letter) json.fail("view", files::described(view), "two of \"x\", \"y\", \"z\": to the right and upwards");
        out[k] = static_cast<int>(axes.find(view[k].get<std::string>()));
    }
    if (out[0] == out[1]) json.fail("view", "one axis twice", "two different axes");
    return out;
}

PartOptions read_part_tissue(files::JsonReader json, const fs::path& file, const fs::path& assets) {
    json.only({"designs", "load", "method", "cell_mm", "gesture", "view", "both"});
    PartOptions out;
    const std::vector<std::string> designs = json.texts("designs", 1, "names of part files");
    if (designs.size() > 2)
        json.fail("designs", std::to_string(designs.size()) + " part files", "one or two part files");
    for (const std::string& name : designs) out.designs.push_back(find_file(name, file, assets / "parts"));
    out.load = json.text("load", "");
    if (json.has("method")) {
        constexpr std::array kMethods{parts::Method::paper, parts::Method::euler_bernoulli, parts::Method::timoshenko,
                                      parts::Method::voxels};
        out.method = kMethods[json.choice("method", {"paper", "euler-bernoulli", "timoshenko", "voxels"})];
    }
    if (json.has("cell_mm")) out.cell_m = 1e-3 * json.number("cell_mm", {1e-4, 1e3});
    if (json.has("gesture")) out.gesture = static_cast<PartGesture>(json.choice("gesture", {"press", "pull"}));
    out.view = read_view(json);
    out.both = json.boolean("both", false);
    json.finish();
    return out;
}

LinearOptions read_linear(files::JsonReader block, const fs::path& file, const fs::path& assets) {
    block.only({"phantom", "spacing_mm", "friction", "grading"});
    LinearOptions options;
    options.phantom = find_file(block.text("phantom"), file, assets / "phantoms");
    options.spacing_m = 1e-3 * block.number("spacing_mm", {0.2, 100.0}, 1e3 * options.spacing_m);
    if (block.has("friction")) options.friction = block.number("friction", {0.0, 10.0, true});
    if (auto grading = block.optional_object("grading")) options.grading = read_grading(*grading, options.spacing_m);
    block.finish();
    return options;
}

void read_tissue(files::JsonReader json, const fs::path& file, const fs::path& assets, Scene& scene) {
    json.only({"map", "linear", "part", "force_curve", "block", "stiffness_scale"});
    const int kinds =
        json.has("map") + json.has("linear") + json.has("part") + json.has("force_curve") + json.has("block");
    if (kinds != 1) {
        json.fail("", kinds == 0 ? "no tissue" : std::to_string(kinds) + " tissues",
                  "one of map, linear, part, force_curve and block");
    }
    scene.stiffness_scale = json.number("stiffness_scale", {0.0, 1e3, true}, scene.stiffness_scale);
    if (json.has("map")) scene.tissue = MapOptions{find_file(json.text("map"), file, assets / "maps")};
    if (auto linear = json.optional_object("linear")) scene.tissue = read_linear(*linear, file, assets);
    if (auto part = json.optional_object("part")) scene.tissue = read_part_tissue(*part, file, assets);
    if (auto curve = json.optional_object("force_curve")) scene.tissue = read_force_curve(*curve);
    if (auto block = json.optional_object("block")) scene.tissue = read_soft_block(*block);
    json.finish();
}

SurfaceEffect read_surface(files::JsonReader json) {
    json.only({"profile", "material", "indenter"});
    SurfaceEffect surface;
    if (json.has("material")) {
        surface.material = static_cast<SurfaceMaterial>(json.choice("material", {"skin", "silicone"}));
    }
    if (json.has("indenter")) {
        surface.indenter = static_cast<DrawnIndenter>(json.choice("indenter", {"ball", "probe", "fingertip"}));
    }
    files::JsonReader profile = json.object("profile");
    profile.only({"thickness_mm", "indenter_radius_mm"});
    surface.thickness_m = 1e-3 * profile.number("thickness_mm", {0.0, 1e3, true}, 1e3 * surface.thickness_m);
    if (profile.has("indenter_radius_mm")) {
        surface.indenter_radius_m = 1e-3 * profile.number("indenter_radius_mm", {0.0, 1e3, true});
    }
    profile.finish();
    json.finish();
    return surface;
}

DrawnCues read_cues(files::JsonReader json) {
    json.only({"footprint", "crease", "depth_gain", "side_view"});
    DrawnCues cues;
    cues.footprint = json.number("footprint", {0.0, 10.0}, cues.footprint);
    cues.crease = json.number("crease", {0.0, 1.0}, cues.crease);
    cues.depth_gain = json.number("depth_gain", {0.0, 3.0}, cues.depth_gain);
    cues.side_view = json.boolean("side_view", cues.side_view);
    json.finish();
    return cues;
}

std::optional<TextureDrag> read_texture_drag(files::JsonReader json) {
    json.only({"strength"});
    const TextureDrag drag{json.number("strength", {0.0, 1.0}, TextureDrag{}.strength)};
    json.finish();
    return drag.strength > 0.0 ? std::optional(drag) : std::nullopt;
}

void read_avatar(files::JsonReader json, Scene& scene) {
    json.only({"display_ratio", "delay", "texture_drag"});
    const bool ratio = json.has("display_ratio");
    if (ratio == json.has("delay")) {
        json.fail("", ratio ? "both laws" : "no law", "display_ratio or delay (leave `avatar` out for neither)");
    }
    if (ratio) {
        scene.display_ratio = read_display_ratio(json.object("display_ratio"), scene.tangential);
    } else {
        scene.delay = read_delay(json.object("delay"), scene.tangential);
    }
    if (auto drag = json.optional_object("texture_drag")) scene.texture_drag = read_texture_drag(*drag);
    if (!scene.display_ratio && !scene.delay) scene.texture_drag.reset();  // there is no lag to hand over
    json.finish();
}

}  // namespace

Scene read_scene(const fs::path& file, const fs::path& assets) {
    const files::Json root = files::read_json(file);
    files::JsonReader json(root, file.string());
    json.only({"name", "tissue", "profile", "mapping", "force_scale", "avatar", "surface", "cues", "tactile",
               "tangible", "seed"});
    Scene scene;
    scene.file = file;
    scene.name = json.text("name");
    files::JsonReader tissue = json.object("tissue");
    read_tissue(std::move(tissue), file, assets, scene);
    scene.profile = find_file(json.text("profile", kDefaultProfile), file, assets / "profiles");
    if (auto mapping = json.optional_object("mapping")) scene.mapping = read_mapping(*mapping);
    scene.force_scale = json.number("force_scale", {0.0, 1e3, true}, scene.force_scale);
    if (auto avatar = json.optional_object("avatar")) read_avatar(*avatar, scene);
    if (auto surface = json.optional_object("surface")) scene.surface = read_surface(*surface);
    if (auto cues = json.optional_object("cues")) {
        if (!scene.surface) json.fail("cues", "no surface to draw them on", "the key surface beside it");
        scene.cues = read_cues(*cues);
    }
    if (auto tactile = json.optional_object("tactile")) {
        if (!knows_surface(scene.tissue) && !is_curve(scene.tissue))
            json.fail("tactile", "a tissue that knows no surface",
                      "linear, force_curve or block: maps and parts know no surface under a finger");
        scene.tactile = read_tactile(*tactile, file, assets);
        if (!knows_surface(scene.tissue) && scene.tactile->display)
            json.fail("tactile.display", "a display on a tissue without a surface", "linear, or an arm alone");
    }
    if (auto tangible = json.optional_object("tangible")) scene.tangible = read_tangible(*tangible, file, assets);
    scene.seed = json.integer("seed", 0, 2000000000, 1);
    json.finish();
    return scene;
}

avatar::PathParameters path_of(const Scene& scene) {
    if (scene.delay) return scene.delay->path;
    return scene.display_ratio ? scene.display_ratio->path : avatar::PathParameters{};
}

Scene scene_of_map(const fs::path& map, const fs::path& assets) {
    Scene scene;
    fs::path folder = map;
    if (!folder.has_filename()) folder = folder.parent_path();
    scene.name = folder.stem().string();
    scene.tissue = MapOptions{map};
    scene.profile = assets / "profiles" / kDefaultProfile;
    scene.display_ratio = avatar::display_ratio_clear();
    scene.surface = SurfaceEffect{};
    return scene;
}

}  // namespace palpa::scene
