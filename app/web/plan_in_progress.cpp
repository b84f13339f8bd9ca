// The app in a browser has one thread, which a linear tissue would block for minutes, so such scenes are refused.

#include "session/plan_in_progress.h"

#include "files/input_error.h"

namespace palpa::session {

struct PlanInProgress::Work {};

PlanInProgress::PlanInProgress(const scene::Scene& scene) {
    throw files::InputError(
        "\"" + scene.name +
        "\" is a linear tissue, which is computed on the desk: found a browser, expected a scene with a map");
}
PlanInProgress::~PlanInProgress() = default;

double PlanInProgress::share() const { return 0.0; }
bool PlanInProgress::wait(double) { return true; }
void PlanInProgress::cancel() {}
scene::Plan PlanInProgress::take() { return {}; }

scene::Plan make_plan_here(const scene::Scene& scene) {
    if (takes_seconds(scene.tissue)) return PlanInProgress(scene).take();
    return scene::make_plan(scene);
}

}  // namespace palpa::session
