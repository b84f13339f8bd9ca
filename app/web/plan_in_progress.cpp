// The app in a browser has one thread. A linear tissue would block it for minutes, so such scenes are refused; the finite
// cells of parts take seconds, during which the page stands still.

#include "session/plan_in_progress.h"

#include <exception>
#include <optional>

#include "files/input_error.h"

namespace palpa::session {

struct PlanInProgress::Work {
    scene::Scene scene;
    std::optional<scene::Plan> plan;
    std::exception_ptr failed;
};

PlanInProgress::PlanInProgress(const scene::Scene& scene) : work_(std::make_unique<Work>()) {
    if (knows_surface(scene.tissue)) {
        throw files::InputError(
            "\"" + scene.name +
            "\" is a linear tissue, which is computed on the desk: found a browser, expected a scene with a map");
    }
    work_->scene = scene;
}
PlanInProgress::~PlanInProgress() = default;

double PlanInProgress::share() const { return work_->plan ? 1.0 : 0.0; }

bool PlanInProgress::wait(double) {
    if (work_->plan || work_->failed) return true;
    try {
        work_->plan = scene::make_plan(work_->scene);
    } catch (...) {
        work_->failed = std::current_exception();
    }
    return true;
}

void PlanInProgress::cancel() {}

scene::Plan PlanInProgress::take() {
    wait(0.0);
    if (work_->failed) std::rethrow_exception(work_->failed);
    return std::move(*work_->plan);
}

scene::Plan make_plan_here(const scene::Scene& scene) {
    if (takes_seconds(scene.tissue)) return PlanInProgress(scene).take();
    return scene::make_plan(scene);
}

}  // namespace palpa::session
