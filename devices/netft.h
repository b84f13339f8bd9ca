#pragma once
// ATI Net F/T: Raw Data Transfer (RDT) over UDP, big-endian.
//
//   request  u16 0x1234, u16 command, u32 records (0 = endless)
//   record   u32 RDT sequence, u32 F/T sequence, u32 status, i32 Fx Fy Fz Tx Ty Tz in counts
//
// Supported: the endless real-time stream, its start and stop, sequence numbers with wrap-around, loss, repetition and
// reordering, status words (invalid forces are dropped), a stream that falls silent (it is requested again). Not supported yet: buffered and multi-unit
// modes, the bias command (the calibration takes the zero itself), reading the scale from the sensor's web page. Tried
// with devices/simulators only, not with a sensor.

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
    std::uint32_t ft_sequence = 0;         // number of the sensor's internal sample
    std::uint32_t status = 0;              // 0 if the sensor is fine
    std::array<std::int32_t, 6> counts{};  // Fx Fy Fz Tx Ty Tz
};

std::array<std::uint8_t, kRdtRequest_bytes> encode_rdt_request(RdtCommand command, std::uint32_t count);
std::array<std::uint8_t, kRdtRecord_bytes> encode_rdt_record(const RdtRecord& record);
// Returns false if the record is not 36 bytes long.
bool decode_rdt_record(const std::uint8_t* bytes, std::size_t count, RdtRecord& out);
bool decode_rdt_request(const std::uint8_t* bytes, std::size_t count, RdtCommand& command, std::uint32_t& records);

// True for the status of a record whose forces mean nothing: an error (bit 31: overload, a broken gauge, ...) that is not
// only a monitor condition (bit 16), which the sensor's owner sets up as a limit for other machines.
bool is_invalid(std::uint32_t status);

struct NetFtOptions {
    std::string host = "192.168.1.1";  // factory setting
    int port = kRdtPort;
    double counts_per_N = 1e6;  // "counts per force" of the sensor's web page, in newtons
    int axis = 2;               // 0, 1, 2 for x, y, z
    double sign = -1.0;         // sign of the axis that makes pressing positive: down is -z
    double rate_Hz = 7000.0;    // rate of the internal samples, from which the sensor's clock follows
};
std::unique_ptr<ForceSensor> open_netft(const NetFtOptions& options);

}  // namespace palpa::devices
