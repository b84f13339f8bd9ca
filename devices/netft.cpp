#include "devices/netft.h"

#include "devices/sequence.h"
#include "platform/udp_port.h"

namespace palpa::devices {
namespace {

void put(std::uint32_t value, int bytes, std::uint8_t* out) {
    for (int i = 0; i < bytes; ++i) out[i] = static_cast<std::uint8_t>(value >> (8 * (bytes - 1 - i)));
}

std::uint32_t get(const std::uint8_t* in, int bytes) {
    std::uint32_t value = 0;
    for (int i = 0; i < bytes; ++i) value = (value << 8) | in[i];
    return value;
}

class NetFt : public ForceSensor {
  public:
    explicit NetFt(const NetFtOptions& options) : options_(options), port_(options.host, options.port) {
        ask(RdtCommand::stream);
    }
    ~NetFt() override { ask(RdtCommand::stop); }

    void read(double wait_s, std::vector<ForceReading>& out) override {
        std::array<std::uint8_t, 2048> bytes;
        constexpr int kMost = 512;  // records per call, so that the reader can hand them on
        double wait = wait_s;
        for (int i = 0; i < kMost; ++i) {
            const int n = port_.receive(wait, bytes.data(), bytes.size());
            if (n <= 0) break;
            take(bytes.data(), static_cast<std::size_t>(n), out);
            wait = 0.0;
        }
        watch();
    }

    const SensorHealth& health() const override { return health_; }
    std::string name() const override { return "Net F/T at " + options_.host + ":" + std::to_string(options_.port); }

  private:
    void ask(RdtCommand command) {
        const auto request = encode_rdt_request(command, 0);
        port_.send(request.data(), request.size());
        asked_s_ = steady_s();
    }

    void take(const std::uint8_t* bytes, std::size_t count, std::vector<ForceReading>& out) {
        RdtRecord record;
        if (!decode_rdt_record(bytes, count, record)) {
            ++health_.malformed;
            return;
        }
        last_s_ = steady_s();
        const bool after_silence = !health_.alive;
        health_.alive = true;
        const Arrival arrival = track(record.rdt_sequence, after_silence, sequence_, health_);
        if (arrival == Arrival::duplicate || arrival == Arrival::late) return;
        health_.faults += record.status != 0;
        SensorHealth ignored;
        track(record.ft_sequence, after_silence, samples_, ignored);
        ForceReading reading;
        reading.t_host_s = last_s_;
        reading.t_device_s = static_cast<double>(samples_.total) / options_.rate_Hz;
        reading.raw = options_.sign * record.counts[static_cast<std::size_t>(options_.axis)];
        reading.force_N = reading.raw / options_.counts_per_N;
        out.push_back(reading);
        ++health_.received;
    }

    // The sensor sends to whoever asked last and never ends by itself: after a silence the stream is requested again, once
    // a second.
    void watch() {
        constexpr double kSilence_s = 0.5;
        constexpr double kAgain_s = 1.0;
        const double now_s = steady_s();
        if (health_.alive && now_s - last_s_ > kSilence_s) {
            health_.alive = false;
            ++health_.stalls;
        }
        if (health_.alive || now_s - asked_s_ < kAgain_s) return;
        if (last_s_ > 0.0) ++health_.reconnects;
        ask(RdtCommand::stream);
    }

    NetFtOptions options_;
    platform::UdpPort port_;
    SensorHealth health_;
    Sequence sequence_;
    Sequence samples_;
    double last_s_ = 0.0;
    double asked_s_ = 0.0;
};

}  // namespace

std::array<std::uint8_t, kRdtRequest_bytes> encode_rdt_request(RdtCommand command, std::uint32_t count) {
    std::array<std::uint8_t, kRdtRequest_bytes> out{};
    put(0x1234, 2, out.data());
    put(static_cast<std::uint32_t>(command), 2, out.data() + 2);
    put(count, 4, out.data() + 4);
    return out;
}

bool decode_rdt_request(const std::uint8_t* bytes, std::size_t count, RdtCommand& command, std::uint32_t& records) {
    if (count != kRdtRequest_bytes || get(bytes, 2) != 0x1234) return false;
    command = static_cast<RdtCommand>(get(bytes + 2, 2));
    records = get(bytes + 4, 4);
    return true;
}

std::array<std::uint8_t, kRdtRecord_bytes> encode_rdt_record(const RdtRecord& record) {
    std::array<std::uint8_t, kRdtRecord_bytes> out{};
    put(record.rdt_sequence, 4, out.data());
    put(record.ft_sequence, 4, out.data() + 4);
    put(record.status, 4, out.data() + 8);
    for (std::size_t i = 0; i < 6; ++i) put(static_cast<std::uint32_t>(record.counts[i]), 4, out.data() + 12 + 4 * i);
    return out;
}

bool decode_rdt_record(const std::uint8_t* bytes, std::size_t count, RdtRecord& out) {
    if (count != kRdtRecord_bytes) return false;
    out.rdt_sequence = get(bytes, 4);
    out.ft_sequence = get(bytes + 4, 4);
    out.status = get(bytes + 8, 4);
    for (std::size_t i = 0; i < 6; ++i) out.counts[i] = static_cast<std::int32_t>(get(bytes + 12 + 4 * i, 4));
    return true;
}

std::unique_ptr<ForceSensor> open_netft(const NetFtOptions& options) { return std::make_unique<NetFt>(options); }

}  // namespace palpa::devices
