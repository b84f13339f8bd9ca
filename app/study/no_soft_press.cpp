// A build without PALPA_TANGIBLE simulates no soft device.

#include "app/study/soft_press.h"
#include "files/input_error.h"

namespace palpa::app {

std::vector<study::FeltMoment> press_soft_device(const scene::Scene& scene, const scene::Plan&,
                                                 std::span<const devices::PressRow>, std::uint64_t) {
    throw files::bad_input(scene.file.string(), "tangible", "a soft device",
                           "none: this program was built without PALPA_TANGIBLE");
}

}  // namespace palpa::app
