#pragma once
// The soft device of a scene while a trial drives it. In a browser, and in a build without PALPA_TANGIBLE, there is none
// (no_tangible_driver.cpp).

#include <memory>
#include <string>
#include <vector>

#include "app/live/driver_options.h"
#include "files/json.h"
#include "scene/plan.h"
#include "scene/state.h"
#include "session/tactile_moment.h"
#include "session/tangible_moment.h"

namespace palpa::app {

// What the scene's soft device lacks before it can run, such as a port that is not there, one sentence each; none: nothing.
std::vector<std::string> missing_soft_device(const scene::Scene& scene);

class TangibleDriver {
  public:
    // Begins to open the device, in a thread of its own. With options.simulate, the simulated plant is started instead.
    TangibleDriver(const scene::Scene& scene, std::shared_ptr<const scene::Plan> plan, const DriverOptions& options);
    ~TangibleDriver();  // the device is relaxed, and the loop has ended

    // True once the loop runs. Throws InputError or std::runtime_error if the device cannot be opened; no further call is
    // meant then.
    bool ready();

    // The rest does nothing before that.
    void hand_over(const scene::State& state);  // the touch on the screen
    bool latest(session::TangibleMoment& moment);
    bool latest(session::TangibleShape& shape);
    session::TangibleBody body() const;
    void stop();     // at once; stays until release()
    void release();  // by a person's wish only
    std::vector<session::TactileDevice> devices() const;
    files::Json report() const;  // null before ready(); ends the loop

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace palpa::app
