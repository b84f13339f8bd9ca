#include <doctest/doctest.h>

#include "app/study/study_device.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::study;
using namespace palpa::app;

TEST_CASE("study device: a pen's trial needs a pressure that varies, or might") {
    const PointerDevice pen{1, "Pen", Tool::pen, true};
    const PointerDevice blunt{1, "Pen", Tool::pen, false};
    const auto verdict = [](const PointerDevice& device, const PressureWatch& pressure) {
        return pen_verdict(Modality::pen, true, {device}, true, pressure);
    };
    const auto pressed = [](double step) {
        PressureWatch out;
        Sample sample;
        sample.tool = Tool::pen;
        for (int i = 0; i < 100; ++i) {
            sample.phase = i == 0 ? Phase::down : Phase::move;
            sample.t_host_s = 0.01 * i;
            sample.pressure = 0.5 + step * i;
            watch(sample, out);
        }
        return out;
    };
    CHECK(verdict(pen, {}) == PenVerdict::untried);
    CHECK(verdict(blunt, {}) == PenVerdict::no_pressure);
    CHECK(verdict(pen, pressed(0.0)) == PenVerdict::no_pressure);
    CHECK(verdict(pen, pressed(0.001)) == PenVerdict::ready);
    CHECK(pen_verdict(Modality::pen, false, {blunt}, true, {}) == PenVerdict::not_needed);
    CHECK(pen_verdict(Modality::finger, true, {blunt}, true, {}) == PenVerdict::not_needed);
    CHECK(pen_verdict(Modality::pen, true, {}, false, {}) == PenVerdict::untried);
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
