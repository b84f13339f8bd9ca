#pragma once
// What is thrown for bad input. main() prints the message and exits with status 2.

#include <stdexcept>
#include <string>
#include <string_view>

namespace palpa::files {

class InputError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// "slab.json: young_Pa: found -3, expected a number > 0". `where` is a key, a line ("line 12") or empty.
InputError bad_input(std::string_view file, std::string_view where, std::string_view found, std::string_view expected);

// Text from a file as it may stand in a message: cut at 40 characters, without control characters, quoted.
std::string shown(std::string_view text);

}  // namespace palpa::files
