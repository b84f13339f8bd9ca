#pragma once
// Making a plan that takes seconds, in a worker thread, while somebody is told how far it is.

#include <atomic>
#include <future>

#include "scene/plan.h"

namespace palpa {

class PlanInProgress {
 public:
    explicit PlanInProgress(const Scene& scene);
    ~PlanInProgress();  // stops the work and waits for it
    PlanInProgress(const PlanInProgress&) = delete;
    PlanInProgress& operator=(const PlanInProgress&) = delete;

    double share() const;         // done, 0 ... 1
    bool wait(double seconds);    // true once it is ready
    void cancel() { cancel_ = true; }
    Plan take();                  // once; throws what make_plan threw

 private:
    std::atomic<int> done_{0};
    std::atomic<int> total_{0};
    std::atomic<bool> cancel_{false};
    std::future<Plan> result_;
};

// make_plan on the command line: what is done of what, on a terminal.
Plan make_plan_here(const Scene& scene);

}  // namespace palpa
