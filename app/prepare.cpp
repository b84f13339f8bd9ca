#include "app/prepare.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>

namespace palpa {

PlanInProgress::PlanInProgress(const Scene& scene) {
    result_ = std::async(std::launch::async, [this, scene] {
        mechanics::Progress progress;
        progress.cancel = &cancel_;
        progress.report = [this](int done, int total) {
            done_ = done;
            total_ = total;
        };
        return make_plan(scene, progress);
    });
}

PlanInProgress::~PlanInProgress() {
    cancel_ = true;
    if (result_.valid()) result_.wait();
}

double PlanInProgress::share() const {
    const int total = total_;
    return total > 0 ? static_cast<double>(done_) / total : 0.0;
}

bool PlanInProgress::wait(double seconds) {
    return result_.wait_for(std::chrono::duration<double>(seconds)) == std::future_status::ready;
}

Plan PlanInProgress::take() { return result_.get(); }

Plan make_plan_here(const Scene& scene) {
    if (!scene.linear || !isatty(STDERR_FILENO)) return make_plan(scene);
    PlanInProgress work(scene);
    const auto began = std::chrono::steady_clock::now();
    while (!work.wait(0.25)) {
        const double share = work.share();
        const double passed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        const double left_s = share > 0.0 ? passed_s / share - passed_s : 0.0;
        std::fprintf(stderr, "\rpreparing the tissue: %3.0f %%, %.0f s left ", 100.0 * share, left_s);
    }
    std::fprintf(stderr, "\r%50s\r", "");
    return work.take();
}

}  // namespace palpa
