#pragma once
// A file of what stands in several places, so that nothing large is copied to write it.

#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace palpa::files {

// One piece after the other, as write_text_atomically of files/text.h does it with one.
void write_pieces_atomically(const std::filesystem::path& path, std::initializer_list<std::string_view> pieces);

}  // namespace palpa::files
