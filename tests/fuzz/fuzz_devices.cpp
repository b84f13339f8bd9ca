// Device files of pins and of arms, and the wires of soft devices.

#include "devices/arm.h"
#include "devices/pins.h"
#include "devices/rig.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::devices;

namespace {

void take_rig(std::string_view text) {
    const files::Json json = files::parse_json(text, "rig.json");
    const ActuatorRig rig = read_rig(files::JsonReader(json, "rig.json"));
    for (const RigChannel& channel : rig.channels) {
        const RigPort& port = rig.ports[channel.port];
        const CountsRange range = counts_range(port, channel.drive);
        for (const double value : {-1e300, channel.relaxed, 1e300}) {
            const double counts = counts_of(port, channel, value);
            if (!(counts >= range.lowest && counts <= range.highest))
                fuzz::finding("counts that the wire does not have");
        }
        if (port.protocol == devices::Protocol::maestro) pins_of(rig, channel.port);
    }
    const files::Json written = rig_json(rig);
    read_rig(files::JsonReader(written, "rig.json"));
}

}  // namespace

PALPA_FUZZ_ENTRY(devices)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("device.json");
    const auto& path = file.with(fuzz::text_of(data, size));
    fuzz::read_or_refuse([&] { read_arm_device(path); });
    fuzz::read_or_refuse([&] { take_rig(fuzz::text_of(data, size)); });
    return fuzz::read_or_refuse([&] {
        const PinDevice device = read_pin_device(path);
        PinFrame frame;
        const std::vector<double> heights_m(device.pins.size(), 1.0);
        pin_frame(device, heights_m, frame);
        if (frame.size > frame.bytes.size()) fuzz::finding("a frame that is too long");
    });
}
