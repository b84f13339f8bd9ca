// The app in a browser has one thread. A linear tissue would block it for minutes, so such scenes are refused; the finite
// cells of parts take seconds, and are iterated between the frames.

#include "session/plan_in_progress.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <optional>

#include "files/input_error.h"
#include "scene/part_tissue.h"
#include "scene/tissue.h"

namespace palpa::session {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kOfAFrame{8};  // so much of 16 stays for the picture

}  // namespace

struct PlanInProgress::Work {
    scene::Scene scene;
    std::optional<scene::PartCells> cells;  // while they are computed
    std::atomic<bool> cancel{false};
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
    if (const scene::PartOptions* parts = scene::part_options(work_->scene.tissue)) work_->cells.emplace(*parts);
}
PlanInProgress::~PlanInProgress() = default;

double PlanInProgress::share() const { return work_->cells ? work_->cells->share() : 1.0; }

bool PlanInProgress::wait(double seconds) {
    Work& work = *work_;
    if (work.plan || work.failed) return true;
    try {
        const auto until =
            Clock::now() + std::max<Clock::duration>(kOfAFrame, std::chrono::duration_cast<Clock::duration>(
                                                                    std::chrono::duration<double>(seconds)));
        while (work.cells) {
            if (!work.cells->advance()) work.cells.reset();
            if (work.cells && Clock::now() >= until) return false;
        }
        mechanics::Progress progress;
        progress.cancel = &work.cancel;
        work.plan = scene::make_plan(work.scene, progress);
    } catch (...) {
        work.failed = std::current_exception();
    }
    return true;
}

void PlanInProgress::cancel() {
    work_->cancel = true;
    work_->cells.reset();
}

scene::Plan PlanInProgress::take() {
    while (!wait(1.0)) {
    }
    if (work_->failed) std::rethrow_exception(work_->failed);
    return std::move(*work_->plan);
}

scene::Plan make_plan_here(const scene::Scene& scene) {
    if (takes_seconds(scene.tissue)) return PlanInProgress(scene).take();
    return scene::make_plan(scene);
}

}  // namespace palpa::session
