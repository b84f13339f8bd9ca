#pragma once
// Scripts for the devices of with-xorg, and what their samples must be.

#include <SDL.h>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "platform/window.h"

namespace palpa::xorg {

struct Row {
    double t_s = 0.0;
    std::string kind;
    int id = 0;
    std::string phase;
    double x_px = 0.0;  // on the screen
    double y_px = 0.0;
    double pressure = 0.0;
};

inline platform::WindowOptions small_window() {
    platform::WindowOptions options;
    options.width_px = 1000;
    options.height_px = 700;
    options.mouse_hold_s = 1.0;
    return options;
}

inline std::string write_script(const std::vector<Row>& rows) {
    const auto path = std::filesystem::path(std::getenv("XORG_LOG")).parent_path() / "script.tsv";
    std::ofstream file(path);
    file.precision(12);
    file << "t_s\tkind\tid\tphase\tx_px\ty_px\tpressure\n";
    for (const Row& row : rows) {
        file << row.t_s << '\t' << row.kind << '\t' << row.id << '\t' << row.phase << '\t' << row.x_px << '\t'
             << row.y_px << '\t' << row.pressure << '\n';
    }
    return path.string();
}

// Polls like an application until the script is over and nothing has come for 0.3 s, or has not stopped for 1 s.
inline std::vector<platform::Sample> play(const std::vector<Row>& rows, platform::Window& window) {
    std::vector<platform::Sample> samples;
    for (int i = 0; i < 20; ++i) window.poll(0.01, samples);  // what appearing brings with it
    samples.clear();

    const std::string command = std::string(PALPA_XORG_PEN) + " " + write_script(rows);
    std::atomic<bool> over = false;
    int status = -1;
    std::thread player([&] {
        status = std::system(command.c_str());
        over = true;
    });
    double last_s = window.now_s();
    double ended_s = last_s;
    while (!over || (window.now_s() - last_s < 0.3 && window.now_s() - ended_s < 1.0)) {
        const std::size_t before = samples.size();
        if (!over) ended_s = window.now_s();
        window.poll(0.016, samples);
        if (samples.size() > before) last_s = window.now_s();
    }
    player.join();
    CHECK(status == 0);
    return samples;
}

inline std::vector<platform::Sample> of_tool(platform::Tool tool, const std::vector<platform::Sample>& samples) {
    std::vector<platform::Sample> out;
    for (const platform::Sample& sample : samples) {
        if (sample.tool == tool) out.push_back(sample);
    }
    return out;
}

inline void check_in_order(const std::vector<platform::Sample>& samples) {
    double host_s = 0.0, device_s = 0.0;
    int backwards = 0;
    for (const platform::Sample& sample : samples) {
        backwards += sample.t_host_s < host_s ? 1 : 0;
        host_s = sample.t_host_s;
        if (std::isnan(sample.t_device_s)) continue;
        backwards += sample.t_device_s < device_s ? 1 : 0;
        device_s = sample.t_device_s;
    }
    CHECK(backwards == 0);
}

// Each sample against the row that made it: phase, place to 0.1 px, pressure to half of 1/1000.
inline void check_against(const std::vector<Row>& rows, const std::vector<platform::Sample>& samples,
                          platform::Window& window) {
    int origin_x = 0, origin_y = 0;
    SDL_GetWindowPosition(window.sdl(), &origin_x, &origin_y);
    CHECK(origin_x > 0);
    REQUIRE(samples.size() == rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        CAPTURE(i);
        REQUIRE(platform::name_of(samples[i].phase) == rows[i].phase);
        REQUIRE(std::abs(samples[i].x_px - (rows[i].x_px - origin_x)) < 0.1);
        REQUIRE(std::abs(samples[i].y_px - (rows[i].y_px - origin_y)) < 0.1);
        REQUIRE(std::abs(samples[i].pressure - rows[i].pressure) < 0.5e-3);
    }
}

}  // namespace palpa::xorg
