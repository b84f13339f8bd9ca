#pragma once
// What a call says when it refuses its input.

#include <string>

#include "files/input_error.h"

namespace palpa::test {

// The InputError's message, or "" if nothing was refused. Other exceptions pass through.
template <class Call>
std::string message_of(Call&& call) {
    try {
        call();
    } catch (const files::InputError& error) {
        return error.what();
    }
    return "";
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace palpa::test
