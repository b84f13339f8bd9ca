#include <doctest/doctest.h>

#include "files/clock.h"

using namespace palpa::files;

TEST_CASE("UTC as text: known seconds, a leap day, always 20 characters") {
    CHECK(utc_text(0) == "1970-01-01T00:00:00Z");
    CHECK(utc_text(1'000'000'000) == "2001-09-09T01:46:40Z");
    CHECK(utc_text(1'709'210'096) == "2024-02-29T12:34:56Z");
    CHECK(utc_now().size() == 20);
}

TEST_CASE("steady clock: seconds and nanoseconds are one clock, and it never goes back") {
    const double before_s = steady_s();
    const double between_s = 1e-9 * static_cast<double>(steady_ns());
    const double after_s = steady_s();
    constexpr double kRounding_s = 1e-6;  // a double of seconds since the start of the machine
    CHECK(before_s <= between_s + kRounding_s);
    CHECK(between_s <= after_s + kRounding_s);
}
