#include "scene/stages.h"

#include <cmath>
#include <utility>

#include "files/filled.h"
#include "files/text.h"
#include "scene/scene.h"

namespace palpa::scene {

const char* name_of(StageId id) {
    switch (id) {
        case StageId::calibration:
            return "calibration";
        case StageId::position:
            return "position";
        case StageId::depth:
            return "depth";
        case StageId::friction:
            return "friction";
        case StageId::tangential:
            return "tangential";
        case StageId::display_ratio:
            return "display_ratio";
        case StageId::delay:
            return "delay";
        case StageId::texture_drag:
            return "texture_drag";
        case StageId::surface:
            return "surface";
        case StageId::footprint:
            return "footprint";
        case StageId::crease:
            return "crease";
        case StageId::depth_gain:
            return "depth_gain";
    }
    return "";
}

Stage stage_of(StageForm form, std::string fidelity, std::initializer_list<std::string_view> figures) {
    const StageFigures& row = figures_of(form);
    return {row.id, row.per_frame, std::move(fidelity), files::filled(row.error, figures), row.cost_us};
}

void add_cue_stages(const Scene& scene, std::vector<Stage>& out) {
    const DrawnCues& cues = scene.cues;
    const auto of = [](double strength) { return files::short_number(strength); };
    if (cues.footprint > 0.0)
        out.push_back(
            stage_of(StageForm::footprint_ring, "ring, " + of(cues.footprint) + " mm of radius for each mm of depth"));
    if (cues.crease > 0.0) out.push_back(stage_of(StageForm::crease_shadow, "shadow, strength " + of(cues.crease)));
    if (cues.depth_gain > 0.0)
        out.push_back(stage_of(StageForm::depth_exaggerated, "surface and indenter, strength " + of(cues.depth_gain),
                               {of(1.0 + cues.depth_gain)}));
}

void add_law_stages(const Scene& scene, const avatar::StationLimit& limit, StageForm display_ratio, StageForm delay,
                    std::vector<Stage>& out) {
    const avatar::PathParameters path = path_of(scene);
    const auto mm_text = [](double metres) { return files::short_number(1e3 * metres) + " mm"; };
    std::string stations =
        "stations every " + mm_text(path.station_m) + ", difference over " + mm_text(path.reference_m);
    if (std::isfinite(limit.per_s))
        stations += ", fewer in strokes faster than " + mm_text(limit.per_s * path.station_m) + "/s";
    if (scene.tangential.per_newton) stations += ", per newton of normal force";
    if (scene.display_ratio) out.push_back(stage_of(display_ratio, stations));
    if (scene.delay) out.push_back(stage_of(delay, stations));
    if (scene.texture_drag) {
        out.push_back(stage_of(StageForm::texture_drag, "under a finger, " +
                                                            files::short_number(100.0 * scene.texture_drag->strength) +
                                                            " % of the lag goes to the texture"));
    }
}

}  // namespace palpa::scene
