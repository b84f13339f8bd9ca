#pragma once
// The link to a force arm: UDP at 1 kHz, one command out and one feedback back. All numbers are little-endian.
//
//   command   48 bytes  u32 "PAC1", u16 version, u16 mode, u32 sequence, u32 0, f64 host time s, f64 force N,
//                       f64 depth m, u32 0, u32 CRC-32
//   feedback  88 bytes  u32 "PAF1", u16 version, u16 state, u32 sequence, u32 sequence of the command it answers,
//                       f64 that command's host time s, f64 time s for which the arm held it, f64 device time s,
//                       f64 x, y, depth m, f64 velocity m/s, f64 motor's force N, u32 0,
//                       u32 CRC-32
//
// `force` is the motor's whole force against the press. CRC-32 is zlib's (IEEE 802.3) over everything before it. The arm
// answers every command at once. Without a command for 100 ms it must rest: force zero, by itself.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "devices/arm.h"
#include "devices/sequence.h"

namespace palpa::platform {
class UdpPort;
}

namespace palpa::devices {

class SensorReader;

inline constexpr std::uint16_t kArmVersion = 1;
inline constexpr std::size_t kArmCommand_bytes = 48;
inline constexpr std::size_t kArmFeedback_bytes = 88;

struct ArmCommandPacket {
    std::uint32_t sequence = 0;
    std::uint16_t mode = 0;  // ArmMode
    double host_time_s = 0.0;
    double force_N = 0.0;
    double depth_m = 0.0;
};

struct ArmFeedbackPacket {
    std::uint32_t sequence = 0;
    std::uint16_t state = 0;  // 0 drives, 1 rests since no command came, 2 has a fault of its own
    std::uint32_t answers = 0;
    double host_time_s = 0.0;  // of the command that it answers
    double held_s = 0.0;
    double device_time_s = 0.0;
    double x_m = 0.0, y_m = 0.0, depth_m = 0.0;
    double velocity_m_per_s = 0.0;
    double motor_N = 0.0;
};

// What a command becomes on the wire; one that is not finite becomes rest.
ArmCommandPacket packet_of(const ArmCommand& command, std::uint32_t sequence, double now_s) noexcept;

std::array<std::uint8_t, kArmCommand_bytes> encode(const ArmCommandPacket& packet);
std::array<std::uint8_t, kArmFeedback_bytes> encode(const ArmFeedbackPacket& packet);
// Return false for another length, magic, version or CRC, for a mode or state that is not known, and for a number that
// is not finite.
bool decode(std::span<const std::uint8_t> bytes, ArmCommandPacket& out) noexcept;
bool decode(std::span<const std::uint8_t> bytes, ArmFeedbackPacket& out) noexcept;

// Times in buckets of 5 us, the last one for all above. Allocates nothing.
struct TimeHistogram {
    static constexpr double kBucket_s = 5e-6;
    std::array<std::int64_t, 2001> count{};
    std::int64_t total = 0;
    double worst_s = 0.0;
    void add(double seconds) noexcept;
    double quantile_s(double share) const noexcept;  // upper edge of the bucket; NaN if empty
};

struct LinkHealth {
    std::int64_t sent = 0;
    std::int64_t unsent = 0;      // that the system did not take
    SensorHealth feedback;        // received, lost, duplicate, reordered, malformed
    std::int64_t arm_rested = 0;  // feedback that said so, after it had been driven
    TimeHistogram round_trip;
};

// The UDP part alone. Neither function waits, allocates or throws.
class ArmLink {
  public:
    // Throws std::runtime_error with the system's reason.
    ArmLink(const std::string& host, int port);
    ~ArmLink();
    ArmLink(const ArmLink&) = delete;
    ArmLink& operator=(const ArmLink&) = delete;

    // Takes all that has arrived; `out` becomes the newest feedback. Returns false, and leaves it, if nothing came.
    bool read(ArmFeedback& out) noexcept;
    void send(const ArmCommand& command) noexcept;
    const LinkHealth& health() const { return health_; }
    int fd() const;  // readable when feedback has arrived

  private:
    bool take(std::span<const std::uint8_t> bytes, double arrival_s, ArmFeedback& out) noexcept;

    std::unique_ptr<platform::UdpPort> port_;
    LinkHealth health_;
    Sequence sequence_;
    std::uint32_t sent_ = 0;
    bool driven_ = false;  // the arm has said so
    double last_s_ = 0.0;  // arrival of the newest feedback
};

// A link and, if the device has one, the force sensor between arm and display: a port of session/device_loop.h. The
// sensor's zero is the mean of its first 200 readings, during which has_sensor is 0: nothing may press yet.
class ArmPort {
  public:
    explicit ArmPort(const ArmDevice& device);
    ~ArmPort();
    ArmPort(const ArmPort&) = delete;
    ArmPort& operator=(const ArmPort&) = delete;

    bool read(ArmFeedback& out) noexcept;
    void send(const ArmCommand& command) noexcept { link_.send(command); }
    const LinkHealth& health() const { return link_.health(); }
    int fd() const { return link_.fd(); }

  private:
    void take_sensor(double now_s, ArmFeedback& out) noexcept;

    ArmLink link_;
    std::unique_ptr<SensorReader> sensor_;
    std::vector<ForceReading> readings_;
    double zero_N_ = 0.0;
    int zero_readings_ = 0;
    double sensor_N_ = 0.0;
    double sensor_time_s_ = 0.0;
};

// Throws std::runtime_error with the system's reason.
std::unique_ptr<ArmPort> open_arm(const ArmDevice& device);

}  // namespace palpa::devices
