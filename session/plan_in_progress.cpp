#include "session/plan_in_progress.h"

#include <atomic>
#include <chrono>
#include <future>
#include <unistd.h>

#include "files/progress_line.h"

namespace palpa::session {

struct PlanInProgress::Work {
    std::atomic<int> done{0};
    std::atomic<int> total{0};
    std::atomic<bool> cancel{false};
    std::future<scene::Plan> result;
};

PlanInProgress::PlanInProgress(const scene::Scene& scene) : work_(std::make_unique<Work>()) {
    work_->result = std::async(std::launch::async, [&work = *work_, scene] {
        mechanics::Progress progress;
        progress.cancel = &work.cancel;
        progress.report = [&work](int done, int total) {
            work.done = done;
            work.total = total;
        };
        return scene::make_plan(scene, progress);
    });
}

PlanInProgress::~PlanInProgress() {
    work_->cancel = true;
    if (work_->result.valid()) work_->result.wait();
}

double PlanInProgress::share() const {
    const int total = work_->total;
    return total > 0 ? static_cast<double>(work_->done) / total : 0.0;
}

bool PlanInProgress::wait(double seconds) {
    return work_->result.wait_for(std::chrono::duration<double>(seconds)) == std::future_status::ready;
}

void PlanInProgress::cancel() { work_->cancel = true; }

scene::Plan PlanInProgress::take() { return work_->result.get(); }

scene::Plan make_plan_here(const scene::Scene& scene) {
    if (!takes_seconds(scene.tissue) || !isatty(STDERR_FILENO)) return scene::make_plan(scene);
    PlanInProgress work(scene);
    files::ProgressLine line;
    while (!work.wait(0.25)) line.show("preparing the tissue", work.share());
    return work.take();
}

}  // namespace palpa::session
