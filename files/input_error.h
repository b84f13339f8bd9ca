#pragma once
// The exception for bad input. main() prints its message and exits with status 2.

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

// Makes text from a file fit for a message: cut at 40 characters, without control characters, quoted.
std::string shown(std::string_view text);

}  // namespace palpa::files
