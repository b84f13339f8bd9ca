#pragma once
// What the desk says while it serves: a line for each event.

#include <cstdint>
#include <mutex>
#include <string>

#include "files/json.h"

namespace palpa::desk {

// May be called by many threads. More than 60 refusals in a minute are counted, not printed, so that no client can fill
// the terminal.
class DeskEvents {
  public:
    explicit DeskEvents(bool json) : json_(json) {}

    // Prints "15:40:02 paired: tablet 1 at 192.168.1.7", or one JSON object {"event": "paired", ...} per line.
    void tell(const std::string& event, const std::string& line, files::Json fields = files::Json::object());
    void tell_refused(const std::string& line, files::Json fields);

  private:
    void print(const std::string& event, const std::string& line, files::Json fields);

    bool json_;
    std::mutex mutex_;
    std::int64_t minute_ = 0;
    int refused_ = 0;  // in this minute
};

}  // namespace palpa::desk
