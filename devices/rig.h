#pragma once
// The wires of a soft device: its actuators' serial lines, what stands on them, the sensor of the displacement, and the limits
// that the guard enforces (docs/tangible.md). It is the key "wires" of a device file.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "devices/counts_stream.h"
#include "devices/pins.h"
#include "files/json.h"

namespace palpa::devices {

inline constexpr std::size_t kMostChannels = 8;
inline constexpr std::size_t kMostPorts = 4;

enum class Protocol : std::uint8_t {
    framed,     // our frames (framed.h)
    sketch,     // SoftRobots' frames, without answers or watchdog
    dynamixel,  // protocol 2.0
    alicat,     // pressure controllers
    maestro,    // RC servos on Pololu's boards
};
std::string_view name_of(Protocol protocol);

// What a command of an actuator means.
enum class Drive : std::uint8_t { force, length, pressure };  // N; m of cable; Pa

struct RigPort {
    std::string name;
    Protocol protocol = Protocol::framed;
    std::string path;
    int baud = 115200;
    // maestro
    int board = 12;
    bool chained = false;  // Pololu protocol with the board's number, else compact
    bool crc = true;
    double timeout_s = 0.1;  // set in the board
    double lowest_us = 992.0;
    double highest_us = 2000.0;
    // alicat: where in the data frame, counted from 0 behind the letter
    bool spaced = false;
    int pressure_field = 0;
    int set_point_field = 1;
};

// Counts on the wire = zero_counts + counts_per_unit * value. Counts are those of the protocol: framed and sketch their own;
// dynamixel position or current of the control table; alicat the unit's engineering units; maestro microseconds.
struct RigChannel {
    std::string name;  // of the actuator
    std::size_t port = 0;
    int id = 1;  // framed, sketch, maestro: channel from 0; dynamixel: id; alicat: 0 for A to 25 for Z
    Drive drive = Drive::force;
    double zero_counts = 0.0;
    double counts_per_unit = 1.0;       // per N, m or Pa; not 0
    double lower = 0.0, upper = 0.0;    // range, in N, m or Pa
    double relaxed = 0.0;               // where no force acts; within the range
    double rate_per_s = 0.0;            // greatest change, > 0; the fall to relaxed is not held back
    double force_N_per_unit = 0.0;      // what it adds to the total force; 0: not counted (drive length)
    double current_limit_counts = 0.0;  // dynamixel by length: the greatest current, > 0
};

struct RigSensor {
    CountsPlace place;
    double zero_counts = 0.0;
    double m_per_count = 1e-6;  // displacement, positive into the device; may be negative
    double silence_s = 0.1;     // longer than that without a reading is a fault
};

struct ActuatorRig {
    std::string name;
    std::vector<RigPort> ports;        // at least one
    std::vector<RigChannel> channels;  // as many as the device has actuators, at least one
    std::vector<RigSensor> sensor;     // none or one
    double total_force_N = 0.0;        // > 0
};

// Reads {"ports", "actuators", "sensor", "total_force_N"}. Throws InputError with file and key: among others two channels of
// one number on a line, a drive that the protocol does not have, a range that leaves the wire's counts.
ActuatorRig read_rig(files::JsonReader reader);
files::Json rig_json(const ActuatorRig& rig);

// "NAME=PATH" of the command line, for a port or for "sensor"; the sensor may be "sensor=udp:HOST:PORT" too. Throws InputError
// that lists the names.
void set_port(std::string_view name_and_path, ActuatorRig& rig);

// The counts that a protocol has.
struct CountsRange {
    double lowest = 0.0;
    double highest = 0.0;
};
CountsRange counts_range(const RigPort& port, Drive drive) noexcept;

// Counts on the wire, limited to those that the protocol has and to the channel's range; a value that is not finite becomes
// the relaxed one.
double counts_of(const RigPort& port, const RigChannel& channel, double value) noexcept;
double value_of(const RigChannel& channel, double counts) noexcept;

// The servos of a Maestro port as the driver of pins takes them: "heights" from 0, which is the channel's lower end, m. The
// protocol carries no force: its channels are driven by length.
PinDevice pins_of(const ActuatorRig& rig, std::size_t port);

}  // namespace palpa::devices
