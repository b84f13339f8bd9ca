#include <doctest/doctest.h>

#include "app/study/study_device.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::study;
using namespace palpa::app;

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
