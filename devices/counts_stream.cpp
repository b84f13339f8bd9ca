#include "devices/counts_stream.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <thread>

#include "platform/serial_port.h"
#include "platform/udp_port.h"

namespace palpa::devices {

CountsStream::CountsStream(const CountsPlace& place) : place_(place) {
    if (place_.host.empty()) {
        serial_ = std::make_unique<platform::SerialPort>(place_.path, place_.baud);
    } else {
        udp_ = std::make_unique<platform::UdpPort>(place_.host, place_.port);
        ask();
    }
}
CountsStream::~CountsStream() = default;

void CountsStream::ask() {
    constexpr double kAgain_s = 0.5;
    if (steady_s() - asked_s_ < kAgain_s) return;
    asked_s_ = steady_s();
    constexpr std::array<std::uint8_t, 6> kStart{'s', 't', 'a', 'r', 't', '\n'};
    udp_->send(kStart.data(), kStart.size());
}

int CountsStream::read_bytes(double wait_s, std::uint8_t* bytes, std::size_t room) {
    if (udp_) {
        ask();
        parser_.line.clear();  // a datagram begins with a line
        parser_.skipping = false;
        return udp_->receive(wait_s, bytes, room);
    }
    const int n = serial_ ? serial_->read(wait_s, bytes, room) : reopen(wait_s);
    if (n < 0) {
        serial_.reset();
        parser_ = {};
        tried_s_ = steady_s();
    }
    return n;
}

void CountsStream::read(double wait_s, std::vector<CountsReading>& out) {
    std::array<std::uint8_t, 4096> bytes;
    const int n = read_bytes(wait_s, bytes.data(), bytes.size());
    for (int i = 0; i < n; ++i) {
        LoadCellLine line;
        if (feed(bytes[static_cast<std::size_t>(i)], parser_, health_, line)) take(line, out);
    }
    constexpr double kSilence_s = 0.5;
    if (health_.alive && steady_s() - last_s_ > kSilence_s) {
        health_.alive = false;
        ++health_.stalls;
    }
}

// After the port was unplugged, tries to open it twice a second.
int CountsStream::reopen(double wait_s) {
    constexpr double kAgain_s = 0.5;
    const double due_s = tried_s_ + kAgain_s - steady_s();
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(wait_s, std::max(due_s, 0.0))));
    if (due_s > wait_s) return 0;
    tried_s_ = steady_s();
    try {
        serial_ = std::make_unique<platform::SerialPort>(place_.path, place_.baud);
        clock_ = {};
        ++health_.reconnects;
    } catch (const std::exception&) {
        // still gone
    }
    return 0;
}

void CountsStream::take(const LoadCellLine& line, std::vector<CountsReading>& out) {
    last_s_ = steady_s();
    health_.alive = true;
    if (!take_time(line.t_us, clock_, health_)) return;
    out.push_back({last_s_, 1e-6 * static_cast<double>(clock_.total_us), line.raw});
    ++health_.received;
}

}  // namespace palpa::devices
