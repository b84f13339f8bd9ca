// The key `tangible` of a scene file.

#include "scene/find_file.h"
#include "scene/tangible_options.h"

namespace palpa::scene {

TangibleOptions read_tangible(files::JsonReader json, const std::filesystem::path& scene_file,
                              const std::filesystem::path& assets) {
    json.only({"device", "at_mm", "force_scale", "depth_scale", "rate_share", "plant", "fidelity", "command"});
    TangibleOptions options;
    options.device = find_file(json.text("device"), scene_file, assets / "devices");
    if (json.has("at_mm")) {
        if (const files::Json& at = json.any("at_mm"); at.is_string()) {
            json.choice("at_mm", {"touch"});
        } else {
            const auto at_mm = json.numbers("at_mm", 2, {-1e4, 1e4});
            options.at_m = Eigen::Vector2d(1e-3 * at_mm[0], 1e-3 * at_mm[1]);
        }
    }
    options.force_scale = json.number("force_scale", {0.0, 1e3, true}, options.force_scale);
    options.depth_scale = json.number("depth_scale", {0.0, 1e3, true}, options.depth_scale);
    options.rate_share = json.number("rate_share", {0.01, 1.0}, options.rate_share);
    if (json.has("plant")) {
        options.plant = json.text("plant");
        if (options.plant != "exact") options.plant = find_file(options.plant, scene_file, assets / "plants").string();
    }
    if (json.has("fidelity")) {
        json.choice("fidelity", {"step", "converged", "stale", "linear"});
        options.fidelity = json.text("fidelity");
    }
    if (json.has("command")) {
        json.choice("command", {"force", "position"});
        options.command = json.text("command");
    }
    json.finish();
    return options;
}

}  // namespace palpa::scene
