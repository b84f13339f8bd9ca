// What the plan of arm and pins says about itself.

#include <cmath>

#include "files/text.h"
#include "tactile/loop.h"

namespace palpa::tactile {
namespace {

using files::short_number;

std::string in_mm(double metres) { return short_number(1e3 * metres) + " mm"; }

std::string contact_text(const TactilePlan& plan) {
    const double diameter_m = plan.options.finger.diameter_m;
    switch (plan.options.finger.contact) {
        case scene::FingerContact::parabola:
            return "parabola of pressure, " + in_mm(diameter_m) + " wide";
        case scene::FingerContact::rigid:
            return "rigid sphere, " + in_mm(diameter_m) + " in diameter";
        case scene::FingerContact::pad:
            return "sphere of " + in_mm(diameter_m) + " with an elastic pad of assumed parameters";
    }
    return "";
}

scene::StageText finger_stage(const TactilePlan& plan, const std::string& tissue) {
    const bool high = plan.input == InputKind::force;
    const char* direction = high ? "; force in, depth out" : "; depth in, force out";
    scene::StageText stage{"finger", "step", contact_text(plan) + ", on " + tissue + direction,
                           "that of the tissue (docs/tactile.md)", 0.0};
    if (plan.options.table) {
        const scene::FingerTableOptions& table = *plan.options.table;
        stage.fidelity += "; from a table that begins at " + in_mm(table.spacing_m);
        stage.error += ", and " + short_number(100.0 * table.error) + " % of the greatest force from the table";
        stage.cost_us = 0.2;
    } else {
        stage.fidelity += "; solved at every step";
        stage.cost_us = 30.0;
    }
    return stage;
}

scene::StageText hold_stage(const TactilePlan& plan) {
    return {"force limit", "step", "above " + short_number(plan.options.force_limit_N) + " N force and shape hold",
            "exact", 0.0};
}

scene::StageText shape_stage(const TactilePlan& plan) {
    const mechanics::PinShape& pins = *plan.pins;
    const scene::DisplayOptions& display = *plan.options.display;
    std::string fidelity = std::to_string(pins.grid.rows) + " x " + std::to_string(pins.grid.columns) + " pins every " +
                           in_mm(pins.grid.pitch_m) + ", stroke " + in_mm(pins.grid.stroke_m);
    if (display.sheet != scene::SheetBacking::off)
        fidelity += ", through a rubber sheet of " + in_mm(pins.options.sheet_thickness_m);
    if (plan.stroke_used_up_N < plan.options.force_limit_N)
        fidelity += "; the stroke is used up at " + short_number(plan.stroke_used_up_N) + " N in the middle, then " +
                    (display.over_stroke == scene::OverStroke::clip ? "cut off" : "scaled");
    else
        fidelity += "; the stroke lasts up to the force limit in the middle";
    return {"pin shape", "step", fidelity,
            in_mm(0.5 * pins.grid.step_m) + " of rounding to steps of " + in_mm(pins.grid.step_m), 1.0};
}

scene::StageText schedule_stage(const TactilePlan& plan) {
    switch (plan.options.display->schedule) {
        case scene::PinSchedule::free:
            return {"schedule", "step", "the shape of now", "the pins lag by a frame and the servo", 0.0};
        case scene::PinSchedule::lead:
            return {"schedule", "step", "the shape of 20 ms ahead, extrapolated from what has been read",
                    "the press may turn within 20 ms", 0.1};
        case scene::PinSchedule::locked:
            return {"schedule", "step", "all pins at the top, locked", "no shape is shown", 0.0};
    }
    return {};
}

scene::StageText pressure_stage() {
    return {"pressure display", "frame", "drawn and logged only", "that of the finger", 0.0};
}

scene::StageText guard_stage() {
    return {"guard", "step", "range, slew, silence of 100 ms, stop: between the loop and the wire", "exact", 0.1};
}

}  // namespace

std::vector<scene::StageText> stages_of(const TactilePlan& plan, const std::string& tissue) {
    std::vector<scene::StageText> out{finger_stage(plan, tissue), hold_stage(plan)};
    if (plan.pins) {
        out.push_back(shape_stage(plan));
        out.push_back(schedule_stage(plan));
    } else if (plan.options.display) {
        out.push_back(pressure_stage());
    }
    if (plan.arm || plan.pin_device) out.push_back(guard_stage());
    return out;
}

std::string pairing_text(const scene::TactileOptions& options) {
    std::string text;
    if (options.arm) {
        text = options.arm->impedance == scene::ArmImpedance::low ? "low-impedance arm: depth in, force out"
                                                                  : "high-impedance arm: force in, depth out";
    }
    if (!options.display) return text;
    if (!text.empty()) text += "; ";
    return text + (options.display->kind == scene::DisplayKind::shape
                       ? "shape display (high impedance): stress in, shape out"
                       : "pressure display (low impedance): shape in, stress out");
}

}  // namespace palpa::tactile
