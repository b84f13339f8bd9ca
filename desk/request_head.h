#pragma once
// The head of an HTTP request, checked before the HTTP library sees it: its parser takes any number of header lines,
// puts ranges through a regular expression and inflates what a client has deflated.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace palpa::desk {

inline constexpr std::size_t kLongestHead_bytes = 16 * 1024;
inline constexpr std::size_t kLongestTarget = 1024;  // characters

struct CheckedHead {
    int refused = 0;                  // the HTTP status to refuse it with; 0 if it is fine
    std::string text;                 // the head as the library gets it, with the blank line
    std::uint64_t content_bytes = 0;  // length of the body, as announced
};

// `head` runs from the request line to the blank line. Refused are control characters, folded and nameless lines, over 100
// lines (431), a target over 1024 bytes (414), two lengths or one that is no number (400), PUT or POST without length
// and chunked bodies (411), encoded and multipart bodies (415). Lines that ask for ranges and compression are left out.
CheckedHead check_head(std::string_view head);

// What the body of a refusal says, for each status that check_head() gives.
const char* why_refused(int status);

}  // namespace palpa::desk
