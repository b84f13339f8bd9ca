#include <doctest/doctest.h>
#include <vector>

#include "platform/sample_clock.h"

namespace {

std::vector<double> unwrapped(const std::vector<std::uint32_t>& readings_ms) {
    palpa::platform::UnwrapState state;
    std::vector<double> out;
    for (const std::uint32_t now_ms : readings_ms) out.push_back(palpa::platform::unwrap_ms(now_ms, state));
    return out;
}

constexpr double kWrap_ms = 4294967296.0;

}  // namespace

TEST_CASE("sample clock: without a wrap it is the clock itself") {
    CHECK(unwrapped({0, 1, 17, 1000000}) == std::vector<double>{0.0, 1.0, 17.0, 1e6});
    CHECK(unwrapped({4000000000u, 4000000008u}) == std::vector<double>{4000000000.0, 4000000008.0});
}

TEST_CASE("hard case 11: the sample clock goes on over a wrap of its 32 bits") {
    CHECK(unwrapped({4294967290u, 4294967295u, 0, 4, 1000}) ==
          std::vector<double>{4294967290.0, 4294967295.0, kWrap_ms, kWrap_ms + 4.0, kWrap_ms + 1000.0});
}

TEST_CASE("sample clock: counts several wraps") {
    const auto out_ms = unwrapped({0, 2000000000u, 4000000000u, 1705032704u, 3705032704u, 1410065408u});
    CHECK(out_ms == std::vector<double>{0.0, 2e9, 4e9, 6e9, 8e9, 1e10});
}

TEST_CASE("sample clock: repeated readings give the same time") {
    CHECK(unwrapped({7, 7, 7}) == std::vector<double>{7.0, 7.0, 7.0});
    CHECK(unwrapped({4294967295u, 0, 0})[2] == kWrap_ms);
}

TEST_CASE("sample clock: small steps backwards are not wraps") {
    CHECK(unwrapped({100, 98, 101}) == std::vector<double>{100.0, 98.0, 101.0});
    // back over the wrap and forth again
    CHECK(unwrapped({4294967295u, 1, 4294967294u, 2}) ==
          std::vector<double>{4294967295.0, kWrap_ms + 1.0, 4294967294.0, kWrap_ms + 2.0});
    // before the clock's own start: below zero rather than 49 days ahead
    CHECK(unwrapped({1, 4294967295u}) == std::vector<double>{1.0, -1.0});
}
