#pragma once
// Pins that are only drawn: the heights that a scene's shape display would have under the touch on the screen, where no
// device shows them. Computed once a frame from the numbers that also drive pins (mechanics/finger.h, pin_shape.h).

#include <Eigen/Core>
#include <memory>

#include "mechanics/finger.h"
#include "mechanics/pin_shape.h"
#include "scene/plan.h"
#include "scene/state.h"
#include "session/tactile_moment.h"

namespace palpa::app {

// The pins are the shipped ones, 6 x 6 (mechanics::PinGrid), and an elastic pad is the shipped one: no device is there
// that could say otherwise.
struct PinsPreview {
    std::shared_ptr<const scene::Plan> plan;  // keeps the compliance
    const mechanics::Compliance* compliance = nullptr;
    mechanics::Finger finger;
    mechanics::FingerWork work;
    mechanics::PinShape shape;
    double stiffness_scale = 1.0;
    double force_limit_N = 2.5;
    bool pressure = false;  // a pressure display: `wanted_m` holds shares of the greatest pressure instead of heights
    Eigen::Matrix2Xd points_m;
    Eigen::VectorXd sampled;
    Eigen::VectorXd height_m;
};

// Null if the scene has no display, or a tissue whose surface is not known. Throws mechanics' errors.
std::shared_ptr<PinsPreview> make_pins_preview(const scene::Scene& scene,
                                               const std::shared_ptr<const scene::Plan>& plan);

// The pins under the present touch. Allocates nothing.
void preview_pins(const scene::State& state, PinsPreview& preview, session::TactileMoment& moment);

}  // namespace palpa::app
