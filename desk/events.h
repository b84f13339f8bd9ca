#pragma once
// What the desk says while it serves: a line for each event.

#include <cstdint>
#include <mutex>
#include <string>

#include "files/json.h"

namespace palpa::desk {

// May be called by many threads. Refusals over 60 in a minute are counted, not printed: nobody fills the terminal.
class DeskEvents {
  public:
    explicit DeskEvents(bool json) : json_(json) {}

    // "15:40:02 paired: tablet 1 at 192.168.1.7", or one JSON object {"event": "paired", ...} in a line.
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
