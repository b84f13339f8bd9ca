#pragma once
// Messages with numbers in them (std::format is not in GCC 12).

#include <sstream>
#include <string>

namespace palpa::mechanics {

template <class... Parts>
std::string text(const Parts&... parts) {
    std::ostringstream out;
    (out << ... << parts);
    return out.str();
}

}  // namespace palpa::mechanics
