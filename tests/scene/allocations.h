#pragma once
// Counts every allocation of this test program.

#include <cstdint>

namespace palpa::test {

std::int64_t allocations();

}  // namespace palpa::test
