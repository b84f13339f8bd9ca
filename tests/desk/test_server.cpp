#include <chrono>
#include <doctest/doctest.h>
#include <future>
#include <thread>

#include "desk/server.h"

using namespace palpa;
using namespace palpa::desk;

namespace {

constexpr std::chrono::seconds kPatience{20};

// Whether serve() returns although end() came `before` it or at some moment of its beginning.
bool ends(bool before, std::chrono::microseconds pause) {
    DeskServer server({}, {}, {});
    server.bind("127.0.0.1", 0);
    if (before) server.end();
    std::promise<void> ended;
    auto end = ended.get_future();
    std::thread serving([&] {
        server.serve();
        ended.set_value();
    });
    if (!before) {
        std::this_thread::sleep_for(pause);
        server.end();
    }
    const bool done = end.wait_for(kPatience) == std::future_status::ready;
    if (!done) server.stop();  // it runs by now, so that the test can go on
    serving.join();
    return done;
}

}  // namespace

TEST_CASE("desk server: it ends whenever it is asked, before it has begun as well") {
    CHECK(ends(true, {}));
    for (const int pause_us : {0, 10, 30, 100, 300, 1000, 3000, 10000}) {
        CAPTURE(pause_us);
        CHECK(ends(false, std::chrono::microseconds(pause_us)));
    }
}

TEST_CASE("desk server: a port that is listened on again after the end") {
    DeskServer first({}, {}, {});
    const int port = first.bind("127.0.0.1", 0);
    std::thread serving([&] { first.serve(); });
    first.end();
    serving.join();
    DeskServer second({}, {}, {});
    CHECK(second.bind("127.0.0.1", port) == port);
}
