#pragma once
// Writing from memory as it stands, so that nothing large is copied first.

#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace palpa::files {

// Writes one piece after the other, as write_text_atomically() (files/text.h) writes one text.
void write_pieces_atomically(const std::filesystem::path& path, std::initializer_list<std::string_view> pieces);

// Writes all of `text` to an open file. Returns false with errno set if that fails.
bool write_all(int fd, std::string_view text);

}  // namespace palpa::files
