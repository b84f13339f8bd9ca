// Device files of pins and of arms.

#include "devices/arm.h"
#include "devices/pins.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::devices;

PALPA_FUZZ_ENTRY(devices)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("device.json");
    const auto& path = file.with(fuzz::text_of(data, size));
    fuzz::read_or_refuse([&] { read_arm_device(path); });
    return fuzz::read_or_refuse([&] {
        const PinDevice device = read_pin_device(path);
        PinFrame frame;
        const std::vector<double> heights_m(device.pins.size(), 1.0);
        pin_frame(device, heights_m, frame);
        if (frame.size > frame.bytes.size()) fuzz::finding("a frame that is too long");
    });
}
