#include "desk/events.h"

#include <array>
#include <cstdio>
#include <ctime>

namespace palpa::desk {
namespace {

constexpr int kMostRefusals = 60;

}  // namespace

void DeskEvents::print(const std::string& event, const std::string& line, files::Json fields) {
    if (json_) {
        files::Json json{{"event", event}};
        json.update(fields);
        std::printf("%s\n", json.dump(-1, ' ', false, files::Json::error_handler_t::replace).c_str());
    } else {
        const std::time_t now = std::time(nullptr);
        std::tm local{};
        localtime_r(&now, &local);
        std::array<char, 16> clock{};
        std::strftime(clock.data(), clock.size(), "%H:%M:%S", &local);
        std::printf("%s %s: %s\n", clock.data(), event.c_str(), line.c_str());
    }
    std::fflush(stdout);
}

void DeskEvents::tell(const std::string& event, const std::string& line, files::Json fields) {
    const std::lock_guard lock(mutex_);
    print(event, line, std::move(fields));
}

void DeskEvents::tell_refused(const std::string& line, files::Json fields) {
    const std::lock_guard lock(mutex_);
    const std::int64_t minute = std::time(nullptr) / 60;
    if (minute != minute_) {
        const int untold = refused_ - kMostRefusals;
        if (untold > 0) print("refused", std::to_string(untold) + " more in that minute", {{"more", untold}});
        minute_ = minute;
        refused_ = 0;
    }
    if (++refused_ <= kMostRefusals) print("refused", line, std::move(fields));
}

}  // namespace palpa::desk
