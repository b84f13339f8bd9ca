#pragma once
// doctest's Approx adds 1 to the size of what it compares, so that lengths in metres always agree. This one is relative, and
// absolute beside 0.

#include <doctest/doctest.h>

namespace palpa::test {

inline doctest::Approx close_to(double value) { return doctest::Approx(value).scale(value == 0.0 ? 1.0 : 0.0); }

}  // namespace palpa::test
