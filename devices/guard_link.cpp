#include "devices/guard_link.h"

namespace palpa::devices {

std::size_t size_of(const GuardMessage& message) noexcept {
    return kGuardHead_bytes + sizeof(double) * static_cast<std::size_t>(message.values);
}

bool is_whole(const GuardMessage& message, std::size_t received) noexcept {
    const auto word = static_cast<std::uint32_t>(message.word);
    const bool known = word >= static_cast<std::uint32_t>(GuardWord::command) &&
                       word <= static_cast<std::uint32_t>(GuardWord::release);
    return received >= kGuardHead_bytes && known && message.values <= GuardMessage::kMostValues &&
           received == size_of(message);
}

}  // namespace palpa::devices
