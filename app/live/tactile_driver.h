#pragma once
// The devices of a scene, arm and pins, while a trial drives them. In a browser there are none (app/web).

#include <memory>
#include <string>
#include <vector>

#include "app/live/driver_options.h"
#include "files/json.h"
#include "scene/plan.h"
#include "scene/state.h"
#include "session/tactile_moment.h"

namespace palpa::app {

// True if the scene names devices that this program can drive.
bool drives_devices(const scene::Scene& scene);

// What the scene's devices lack before they can run, such as a port that is not there, one sentence each; none: nothing.
std::vector<std::string> missing_devices(const scene::Scene& scene);

class TactileDriver {
  public:
    // Begins to open the devices, which takes a second or more (boards are proved first), in a thread of its own.
    TactileDriver(const scene::Scene& scene, std::shared_ptr<const scene::Plan> plan, const DriverOptions& options);
    ~TactileDriver();  // everything rests, and the loop has ended

    // True once the loop runs. Throws InputError or std::runtime_error if a device cannot be opened; no further call is
    // meant then.
    bool ready();

    // The rest does nothing before that.
    void hand_over(const scene::State& state);  // the touch on the screen
    bool latest(session::TactileMoment& moment);
    void stop();     // at once; stays until release()
    void release();  // by a person's wish only
    std::vector<session::TactileDevice> devices() const;
    files::Json report() const;  // null before ready(); ends the loop

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace palpa::app
