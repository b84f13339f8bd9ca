// Packets of a force arm. A CRC over them is set right in a copy, or nothing would get beyond it.

#include <cmath>
#include <cstring>
#include <zlib.h>

#include "devices/arm_link.h"
#include "devices/simulators/arm_plant.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::devices;

namespace {

void take_packet(std::span<const std::uint8_t> bytes, simulators::ArmPlant& plant) {
    ArmFeedbackPacket feedback;
    if (decode(bytes, feedback)) {
        const bool finite = std::isfinite(feedback.depth_m) && std::isfinite(feedback.velocity_m_per_s) &&
                            std::isfinite(feedback.x_m) && std::isfinite(feedback.motor_N);
        if (!finite) fuzz::finding("feedback that is no number");
        if (feedback.state > 2) fuzz::finding("a state that does not exist");
    }
    ArmCommandPacket command;
    if (decode(bytes, command)) {
        if (!std::isfinite(command.force_N) || !std::isfinite(command.depth_m))
            fuzz::finding("a force that is no number");
        if (command.mode > 2) fuzz::finding("a mode that does not exist");
    }
    simulators::answer(bytes, plant);
}

}  // namespace

PALPA_FUZZ_ENTRY(arm_link)(const std::uint8_t* data, std::size_t size) {
    simulators::ArmPlant plant;
    take_packet({data, size}, plant);
    std::vector<std::uint8_t> bytes(data, data + size);
    for (const std::size_t length : {kArmCommand_bytes, kArmFeedback_bytes}) {
        bytes.resize(length);
        std::memcpy(bytes.data(), length == kArmCommand_bytes ? "PAC1\x01" : "PAF1\x01", 6);
        const auto crc = static_cast<std::uint32_t>(::crc32(0, bytes.data(), static_cast<unsigned>(length - 4)));
        std::memcpy(bytes.data() + length - 4, &crc, sizeof crc);
        take_packet(bytes, plant);
    }
    return 0;
}
