#include "app/study_scenes.h"

#include "app/assets.h"
#include "app/prepare.h"
#include "files/input_error.h"

namespace palpa {
namespace {

namespace fs = std::filesystem;

// Beside the protocol, else among the assets.
fs::path find_beside(const Protocol& protocol, const std::string& name, const char* kind) {
    const fs::path given(name);
    if (given.is_absolute()) return given;
    const fs::path beside = (protocol.file.parent_path() / given).lexically_normal();
    if (fs::exists(beside) || given.has_parent_path()) return beside;
    return assets_folder() / kind / given;
}

StudyScene load(const Protocol& protocol, const Condition& condition) {
    StudyScene out;
    const fs::path file = find_beside(protocol, condition.scene, "scenes");
    out.scene = read_scene(file, assets_folder());
    if (!condition.profile.empty()) out.scene.profile = find_beside(protocol, condition.profile, "profiles");
    out.plan = std::make_shared<const Plan>(make_plan_here(out.scene));
    return out;
}

}  // namespace

StudyScenes load_study_scenes(const Protocol& protocol) {
    StudyScenes scenes;
    for (std::size_t i = 0; i < protocol.conditions.size(); ++i) {
        const Condition& condition = protocol.conditions[i];
        scenes.emplace_back();
        if (condition.scene.empty()) continue;
        try {
            scenes.back() = load(protocol, condition);
        } catch (const InputError& error) {
            throw InputError(protocol.file.string() + ": conditions[" + std::to_string(i) + "] " +
                             shown(condition.id) + ": " + error.what());
        }
    }
    return scenes;
}

Scene scene_of(const StudyScene& scene, const PlannedTrial& trial) {
    Scene out = scene.scene;
    out.mapping.rotate_deg = trial.rotate_deg;
    out.mapping.flip = trial.flip;
    out.seed = trial.seed;
    return out;
}

}  // namespace palpa
