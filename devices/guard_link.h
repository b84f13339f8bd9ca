#pragma once
// What a program and its guard's process say to each other, over a pair of local sockets that keep messages whole. When the
// program ends, however it ends, the system closes its end, and the guard knows at once.
//
//   to the guard     first the wires or devices as JSON (GuardStart); then commands, stop, release
//   from the guard   a report after every command and every reading of the sensor, and every 10 ms

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

#include "devices/actuator_line.h"
#include "devices/rig_guard.h"

namespace palpa::devices {

enum class GuardWord : std::uint32_t { command = 0x50474331, stop, release };

struct GuardMessage {
    static constexpr std::size_t kMostValues = 160;
    GuardWord word = GuardWord::command;
    std::uint32_t values = 0;
    double value[kMostValues]{};
};
inline constexpr std::size_t kGuardHead_bytes = 8;
// A guard that reports nothing for so long, not even that it is there, is a fault: guard_silent.
inline constexpr double kGuardSilence_s = 0.25;

// Bytes of a message that count. `received`: bytes that came. A message of another length or an unknown word is none.
std::size_t size_of(const GuardMessage& message) noexcept;
bool is_whole(const GuardMessage& message, std::size_t received) noexcept;

// What the guard of a soft device tells of itself.
struct RigReport {
    Fault fault = Fault::none;
    bool driven = false;   // commands pass to the wires; else all is relaxed
    bool ready = false;    // every line has been proved
    bool relaxed = false;  // every line has confirmed that it is at rest
    std::int64_t commands = 0;
    std::int64_t limited = 0, slewed = 0, scaled = 0;  // as in RigGuard
    std::array<double, kMostChannels> sent{};          // values after the guard
    std::array<double, kMostChannels> measured{};      // NaN: nothing measures it
    double displacement_m = 0.0;                       // NaN before the first reading
    double displacement_time_s = 0.0;                  // of its arrival, host's steady clock
    double displacement_device_s = 0.0;                // by the sensor's clock
    std::int64_t displacement_count = 0;               // readings so far
    SensorHealth sensor;
    std::array<LineHealth, kMostPorts> line{};
};
static_assert(std::is_trivially_copyable_v<RigReport>);

// A message of the guard that cannot start.
inline constexpr char kGuardRefusal = '!';

}  // namespace palpa::devices
