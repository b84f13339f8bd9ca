#pragma once
// The screen of a soft device: the deformed device, its actuators and their limits, the wanted and the rendered force, the
// inverse problem term by term, and how well its loop keeps time.

#include <memory>
#include <vector>

#include "app/screens/device_state.h"
#include "app/screens/gui.h"
#include "session/tangible_moment.h"

namespace palpa::app {

// One moment of a press.
struct ForceAtDepth {
    std::int64_t tick = 0;
    double depth_m = 0.0;
    double wanted_N = 0.0;
    double rendered_N = 0.0;  // NaN: not known
};

// What the loop of the soft device tells the screens; kept by the loop of the app.
struct TangibleShown : DriveState {
    static constexpr std::size_t kMostPoints = 800;
    session::TangibleMoment moment;
    session::TangibleBody body;  // empty until the device is open
    std::shared_ptr<session::TangibleShape> shape = std::make_shared<session::TangibleShape>();
    bool has_shape = false;
    bool was_pressed = false;
    bool device_leads = false;        // the finger is on the device, not on the screen
    std::vector<ForceAtDepth> press;  // the present press, or the last
};

struct Shown;
struct Wishes;
void draw_tangible_screen(const Shown& shown, Gui& gui, Wishes& wishes);

}  // namespace palpa::app
