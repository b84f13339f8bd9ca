#pragma once
// ATI Net F/T: Raw Data Transfer (RDT) over UDP, big-endian.
//
//   request  u16 0x1234, u16 command, u32 records (0 = endless)
//   record   u32 RDT sequence, u32 F/T sequence, u32 status, i32 Fx Fy Fz Tx Ty Tz in counts
//
// Supported: the endless real-time stream, its start and stop, sequence numbers with wrap-around, loss, repetition and
// reordering, status words, a stream that falls silent (asked for again). Not yet: buffered and multi-unit modes, the
// bias command (zero is taken by us), reading the scale from the sensor's web page. Tried against
// devices/simulators only, not against a sensor.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "devices/force_sensor.h"

namespace palpa::devices {

inline constexpr int kRdtPort = 49152;
inline constexpr std::size_t kRdtRequest_bytes = 8;
inline constexpr std::size_t kRdtRecord_bytes = 36;

enum class RdtCommand : std::uint16_t { stop = 0, stream = 2, reset_latch = 0x41, bias = 0x42 };

struct RdtRecord {
    std::uint32_t rdt_sequence = 0;
    std::uint32_t ft_sequence = 0;         // of the sensor's internal samples
    std::uint32_t status = 0;              // 0: fine
    std::array<std::int32_t, 6> counts{};  // Fx Fy Fz Tx Ty Tz
};

std::array<std::uint8_t, kRdtRequest_bytes> encode_rdt_request(RdtCommand command, std::uint32_t count);
std::array<std::uint8_t, kRdtRecord_bytes> encode_rdt_record(const RdtRecord& record);
// False if it is not 36 bytes long.
bool decode_rdt_record(const std::uint8_t* bytes, std::size_t count, RdtRecord& out);
bool decode_rdt_request(const std::uint8_t* bytes, std::size_t count, RdtCommand& command, std::uint32_t& records);

struct NetFtOptions {
    std::string host = "192.168.1.1";  // as delivered
    int port = kRdtPort;
    double counts_per_N = 1e6;  // "counts per force" of the sensor's web page, in newtons
    int axis = 2;               // 0 ... 2: x, y, z
    double sign = -1.0;         // of the axis, so that pressing is positive: down is -z
    double rate_Hz = 7000.0;    // of the internal samples, for the sensor's clock
};
std::unique_ptr<ForceSensor> open_netft(const NetFtOptions& options);

}  // namespace palpa::devices
