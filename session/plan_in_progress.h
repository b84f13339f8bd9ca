#pragma once
// A plan that takes seconds to minutes is made in a worker thread, while the person is shown how far it has come.

#include <memory>

#include "scene/plan.h"

namespace palpa::session {

class PlanInProgress {
  public:
    explicit PlanInProgress(const scene::Scene& scene);
    ~PlanInProgress();  // stops the work and waits for it
    PlanInProgress(const PlanInProgress&) = delete;
    PlanInProgress& operator=(const PlanInProgress&) = delete;

    double share() const;       // of the work that is done, 0 ... 1
    bool wait(double seconds);  // waits for at most so long; true once the plan is ready or has failed
    void cancel();              // stops the work soon; take() then throws mechanics::Cancelled
    scene::Plan take();         // waits and hands over the plan, once; throws what make_plan() threw

  private:
    struct Work;
    std::unique_ptr<Work> work_;
};

// make_plan() for the command line: if stderr is a terminal, it shows the share that is done and the time that is left.
scene::Plan make_plan_here(const scene::Scene& scene);

}  // namespace palpa::session
