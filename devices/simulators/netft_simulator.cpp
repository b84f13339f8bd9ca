// Simulates an ATI Net F/T on loopback UDP: it answers requests for a stream, for one receiver at a time. Prints "port N"
// first, and at its end what it sent.

#include <optional>
#include <unistd.h>

#include "devices/netft.h"
#include "devices/simulators/sockets.h"
#include "devices/simulators/stream.h"

using namespace palpa;
using namespace palpa::devices;
using namespace palpa::devices::simulators;

namespace {

// The newest request decides which address gets the stream.
void take_requests(int fd, std::optional<sockaddr_in>& owner) {
    std::uint8_t bytes[64];
    sockaddr_in from{};
    socklen_t size = sizeof from;
    while (true) {
        const ssize_t n = ::recvfrom(fd, bytes, sizeof bytes, 0, reinterpret_cast<sockaddr*>(&from), &size);
        if (n < 0) return;
        RdtCommand command{};
        std::uint32_t records = 0;
        if (!decode_rdt_request(bytes, static_cast<std::size_t>(n), command, records)) continue;
        if (command == RdtCommand::stream) owner = from;
        if (command == RdtCommand::stop) owner.reset();
    }
}

}  // namespace

int main(int argc, char** argv) {
    StreamOptions options;
    options.rate_Hz = 7000.0;
    int port = 0;
    std::uint32_t first = 1;
    double counts_per_N = 1e6;
    std::uint32_t status = 0;
    CLI::App app("A simulated ATI Net F/T on loopback UDP");
    add_stream_options(app, options);
    app.add_option("--port", port, "0: any that is free")->check(CLI::Range(0, 65535));
    app.add_option("--first-sequence", first, "to see it wrap around");
    app.add_option("--counts-per-N", counts_per_N)->capture_default_str();
    app.add_option("--status", status, "of every record; 0 is fine");
    CLI11_PARSE(app, argc, argv);
    const int fd = open_socket(port);
    if (fd < 0) {
        std::perror("netft_simulator");
        return 1;
    }
    listen_to_signals();  // before the line of its port: who has read that may end it
    std::printf("port %d\n", port);
    std::fflush(stdout);

    Line<RdtRecord> line(options);
    std::optional<sockaddr_in> owner;
    const auto send = [&](const RdtRecord& record) {
        const auto bytes = encode_rdt_record(record);
        ::sendto(fd, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&*owner), sizeof *owner);
    };
    const double began_s = steady_s();
    double stream_s = began_s;  // when the next record is due
    RdtRecord record;
    record.rdt_sequence = first - 1;
    record.ft_sequence = first - 1;
    record.status = status;
    while (ended == 0 && (options.seconds <= 0.0 || steady_s() - began_s < options.seconds)) {
        std::this_thread::sleep_for(std::chrono::microseconds(500));
        take_requests(fd, owner);
        const double now_s = steady_s();
        if (!owner || silent(options, now_s - began_s)) {
            stream_s = now_s;
            continue;
        }
        for (; stream_s <= now_s; stream_s += 1.0 / options.rate_Hz) {
            ++record.rdt_sequence;
            ++record.ft_sequence;
            const double force_N = hand_N(options, stream_s - options.lag_s) + line.noise_N();
            record.counts[2] = static_cast<std::int32_t>(std::lround(-counts_per_N * force_N));  // down is -z
            line.pass(record, send);
        }
    }
    print_sent(line.sent);
    ::close(fd);
    return 0;
}
