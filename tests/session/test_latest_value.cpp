#include <doctest/doctest.h>
#include <thread>

#include "session/latest_value.h"

using namespace palpa::session;

TEST_CASE("latest value: only the last one that was put is taken, and once") {
    LatestValue<int> latest;
    int out = -1;
    CHECK_FALSE(latest.take(out));
    CHECK(out == -1);
    for (int round = 0; round < 5; ++round) {
        latest.put(10 * round);
        latest.put(10 * round + 1);
        CHECK(latest.take(out));
        CHECK(out == 10 * round + 1);
        CHECK_FALSE(latest.take(out));
    }
}

TEST_CASE("latest value: between two threads values are whole, never go back, and the last arrives") {
    struct Pair {
        long first = 0;
        long second = 0;
    };
    constexpr long kLast = 200000;
    LatestValue<Pair> latest;
    std::thread writer([&] {
        for (long i = 1; i <= kLast; ++i) latest.put({i, -i});
    });
    long seen = 0;
    bool whole = true;
    bool forward = true;
    while (seen < kLast) {
        Pair pair;
        if (!latest.take(pair)) continue;
        whole = whole && pair.second == -pair.first;
        forward = forward && pair.first > seen;
        if (pair.first > kLast || !forward) break;
        seen = pair.first;
    }
    writer.join();
    CHECK(whole);
    CHECK(forward);
    CHECK(seen == kLast);
}
