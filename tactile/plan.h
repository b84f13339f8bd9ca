#pragma once
// What a scene's arm and display need, made once: the finger on the tissue, the pins, the devices' files. The loop
// (tactile/loop.h) works on it alone.

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/arm.h"
#include "devices/pins.h"
#include "mechanics/pin_shape.h"
#include "scene/plan.h"
#include "scene/stage_text.h"
#include "tactile/arm_compensation.h"
#include "tactile/pin_estimate.h"
#include "tactile/renderer.h"
#include "tactile/table.h"

namespace palpa::tactile {

// What the input brings: how deep the finger is, or how hard it presses.
enum class InputKind { depth, force };

struct TactilePlan {
    scene::TactileOptions options;
    InputKind input = InputKind::depth;
    Renderer renderer;
    std::shared_ptr<const Table> table;                  // made before the loop begins,
    std::shared_ptr<const TableInProgress> table_to_be;  // or while it runs; at most one of the two
    std::optional<mechanics::PinShape> pins;             // of a shape display
    Eigen::Matrix2Xd pressure_m;            // 2 x n, points of a pressure display relative to the finger; else empty
    std::optional<devices::ArmDevice> arm;  // absent: nothing moves
    std::optional<devices::PinDevice> pin_device;  // absent: the pins are only drawn
    std::optional<ArmCompensation> compensation;   // of a low-impedance arm
    PinDynamics pin_dynamics;
    double pin_rest_m = 0.0;  // height of the pins before the first command
    // The force at which the display's stroke is used up in the middle of the tissue; infinity if it is not at the limit.
    double stroke_used_up_N = std::numeric_limits<double>::infinity();
    double stiffness_N_per_m = 0.0;           // there, of a light press
    double greatest_stiffness_N_per_m = 0.0;  // there, of presses up to the force limit: what an arm may shake at
    std::vector<scene::StageText> stages;
    std::vector<std::string> notes;
};

// Makes the plan of a scene that has the key `tactile`, on its plan, which must outlive it (the finger presses on the
// tissue in it). Reads the device files. Makes no table yet. Throws InputError, among others for a tissue without a
// surface, an arm whose device has another impedance, a high-impedance arm without a force sensor between it and the
// display, and a display with more pins than a loop can take.
TactilePlan make_tactile_plan(const scene::Scene& scene, const scene::Plan& plan);

// The same for a tissue that knows no surface and answers depth with force alone: a force curve, a part, a button.
// `tissue`: its name, for people. Throws InputError with `file` for options with a display.
TactilePlan make_tactile_plan(const scene::TactileOptions& options, DepthForce curve, double stiffness_scale,
                              const std::string& tissue, const std::string& file);

// Makes the table that the scene asks for, if any, before the loop begins (which may take minutes), or begins to make it in
// a thread of its own. A table that does not become good enough is left out, and a note says so.
void make_table_now(const std::filesystem::path& cache, const mechanics::Progress& progress, TactilePlan& plan);
void make_table_meanwhile(const std::filesystem::path& cache, TactilePlan& plan);

// The table, once it is complete and good enough; else nullptr.
const Table* table_of(const TactilePlan& plan) noexcept;

// The stages of arm and display, in order, for `palpa explain`. `tissue`: what the finger presses on, for people.
std::vector<scene::StageText> stages_of(const TactilePlan& plan, const std::string& tissue);

// What is asked of whom, for people: "low-impedance arm: depth in, force out; shape display: stress in, shape out".
std::string pairing_text(const scene::TactileOptions& options);

}  // namespace palpa::tactile
