#include "app/study/study_scenes.h"

#include <map>
#include <set>
#include <string>
#include <utility>

#include "app/assets.h"
#include "files/input_error.h"
#include "files/sha256.h"
#include "session/plan_in_progress.h"
#include "study/names.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

// Returns the file beside the protocol, else the one among the assets.
fs::path find_beside(const study::Protocol& protocol, const std::string& name, const char* kind) {
    const fs::path given(name);
    if (given.is_absolute()) return given;
    const fs::path beside = (protocol.file.parent_path() / given).lexically_normal();
    if (fs::exists(beside) || given.has_parent_path()) return beside;
    return assets_folder() / kind / given;
}

// Throws InputError for nodules whose names the logs cannot tell apart or tables cannot hold: the logs of such a study
// could never be analysed.
void check_nodules(const fs::path& file, const scene::Plan& plan) {
    std::set<std::string> ids;
    for (const stiffnessmaps::Nodule& nodule : plan.nodules) {
        if (!study::is_name(nodule.id))
            throw files::bad_input(file.string(), "nodules", files::shown(nodule.id), std::string(study::kNameRule));
        if (!ids.insert(nodule.id).second)
            throw files::bad_input(file.string(), "nodules", files::shown(nodule.id) + " twice",
                                   "another id for each nodule");
    }
}

// Throws InputError for a search on tissue whose nodules nobody has named: it could not be scored.
void check_known(const StudyScene& found) {
    if (found.plan->nodules_known) return;
    throw files::bad_input(found.scene.file.string(), "tissue", "a map that does not say which nodules it has",
                           "`nodules` in its map.json (`palpa maps detect MAP --write` looks for them); [] for none");
}

// Loads each scene once, however many conditions show it with the same profile.
class SceneLoader {
  public:
    explicit SceneLoader(const study::Protocol& protocol) : protocol_(protocol) {}

    StudyScene load(const study::Condition& condition) {
        const fs::path file = find_beside(protocol_, condition.scene, "scenes");
        const auto [it, fresh] = loaded_.try_emplace({file, condition.profile});
        if (!fresh) return it->second;
        StudyScene out;
        out.scene = scene::read_scene(file, assets_folder());
        if (!condition.profile.empty()) out.scene.profile = find_beside(protocol_, condition.profile, "profiles");
        out.plan = std::make_shared<const scene::Plan>(session::make_plan_here(out.scene));
        check_nodules(file, *out.plan);
        return it->second = out;
    }

  private:
    const study::Protocol& protocol_;
    std::map<std::pair<fs::path, std::string>, StudyScene> loaded_;
};

}  // namespace

StudyScenes load_study_scenes(const study::Protocol& protocol) {
    StudyScenes scenes;
    SceneLoader loader(protocol);
    for (std::size_t i = 0; i < protocol.conditions.size(); ++i) {
        const study::Condition& condition = protocol.conditions[i];
        scenes.emplace_back();
        if (condition.scene.empty()) continue;
        try {
            scenes.back() = loader.load(condition);
            if (!study::compares(study::task_of(protocol, i))) check_known(*scenes.back());
        } catch (const files::InputError& error) {
            throw files::InputError(protocol.file.string() + ": conditions[" + std::to_string(i) + "] " +
                                    files::shown(condition.id) + ": " + error.what());
        }
    }
    return scenes;
}

void refuse_counts(const study::Protocol& protocol, const StudyScenes& scenes) {
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const study::Condition& condition = protocol.conditions[i];
        if (!scenes[i] || condition.typed_in) continue;
        const calibration::Profile& profile = scenes[i]->plan->profile;
        if (profile.level != calibration::LevelField::pressure_raw) continue;
        throw files::bad_input(protocol.file.string(),
                               "conditions[" + std::to_string(i) + "] " + files::shown(condition.id),
                               "calibration profile " + files::shown(profile.id) + ", which reads pressure_raw",
                               "one that reads pressure or contact_area: browsers report no others (palpa study run on "
                               "the desk does)");
    }
}

void note_typed_in(const StudyScenes& scenes, study::Protocol& protocol) {
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const study::Modality modality = protocol.conditions[i].modality;
        const bool driven = modality == study::Modality::tangible ? scenes[i] && scenes[i]->scene.tangible
                                                                  : scenes[i] && scenes[i]->scene.tactile;
        const bool display = modality == study::Modality::tangible || modality == study::Modality::shape_display;
        protocol.conditions[i].typed_in = modality == study::Modality::hand || (display && !driven);
    }
}

files::Json identity_of(const std::optional<StudyScene>& scene) {
    files::Json json = files::Json::object();
    if (!scene) return json;
    json["profile_sha256"] = files::sha256_of_file(scene->scene.profile);
    json.update(scene::file_hashes(scene->scene.tissue));
    return json;
}

std::vector<files::Json> identities_of(const StudyScenes& scenes) {
    std::vector<files::Json> out;
    std::map<const scene::Plan*, std::size_t> first;  // conditions with one plan have the same files
    for (const auto& scene : scenes) {
        const auto [it, fresh] = first.emplace(scene ? scene->plan.get() : nullptr, out.size());
        out.push_back(fresh ? identity_of(scene) : out[it->second]);
    }
    return out;
}

study::TrialLabel label_of(const study::Protocol& protocol, const study::PlannedParticipant& who,
                           const study::PlannedTrial& trial, const files::Json& identity) {
    const study::Condition& condition = protocol.conditions[trial.condition];
    files::Json study{{"protocol", protocol.name},
                      {"version", protocol.version},
                      {"sha256", protocol.sha256},
                      {"seed", protocol.seed},
                      {"participant_number", who.number},
                      {"group", protocol.groups[who.group].id},
                      {"modality", name_of(condition.modality)},
                      {"trial_seed", trial.seed}};
    study.update(identity);
    return {condition.id, condition.device, trial.trial, who.order_id, study, trial.practice};
}

scene::Scene scene_of(const StudyScene& scene, const study::PlannedTrial& trial) {
    scene::Scene out = scene.scene;
    out.mapping.rotate_deg = trial.rotate_deg;
    out.mapping.flip = trial.flip;
    out.seed = trial.seed;
    return out;
}

}  // namespace palpa::app
