#pragma once

#include "platform/window.h"

namespace palpa::test {

// A window that nobody sees, of the size that tests of screens share.
inline platform::WindowOptions off_screen() {
    platform::WindowOptions options;
    options.visible = false;
    options.width_px = 640;
    options.height_px = 400;
    return options;
}

}  // namespace palpa::test
