// Devices that come and go (run it under with-xorg).
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <string>
#include <thread>
#include <vector>

#include "tests/platform/e2e_scripts.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::xorg;

TEST_CASE("mouse: devices that come and go are noticed") {
    Window window(small_window());
    std::vector<Sample> samples;
    const auto count_after = [&](const char* command) {
        REQUIRE(std::system(command) == 0);
        const double start_s = window.now_s();
        while (window.now_s() - start_s < 0.3) window.poll(0.05, samples);
        return window.devices().size();
    };
    const std::string player = PALPA_XORG_PEN;
    const std::size_t all = window.devices().size();
    CHECK(count_after((player + " --disable touch").c_str()) == all - 1);
    CHECK(count_after((player + " --enable touch").c_str()) == all);
}

TEST_CASE("unplugged: a pen that goes while it presses ends its press") {
    Window window(small_window());
    std::vector<Row> rows;
    for (int i = 0; i < 20; ++i) {
        const char* phase = i < 5 ? "hover" : i == 5 ? "down" : "move";
        rows.push_back({i / 100.0, "pen", 0, phase, 500.0 + i, 400.0, i < 5 ? 0.0 : 0.5});
    }
    std::vector<Sample> samples = of_tool(Tool::pen, play(rows, window));
    REQUIRE(samples.size() == 20);
    CHECK(samples.back().phase == Phase::move);

    samples.clear();
    REQUIRE(std::system(PALPA_XORG_PEN " --disable pen") == 0);
    const double start_s = window.now_s();
    while (window.now_s() - start_s < 0.3) window.poll(0.05, samples);
    REQUIRE(samples.size() == 1);
    const bool ended = samples[0].phase == Phase::up || samples[0].phase == Phase::cancel;
    CHECK(ended);
    MESSAGE("it ended with ", std::string(name_of(samples[0].phase)));
}

TEST_CASE("plugging: a pen that goes and comes again costs the fingers no sample") {
    Window window(small_window());
    const auto pens = [&] {
        int count = 0;
        for (const palpa::platform::PointerDevice& device : window.devices()) count += device.tool == Tool::pen ? 1 : 0;
        return count;
    };
    std::vector<Row> rows;
    for (int i = 0; i < 400; ++i) {  // 2 s at 200 Hz
        const char* phase = i == 0 ? "down" : i == 399 ? "up" : "move";
        rows.push_back(
            {0.005 * i, "touch", 1, phase, 400.0 + i, 500.0, i == 399 ? 0.0 : std::round(2.047 * i) / 2047.0});
    }
    std::atomic<bool> over = false;
    std::thread hand([&] {
        const auto run = [](const char* what) { CHECK(std::system(what) == 0); };
        for (const char* what :
             {PALPA_XORG_PEN " --disable pen", PALPA_XORG_PEN " --enable pen", PALPA_XORG_PEN " --disable pen"}) {
            std::this_thread::sleep_for(std::chrono::milliseconds(500));
            run(what);
        }
        over = true;
    });
    CHECK(pens() == 1);
    std::vector<Sample> samples = play(rows, window);
    hand.join();
    CHECK(over);
    window.poll(0.05, samples);
    CHECK(pens() == 0);
    std::vector<Sample> fingers = of_tool(Tool::finger, samples);
    REQUIRE(fingers.size() == rows.size());
    fingers.back().pressure = 0.0;
    check_against(rows, fingers, window);

    REQUIRE(std::system(PALPA_XORG_PEN " --enable pen") == 0);
    const double start_s = window.now_s();
    while (window.now_s() - start_s < 0.3) window.poll(0.05, samples);
    CHECK(pens() == 1);
    for (const palpa::platform::PointerDevice& device : window.devices()) {
        CAPTURE(device.name);
        if (device.tool == Tool::pen) CHECK(device.levels == 1001);
        if (device.tool == Tool::finger) CHECK(device.levels == 2048);
        if (device.tool == Tool::mouse) CHECK(device.levels == 0);
        CHECK_FALSE(device.has_tilt);
        CHECK_FALSE(device.axes.empty());
    }
}
