#pragma once
// Messages for a terminal that may quote the content of a file, and whether a text is UTF-8.

#include <string>
#include <string_view>

namespace palpa::files {

// Replaces control characters, which could steer the terminal, by '?' (line ends stay), and cuts a message that is
// longer than 4,000 bytes.
std::string printable(std::string_view message);

bool is_utf8(std::string_view text);

}  // namespace palpa::files
