#pragma once
// Questions and answers on a serial line; for the threads of actuator_line.h.

#include <array>
#include <chrono>
#include <span>
#include <thread>

#include "devices/actuator_line.h"
#include "devices/force_sensor.h"
#include "platform/serial_port.h"

namespace palpa::devices {

inline void pause(double seconds) {
    if (seconds > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

// Returns false once the port is gone. A line that takes nothing for 20 ms counts as gone.
inline bool put(std::span<const std::uint8_t> bytes, platform::SerialPort& port) {
    constexpr double kWrite_s = 0.02;
    return port.write(bytes.data(), bytes.size(), kWrite_s);
}

enum class Answer : std::uint8_t { good, none, gone };

// Feeds what arrives within `wait_s` (0: what is there) until `wanted` takes a message.
template <class Parser, class Message, class Wanted>
Answer await_message(double wait_s, platform::SerialPort& port, Parser& parser, Message& message,
                     const Wanted& wanted) {
    std::array<std::uint8_t, 256> bytes;
    const double until_s = steady_s() + wait_s;
    for (double left_s = wait_s; left_s >= 0.0; left_s = until_s - steady_s()) {
        const int n = port.read(left_s, bytes.data(), bytes.size());
        if (n < 0) return Answer::gone;
        bool found = false;
        Message next;
        for (int i = 0; i < n; ++i) {
            if (!feed(bytes[static_cast<std::size_t>(i)], parser, next) || found || !wanted(next)) continue;
            message = next;
            found = true;
        }
        if (found) return Answer::good;
        if (wait_s <= 0.0) return Answer::none;
    }
    return Answer::none;
}

// Asks, and counts what comes of it. What is left of older answers is dropped first.
template <class Parser, class Message, class Wanted>
Answer ask(std::span<const std::uint8_t> question, double wait_s, platform::SerialPort& port, Parser& parser,
           LineProtocol& line, Message& message, const Wanted& wanted) {
    const auto nothing = [](const Message&) { return false; };
    if (await_message(0.0, port, parser, message, nothing) == Answer::gone || !put(question, port)) return Answer::gone;
    const Answer answer = await_message(wait_s, port, parser, message, wanted);
    line.health.malformed = parser.malformed;
    line.health.replies += answer == Answer::good;
    line.health.missing += answer == Answer::none;
    line.bad_in_a_row += answer == Answer::none;
    return answer;
}

// What a good answer says: whether there is an error.
inline void judge(bool error, LineProtocol& line) {
    line.health.errors += error;
    line.bad_in_a_row = error ? line.bad_in_a_row + 1 : 0;
}

inline PinState state_of(Answer answer) {
    return answer == Answer::gone ? PinState::gone : answer == Answer::none ? PinState::no_answer : PinState::driving;
}

}  // namespace palpa::devices
