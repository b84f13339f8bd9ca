// The desktop's window. Supported: X11 (pressure by XInput2), Wayland (no pressure), off-screen. Tried on Xorg 21.1
// with its inputtest driver and on Mesa's software drawing.

#include "platform/window.h"

#include <SDL.h>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "files/clock.h"
#include "platform/linux/gl_window.h"
#include "platform/linux/pointers.h"

namespace palpa::platform {
namespace {

int SDLCALL watch(void* user, SDL_Event* event) {
    receive(*event, files::steady_s(), *static_cast<Pointers*>(user));
    return 1;
}

// Waits, and returns as soon as an event arrives. SDL waits in whole milliseconds.
void wait_for_event(double wait_s, const Pointers& pointers) {
    if (pointers.xinput) return wait_for_server(*pointers.xinput, wait_s);
    SDL_Event event;
    SDL_WaitEventTimeout(&event, static_cast<int>(std::ceil(1e3 * wait_s)));
}

PointerDevice describe(const XiDevice& device) {
    const bool has_pressure = device.pressure.number >= 0 && device.pressure.hi > device.pressure.lo;
    PointerDevice out{device.id, device.name, device.tool, has_pressure};
    out.has_tilt = device.tilt_x.number >= 0 && device.tilt_y.number >= 0;
    out.has_contact_size = device.touch_major.number >= 0;
    out.axes = device.axes;
    if (has_pressure) {
        out.pressure_min = device.pressure.lo;
        out.pressure_max = device.pressure.hi;
        out.levels = std::llround(device.pressure.hi - device.pressure.lo) + 1;
    }
    return out;
}

}  // namespace

struct Window::Impl {
    explicit Impl(const WindowOptions& options) : gl(options) {
        pointers.window = gl.sdl();
        pointers.mouse.button.hold_s = options.mouse_hold_s;
        pointers.keyboard.button.hold_s = options.mouse_hold_s;
        pointers.xinput = open_xinput(gl.sdl());
        if (pointers.xinput) SDL_EventState(SDL_SYSWMEVENT, SDL_ENABLE);
        SDL_AddEventWatch(watch, &pointers);
    }
    ~Impl() { SDL_DelEventWatch(watch, &pointers); }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    GlWindow gl;
    Pointers pointers;
    std::optional<SDL_Rect> before_full;  // the window's place before it covered a screen without a window manager
    bool stirred = false;                 // of the last poll()
    bool uncovered = false;
};

Window::Window(const WindowOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Window::~Window() = default;

void Window::poll(double wait_s, std::vector<Sample>& out) {
    Pointers& pointers = impl_->pointers;
    // a held button or key gives a sample at each grid point without any event
    const bool held = pointers.mouse.button.down || key_held(pointers.keyboard);
    const double longest_s = held ? 1.0 / kHoldGrid_Hz : wait_s;
    if (wait_s > 0.0 && pointers.pending.empty()) wait_for_event(std::min(wait_s, longest_s), pointers);
    SDL_PumpEvents();
    SDL_FlushEvents(SDL_FIRSTEVENT, SDL_LASTEVENT);  // the watch has seen them
    hold(files::steady_s(), pointers);
    out.insert(out.end(), pointers.pending.begin(), pointers.pending.end());
    pointers.pending.clear();
    impl_->stirred = std::exchange(pointers.stirred, false);
    impl_->uncovered = std::exchange(pointers.uncovered, false);
}

const PressureWatch& Window::pressure() const { return impl_->pointers.presses.pressure; }

bool Window::stirred() const { return impl_->stirred; }

bool Window::uncovered() const { return impl_->uncovered; }

void Window::set_event_filter(EventFilter filter, void* user) {
    impl_->pointers.filter = filter;
    impl_->pointers.filter_user = user;
}

void Window::end_presses() { forget_presses(impl_->pointers); }

void Window::set_keyboard(double x0_px, double y0_px, double x1_px, double y1_px, double speed_px_per_s) {
    set_keyboard_area(files::steady_s(), {x0_px, y0_px, x1_px, y1_px, speed_px_per_s}, impl_->pointers);
}

double Window::keyboard_x_px() const { return impl_->pointers.keyboard.x_px; }

double Window::keyboard_y_px() const { return impl_->pointers.keyboard.y_px; }

bool Window::hidden() const { return (SDL_GetWindowFlags(sdl()) & (SDL_WINDOW_HIDDEN | SDL_WINDOW_MINIMIZED)) != 0; }

bool Window::close_requested() const { return impl_->pointers.close_requested || impl_->pointers.quit_requested; }

bool Window::stay_open() {
    impl_->pointers.close_requested = false;
    return !impl_->pointers.quit_requested;
}

void Window::present() { SDL_GL_SwapWindow(sdl()); }

double Window::now_s() const { return files::steady_s(); }

int Window::width_px() const {
    int width_px = 0;
    SDL_GL_GetDrawableSize(sdl(), &width_px, nullptr);
    return width_px;
}

int Window::height_px() const {
    int height_px = 0;
    SDL_GL_GetDrawableSize(sdl(), nullptr, &height_px);
    return height_px;
}

double Window::mouse_pressure() const {
    const Pointers& pointers = impl_->pointers;
    const bool pressing = presses_tissue(pointers.presses, kMousePointerId);
    if (pointers.mouse.button.down && !pressing) return 0.0;  // the press is a panel's
    return pressure_at(pointers.mouse.button, files::steady_s());
}

std::vector<PointerDevice> Window::devices() const {
    const auto& xinput = impl_->pointers.xinput;
    if (!xinput) return {{0, "mouse", Tool::mouse}};
    std::vector<PointerDevice> devices;
    for (const XiDevice& device : xinput->state.devices) {
        const bool made_by_server = device.name.find("XTEST") != std::string::npos;
        if (!made_by_server) devices.push_back(describe(device));
    }
    return devices;
}

bool Window::lists_devices() const { return true; }

std::string Window::input_note() const {
    if (impl_->pointers.xinput) return {};
    const char* driver = SDL_GetCurrentVideoDriver();
    const std::string_view name = driver != nullptr ? driver : "";
    if (name == "wayland") {
        return "no pressure of pens or fingers on Wayland: start with SDL_VIDEODRIVER=x11, or press with the "
               "mouse (hold its button, or turn its wheel)";
    }
    return "no pressure of pens or fingers with the display driver " + std::string(name) + ": it needs X11";
}

void Window::set_title(const std::string& title) { SDL_SetWindowTitle(sdl(), title.c_str()); }

bool Window::full_screen() const {
    return impl_->before_full || (SDL_GetWindowFlags(sdl()) & SDL_WINDOW_FULLSCREEN_DESKTOP) != 0;
}

void Window::set_full_screen(bool full) {
    if (full == full_screen()) return;
    if (!impl_->before_full && window_managed(sdl())) {
        SDL_SetWindowFullscreen(sdl(), full ? SDL_WINDOW_FULLSCREEN_DESKTOP : 0);
        return;
    }
    // SDL would take the window for as large as the screen, which nobody has made it
    SDL_Rect area{};
    if (full) {
        SDL_Rect now{};
        SDL_GetWindowPosition(sdl(), &now.x, &now.y);
        SDL_GetWindowSize(sdl(), &now.w, &now.h);
        if (SDL_GetDisplayBounds(std::max(0, SDL_GetWindowDisplayIndex(sdl())), &area) != 0) return;
        impl_->before_full = now;
    } else {
        area = *std::exchange(impl_->before_full, std::nullopt);
    }
    SDL_SetWindowPosition(sdl(), area.x, area.y);
    SDL_SetWindowSize(sdl(), area.w, area.h);
}

std::string Window::screen_name() const {
    const int display = std::max(0, SDL_GetWindowDisplayIndex(sdl()));
    SDL_DisplayMode mode{};
    SDL_GetDesktopDisplayMode(display, &mode);
    const char* name = SDL_GetDisplayName(display);
    return std::string(name != nullptr ? name : "screen") + ", " + std::to_string(mode.w) + " x " +
           std::to_string(mode.h);
}

double Window::touch_px_per_mm() const { return kMissing; }

SDL_Window* Window::sdl() const { return impl_->gl.sdl(); }

}  // namespace palpa::platform
