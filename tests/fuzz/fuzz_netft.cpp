// Packets of a Net F/T, 36 bytes each and the last one cut, and the counting of what was lost.

#include <algorithm>

#include "devices/netft.h"
#include "devices/sequence.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::devices;

PALPA_FUZZ_ENTRY(netft)(const std::uint8_t* data, std::size_t size) {
    SensorHealth health;
    Sequence sequence;
    for (std::size_t at = 0; at < size; at += kRdtRecord_bytes) {
        const std::size_t n = std::min(size - at, kRdtRecord_bytes);
        RdtRecord record;
        if (!decode_rdt_record(data + at, n, record)) continue;
        track(record.rdt_sequence, at % (2 * kRdtRecord_bytes) != 0, sequence, health);
        const auto again = encode_rdt_record(record);
        if (!std::equal(again.begin(), again.end(), data + at)) fuzz::finding("other bytes when written again");
    }
    if (health.lost < 0 || health.duplicate < 0 || health.reordered < 0) fuzz::finding("a count below zero");
    RdtCommand command = RdtCommand::stop;
    std::uint32_t records = 0;
    decode_rdt_request(data, size, command, records);
    return 0;
}
