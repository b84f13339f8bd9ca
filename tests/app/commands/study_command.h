#pragma once
// palpa study, called as a person calls it.

#include <doctest/doctest.h>
#include <string>

#include "tests/error_message.h"
#include "tests/shell.h"

namespace palpa::test {

inline const std::string kCounts = PALPA_SOURCE_DIR "/assets/counts/paper.tsv";

inline Called study(const std::string& arguments) { return shell("timeout 120 " PALPA_PROGRAM " study " + arguments); }

inline void refused(const std::string& arguments, const std::string& word) {
    const Called called = study(arguments);
    CAPTURE(arguments);
    CAPTURE(called.err);
    CHECK(called.status == 2);
    CHECK(contains(called.err, word));
}

}  // namespace palpa::test
