#pragma once
// Making a plan that takes seconds, in a worker thread, while somebody is told how far it is.

#include <memory>

#include "scene/plan.h"

namespace palpa::session {

class PlanInProgress {
  public:
    explicit PlanInProgress(const scene::Scene& scene);
    ~PlanInProgress();  // stops the work and waits for it
    PlanInProgress(const PlanInProgress&) = delete;
    PlanInProgress& operator=(const PlanInProgress&) = delete;

    double share() const;       // done, 0 ... 1
    bool wait(double seconds);  // true once it is ready
    void cancel();
    scene::Plan take();  // once; throws what make_plan threw

  private:
    struct Work;
    std::unique_ptr<Work> work_;
};

// make_plan on the command line: what is done of what, on a terminal.
scene::Plan make_plan_here(const scene::Scene& scene);

}  // namespace palpa::session
