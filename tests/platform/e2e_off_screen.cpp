// The window without any display: it draws, and takes events that are put into SDL's queue.
#include <GLES3/gl3.h>
#include <SDL.h>
#include <array>
#include <cstdlib>
#include <doctest/doctest.h>
#include <stdexcept>
#include <string>
#include <vector>

#include "platform/window.h"

using palpa::platform::Phase;
using palpa::platform::Sample;
using palpa::platform::Window;
using palpa::platform::WindowEvent;
using palpa::platform::WindowOptions;

namespace {

Uint32 id_of(const Window& window) { return SDL_GetWindowID(window.sdl()); }

void push_button(Uint32 type, int x_px, const Window& window) {
    SDL_Event event{};
    event.type = type;
    event.button.windowID = id_of(window);
    event.button.button = SDL_BUTTON_LEFT;
    event.button.state = type == SDL_MOUSEBUTTONDOWN ? SDL_PRESSED : SDL_RELEASED;
    event.button.x = x_px;
    SDL_PushEvent(&event);
}

void push_window(Uint8 what, const Window& window) {
    SDL_Event event{};
    event.type = SDL_WINDOWEVENT;
    event.window.windowID = id_of(window);
    event.window.event = what;
    SDL_PushEvent(&event);
}

WindowOptions off_screen() {
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    WindowOptions options;
    options.width_px = 320;
    options.height_px = 200;
    options.visible = false;
    return options;
}

}  // namespace

TEST_CASE("off screen: draws without a display") {
    Window window(off_screen());
    CHECK(window.width_px() == 320);
    CHECK(window.height_px() == 200);
    CHECK(std::string(reinterpret_cast<const char*>(glGetString(GL_VERSION))).starts_with("OpenGL ES 3"));
    glViewport(0, 0, 320, 200);
    glClearColor(0.2f, 0.4f, 0.6f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    std::array<unsigned char, 4> pixel{};
    glReadPixels(160, 100, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
    CHECK(static_cast<int>(pixel[0]) == 51);
    CHECK(static_cast<int>(pixel[1]) == 102);
    CHECK(static_cast<int>(pixel[2]) == 153);
    CHECK(glGetError() == GL_NO_ERROR);
    window.present();
    CHECK_FALSE(window.input_note().empty());
    CHECK(window.devices().size() == 1);
}

TEST_CASE("off screen: losing the focus cancels a press, and its release is not heard") {
    Window window(off_screen());
    std::vector<Sample> samples;
    window.poll(0.0, samples);
    samples.clear();
    push_button(SDL_MOUSEBUTTONDOWN, 10, window);
    push_window(SDL_WINDOWEVENT_FOCUS_LOST, window);
    push_button(SDL_MOUSEBUTTONUP, 10, window);
    window.poll(0.0, samples);
    REQUIRE(samples.size() >= 2);
    CHECK(samples.front().phase == Phase::down);
    // a mouse presses harder with time: on a busy computer some of that comes before the focus is lost
    for (std::size_t i = 1; i + 1 < samples.size(); ++i) CHECK(samples[i].phase == Phase::move);
    CHECK(samples.back().phase == Phase::cancel);
    CHECK(samples.back().x_px == 10.0);
}

TEST_CASE("off screen: a press that a panel owns stays silent until its release") {
    Window window(off_screen());
    window.set_event_filter(
        [](const WindowEvent& event, void*) { return event.kind == WindowEvent::Kind::button_down; }, nullptr);
    std::vector<Sample> samples;
    window.poll(0.0, samples);
    samples.clear();
    push_button(SDL_MOUSEBUTTONDOWN, 10, window);
    const double start_s = window.now_s();
    while (window.now_s() - start_s < 0.05) window.poll(0.01, samples);
    CHECK(window.mouse_pressure() == 0.0);
    push_button(SDL_MOUSEBUTTONUP, 10, window);
    window.poll(0.0, samples);
    CHECK(samples.empty());
}

TEST_CASE("off screen: a window knows whether it is minimised or hidden") {
    Window window(off_screen());
    SDL_ShowWindow(window.sdl());
    CHECK_FALSE(window.hidden());
    SDL_HideWindow(window.sdl());
    CHECK(window.hidden());
    SDL_ShowWindow(window.sdl());
    CHECK_FALSE(window.hidden());
}

TEST_CASE("off screen: closing is reported") {
    Window window(off_screen());
    CHECK_FALSE(window.close_requested());
    push_window(SDL_WINDOWEVENT_CLOSE, window);
    std::vector<Sample> samples;
    window.poll(0.0, samples);
    CHECK(window.close_requested());
}

TEST_CASE("off screen: a window that was asked to close may stay, a program that was ended may not") {
    Window window(off_screen());
    std::vector<Sample> samples;
    push_window(SDL_WINDOWEVENT_CLOSE, window);
    window.poll(0.0, samples);
    CHECK(window.stay_open());
    CHECK_FALSE(window.close_requested());
    SDL_Event quit{};
    quit.type = SDL_QUIT;
    SDL_PushEvent(&quit);
    window.poll(0.0, samples);
    CHECK_FALSE(window.stay_open());
    CHECK(window.close_requested());
}

TEST_CASE("off screen: without a display a visible window says what can be done") {
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    setenv("SDL_VIDEODRIVER", "x11", 1);
    std::string message;
    try {
        Window window(WindowOptions{});
    } catch (const std::runtime_error& error) {
        message = error.what();
    }
    unsetenv("SDL_VIDEODRIVER");
    CHECK(message.find("DISPLAY is not set") != std::string::npos);
    CHECK(message.find("--headless") != std::string::npos);
}
