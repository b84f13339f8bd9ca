#pragma once
// Messages for a terminal, where they quote what stands in a file.

#include <string>
#include <string_view>

namespace palpa::files {

// Control characters, which could steer the terminal, become '?' (line ends stay); what is longer than 4,000 bytes is cut.
std::string printable(std::string_view message);

}  // namespace palpa::files
