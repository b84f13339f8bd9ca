#include "devices/sequence.h"

namespace palpa::devices {

Arrival track(std::uint32_t number, bool after_silence, Sequence& sequence, SensorHealth& health) {
    const auto ahead = static_cast<std::int32_t>(number - sequence.last);  // across the wrap-around
    constexpr std::int32_t kFar = 1 << 20;
    const bool anew = ahead > kFar || ahead < -kFar || (after_silence && ahead <= 0);
    if (!sequence.started || anew) {
        const bool restarted = sequence.started;
        sequence.total += restarted ? 1 : 0;
        sequence.started = true;
        sequence.last = number;
        sequence.seen = 1;
        sequence.since_start = 0;
        return restarted ? Arrival::restart : Arrival::next;
    }
    if (ahead > 0) {
        health.lost += ahead - 1;
        sequence.seen = ahead < 64 ? (sequence.seen << ahead) | 1u : 1u;
        sequence.last = number;
        sequence.total += ahead;
        sequence.since_start += ahead;
        return Arrival::next;
    }
    const std::int32_t back = -ahead;
    if (back < 64 && ((sequence.seen >> back) & 1u) == 0) {
        sequence.seen |= std::uint64_t{1} << back;
        if (back <= sequence.since_start) --health.lost;
        ++health.reordered;
        return Arrival::late;
    }
    // too old to know whether it came before; a duplicate is likelier than a record so late
    ++health.duplicate;
    return Arrival::duplicate;
}

}  // namespace palpa::devices
