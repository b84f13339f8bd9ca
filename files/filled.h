#pragma once
// Sentences with gaps for values.

#include <initializer_list>
#include <string>
#include <string_view>

namespace palpa::files {

// Returns the pattern with each {} replaced by a value, in order. The pattern needs one {} per value (assert).
std::string filled(std::string_view pattern, std::initializer_list<std::string_view> values);

}  // namespace palpa::files
