#pragma once
// Sentences with gaps.

#include <initializer_list>
#include <string>
#include <string_view>

namespace palpa::files {

// Each {} of the pattern in turn replaced by a value. One value per {}.
std::string filled(std::string_view pattern, std::initializer_list<std::string_view> values);

}  // namespace palpa::files
