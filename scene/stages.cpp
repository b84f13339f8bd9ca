#include "scene/stages.h"

#include <utility>

#include "files/filled.h"

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
        case StageId::surface:
            return "surface";
    }
    return "";
}

Stage stage_of(StageForm form, std::string fidelity, std::initializer_list<std::string_view> figures) {
    const StageFigures& row = figures_of(form);
    return {row.id, row.per_frame, std::move(fidelity), files::filled(row.error, figures), row.cost_us};
}

}  // namespace palpa::scene
