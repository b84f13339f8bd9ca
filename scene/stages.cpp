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
    }
    return "";
}

Stage stage_of(StageForm form, std::string fidelity, std::initializer_list<std::string_view> figures) {
    const StageFigures& row = figures_of(form);
    return {row.id, row.per_frame, std::move(fidelity), files::filled(row.error, figures), row.cost_us};
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
