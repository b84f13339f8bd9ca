#include <doctest/doctest.h>
#include <utility>

#include "app/study/study_device.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::study;
using namespace palpa::app;

TEST_CASE("study device: a pen's trial, and a finger's, needs a pressure that varies, or might") {
    for (const auto& [modality, tool] : {std::pair{Modality::pen, Tool::pen}, {Modality::finger, Tool::finger}}) {
        CAPTURE(name_of(modality));
        const PointerDevice sensing{1, "Sensing", tool, true}, blunt{1, "Blunt", tool, false};
        const auto verdict = [&](const PointerDevice& device, const PressureWatch& pressure) {
            return pressure_verdict(modality, false, {device}, true, pressure);
        };
        const auto pressed = [&](double step) {
            PressureWatch out;
            Sample sample;
            sample.tool = tool;
            for (int i = 0; i < 100; ++i) {
                sample.phase = i == 0 ? Phase::down : Phase::move;
                sample.t_host_s = 0.01 * i;
                sample.pressure = 0.5 + step * i;
                watch(sample, out);
            }
            return out;
        };
        CHECK(verdict(sensing, {}) == PressureVerdict::untried);
        CHECK(verdict(blunt, {}) == PressureVerdict::no_pressure);
        CHECK(verdict(sensing, pressed(0.0)) == PressureVerdict::no_pressure);
        CHECK(verdict(sensing, pressed(0.001)) == PressureVerdict::ready);
        CHECK(pressure_verdict(modality, true, {blunt}, true, {}) == PressureVerdict::not_needed);
        CHECK(pressure_verdict(modality, false, {}, false, {}) == PressureVerdict::untried);
        const PointerDevice mouse{2, "Mouse", Tool::mouse, false};
        CHECK(pressure_verdict(Modality::mouse, false, {mouse}, true, pressed(0.0)) == PressureVerdict::not_needed);
    }
}

TEST_CASE("study device: a finger's trial by contact area is refused where all touches have the same size") {
    const auto verdict = [](double step_px, double seconds) {
        PressureWatch seen;
        Sample sample;
        sample.tool = Tool::finger;
        for (int i = 0; 0.01 * i <= seconds; ++i) {
            sample.phase = i == 0 ? Phase::down : Phase::move;
            sample.t_host_s = 0.01 * i;
            sample.width_px = sample.height_px = 20.0 + step_px * (i / 100);
            watch(sample, seen);
        }
        return pressure_verdict(Modality::finger, true, {}, false, seen);
    };
    CHECK(verdict(0.0, 6.0) == PressureVerdict::same_area);
    CHECK(verdict(0.0, 2.0) == PressureVerdict::not_needed);  // a steady press
    CHECK(verdict(1.0, 6.0) == PressureVerdict::not_needed);
}

TEST_CASE("study device: a pen's trial needs a pen, a finger's a touch screen, the others nothing that is listed") {
    const PointerDevice pen{1, "Pen", Tool::pen};
    const PointerDevice touch{2, "Touch", Tool::finger};
    const PointerDevice mouse{3, "Mouse", Tool::mouse};
    CHECK(device_here(Modality::pen, {mouse, pen}));
    CHECK_FALSE(device_here(Modality::pen, {mouse, touch}));
    CHECK(device_here(Modality::finger, {touch}));
    CHECK_FALSE(device_here(Modality::finger, {mouse, pen}));
    for (const Modality other : {Modality::mouse, Modality::hand, Modality::shape_display})
        CHECK(device_here(other, {}));
}
