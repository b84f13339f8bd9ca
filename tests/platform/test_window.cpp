#include <doctest/doctest.h>

#include "platform/window.h"

using namespace palpa::platform;

TEST_CASE("window: a size that the screen has no room for is turned or cut, so that no control is out of reach") {
    constexpr SizePx kFirst{1280, 800};
    CHECK(fitted(kFirst, {1920, 1080}) == kFirst);
    CHECK(fitted(kFirst, {1280, 800}) == kFirst);
    CHECK(fitted(kFirst, {800, 1280}) == SizePx{800, 1280});
    CHECK(fitted(kFirst, {1080, 1920}) == SizePx{800, 1280});
    CHECK(fitted(kFirst, {1024, 768}) == SizePx{1024, 768});
    CHECK(fitted(kFirst, {720, 1280}) == SizePx{720, 800});
    CHECK(fitted({4000, 3000}, {1280, 700}) == SizePx{1280, 700});
    CHECK(fitted(kFirst, {0, 0}) == kFirst);
}
