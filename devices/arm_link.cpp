#include "devices/arm_link.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <zlib.h>

#include "devices/sensor_reader.h"
#include "platform/udp_port.h"

namespace palpa::devices {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are sent as they lie in memory");

constexpr std::uint32_t kArmCommandMagic = 0x31434150;   // "PAC1"
constexpr std::uint32_t kArmFeedbackMagic = 0x31464150;  // "PAF1"
constexpr std::size_t kArmCrc_bytes = 4;

// Writes numbers one after the other, and the CRC at the end.
template <std::size_t N>
struct PacketWriter {
    std::array<std::uint8_t, N> bytes{};
    std::size_t at = 0;
    template <class Number>
    void put(Number value) {
        std::memcpy(bytes.data() + at, &value, sizeof value);
        at += sizeof value;
    }
};

struct PacketReader {
    std::span<const std::uint8_t> bytes;
    std::size_t at = 0;
    template <class Number>
    void get(Number& value) {
        std::memcpy(&value, bytes.data() + at, sizeof value);
        at += sizeof value;
    }
};

std::uint32_t crc_of(std::span<const std::uint8_t> bytes) {
    return static_cast<std::uint32_t>(::crc32(0, bytes.data(), static_cast<unsigned>(bytes.size())));
}

bool is_whole(std::span<const std::uint8_t> bytes, std::size_t size, std::uint32_t magic) {
    if (bytes.size() != size) return false;
    PacketReader reader{bytes};
    std::uint32_t found = 0, crc = 0;
    std::uint16_t version = 0;
    reader.get(found);
    reader.get(version);
    reader.at = size - kArmCrc_bytes;
    reader.get(crc);
    return found == magic && version == kArmVersion && crc == crc_of(bytes.first(size - kArmCrc_bytes));
}

}  // namespace

ArmCommandPacket packet_of(const ArmCommand& command, std::uint32_t sequence, double now_s) noexcept {
    ArmCommandPacket packet;
    packet.sequence = sequence;
    packet.host_time_s = now_s;
    const double motor_N = command.force_N + command.feedforward_N;
    if (!std::isfinite(motor_N) || !std::isfinite(command.depth_m)) return packet;
    for (const ArmMode mode : {ArmMode::force, ArmMode::position}) {
        if (command.mode != static_cast<double>(mode)) continue;
        packet.mode = static_cast<std::uint16_t>(mode);
        packet.force_N = motor_N;
        packet.depth_m = command.depth_m;
    }
    return packet;
}

std::array<std::uint8_t, kArmCommand_bytes> encode(const ArmCommandPacket& packet) {
    PacketWriter<kArmCommand_bytes> out;
    out.put(kArmCommandMagic);
    out.put(kArmVersion);
    out.put(packet.mode);
    out.put(packet.sequence);
    out.put(std::uint32_t{0});
    for (const double value : {packet.host_time_s, packet.force_N, packet.depth_m}) out.put(value);
    out.put(std::uint32_t{0});
    out.put(crc_of(std::span(out.bytes).first(out.at)));
    return out.bytes;
}

std::array<std::uint8_t, kArmFeedback_bytes> encode(const ArmFeedbackPacket& packet) {
    PacketWriter<kArmFeedback_bytes> out;
    out.put(kArmFeedbackMagic);
    out.put(kArmVersion);
    out.put(packet.state);
    out.put(packet.sequence);
    out.put(packet.answers);
    for (const double value : {packet.host_time_s, packet.held_s, packet.device_time_s, packet.x_m, packet.y_m,
                               packet.depth_m, packet.velocity_m_per_s, packet.motor_N})
        out.put(value);
    out.put(std::uint32_t{0});
    out.put(crc_of(std::span(out.bytes).first(out.at)));
    return out.bytes;
}

bool decode(std::span<const std::uint8_t> bytes, ArmCommandPacket& out) noexcept {
    if (!is_whole(bytes, kArmCommand_bytes, kArmCommandMagic)) return false;
    PacketReader reader{bytes, 6};
    ArmCommandPacket found;
    reader.get(found.mode);
    reader.get(found.sequence);
    reader.at += 4;
    bool finite = true;
    for (double* value : {&found.host_time_s, &found.force_N, &found.depth_m}) {
        reader.get(*value);
        finite = finite && std::isfinite(*value);
    }
    if (!finite || found.mode > static_cast<std::uint16_t>(ArmMode::position)) return false;
    out = found;
    return true;
}

bool decode(std::span<const std::uint8_t> bytes, ArmFeedbackPacket& out) noexcept {
    if (!is_whole(bytes, kArmFeedback_bytes, kArmFeedbackMagic)) return false;
    PacketReader reader{bytes, 6};
    ArmFeedbackPacket found;
    reader.get(found.state);
    reader.get(found.sequence);
    reader.get(found.answers);
    bool finite = true;
    for (double* value : {&found.host_time_s, &found.held_s, &found.device_time_s, &found.x_m, &found.y_m,
                          &found.depth_m, &found.velocity_m_per_s, &found.motor_N}) {
        reader.get(*value);
        finite = finite && std::isfinite(*value);
    }
    constexpr std::uint16_t kLastState = 2;
    if (!finite || found.state > kLastState) return false;
    out = found;
    return true;
}

void TimeHistogram::add(double seconds) noexcept {
    if (!(seconds >= 0.0)) return;
    const double bucket = std::min(seconds / kBucket_s, static_cast<double>(count.size() - 1));
    ++count[static_cast<std::size_t>(bucket)];
    ++total;
    worst_s = std::max(worst_s, seconds);
}

double TimeHistogram::quantile_s(double share) const noexcept {
    if (total == 0) return std::numeric_limits<double>::quiet_NaN();
    const double wanted = share * static_cast<double>(total);
    std::int64_t below = 0;
    for (std::size_t i = 0; i + 1 < count.size(); ++i) {
        below += count[i];
        if (static_cast<double>(below) >= wanted) return kBucket_s * static_cast<double>(i + 1);
    }
    return worst_s;
}

ArmLink::ArmLink(const std::string& host, int port) : port_(std::make_unique<platform::UdpPort>(host, port)) {}
ArmLink::~ArmLink() = default;

bool ArmLink::take(std::span<const std::uint8_t> bytes, double arrival_s, ArmFeedback& out) noexcept {
    ArmFeedbackPacket packet;
    if (!decode(bytes, packet)) {
        ++health_.feedback.malformed;
        return false;
    }
    const bool after_silence = arrival_s - last_s_ > 1.0;
    last_s_ = arrival_s;
    const Arrival arrival = track(packet.sequence, sequence_, health_.feedback, after_silence);
    if (arrival == Arrival::duplicate || arrival == Arrival::late) return false;
    ++health_.feedback.received;
    driven_ = driven_ || packet.state == 0;
    health_.arm_rested += driven_ && packet.state == 1;  // before the first command it rests as it should
    out.faulty = packet.state == 2 ? 1.0 : 0.0;
    out.time_s = arrival_s;
    out.device_time_s = packet.device_time_s;
    out.x_m = packet.x_m;
    out.y_m = packet.y_m;
    out.depth_m = packet.depth_m;
    out.velocity_m_per_s = packet.velocity_m_per_s;
    out.round_trip_s = std::max(arrival_s - packet.host_time_s - packet.held_s, 0.0);
    health_.round_trip.add(out.round_trip_s);
    return true;
}

bool ArmLink::read(ArmFeedback& out) noexcept {
    std::array<std::uint8_t, 256> bytes;
    constexpr int kMost = 64;  // per call: a flood may not hold up the loop
    bool came = false;
    for (int i = 0; i < kMost; ++i) {
        double arrival_s = 0.0;
        const int n = port_->receive_at_once(bytes.data(), bytes.size(), arrival_s);
        if (n <= 0) break;
        came = take(std::span(bytes).first(static_cast<std::size_t>(n)), arrival_s, out) || came;
    }
    if (came) out.age_s = std::max(steady_s() - out.time_s, 0.0);
    return came;
}

int ArmLink::fd() const { return port_->fd(); }

void ArmLink::send(const ArmCommand& command) noexcept {
    const ArmCommandPacket packet = packet_of(command, ++sent_, steady_s());
    const auto bytes = encode(packet);
    ++(port_->send(bytes.data(), bytes.size()) ? health_.sent : health_.unsent);
}

namespace {

constexpr int kZeroReadings = 200;
constexpr double kSensorOld_s = 0.1;
constexpr std::size_t kMostReadings = 4096;  // taken per tick without allocation

}  // namespace

ArmPort::ArmPort(const ArmDevice& device) : link_(device.host, device.port) {
    if (device.sensor) sensor_ = std::make_unique<SensorReader>(open_netft(*device.sensor));
    readings_.reserve(kMostReadings);
}
ArmPort::~ArmPort() = default;

void ArmPort::take_sensor(double now_s, ArmFeedback& out) noexcept {
    readings_.clear();
    sensor_->poll(readings_, kMostReadings);
    for (const ForceReading& reading : readings_) {
        if (zero_readings_ < kZeroReadings) {
            ++zero_readings_;
            zero_N_ += (reading.force_N - zero_N_) / zero_readings_;
        }
        sensor_N_ = reading.force_N;
        sensor_time_s_ = reading.t_host_s;
    }
    const bool fresh = zero_readings_ == kZeroReadings && now_s - sensor_time_s_ < kSensorOld_s;
    out.has_sensor = fresh ? 1.0 : 0.0;
    out.sensor_N = fresh ? sensor_N_ - zero_N_ : 0.0;
}

bool ArmPort::read(ArmFeedback& out) noexcept {
    const bool came = link_.read(out);
    if (sensor_) take_sensor(steady_s(), out);
    return came;
}

std::unique_ptr<ArmPort> open_arm(const ArmDevice& device) { return std::make_unique<ArmPort>(device); }

}  // namespace palpa::devices
