// The browser's window: a canvas with WebGL 2, and the events that are sent to it. There is one such window, and it is
// never destroyed.

#include "platform/window.h"

#include <emscripten.h>
#include <emscripten/html5.h>
#include <stdexcept>
#include <utility>

#include "platform/web/browser.h"
#include "platform/web/pointers.h"

namespace palpa::platform {
namespace {

// CSS px per millimetre of a touch screen: 160 per inch. Tablets have 120 to 160, so that targets become larger rather
// than smaller than intended.
constexpr double kTouch_css_px_per_mm = 160.0 / 25.4;

Pointers* open_pointers = nullptr;  // of the one window; the browser calls functions, not objects

void open_gl() {
    EmscriptenWebGLContextAttributes attributes;
    emscripten_webgl_init_context_attributes(&attributes);
    attributes.majorVersion = 2;
    attributes.alpha = false;
    attributes.depth = true;
    attributes.antialias = false;
    attributes.powerPreference = EM_WEBGL_POWER_PREFERENCE_HIGH_PERFORMANCE;
    const EMSCRIPTEN_WEBGL_CONTEXT_HANDLE context = emscripten_webgl_create_context("#canvas", &attributes);
    if (context <= 0) throw std::runtime_error("this browser gives no WebGL 2, which Palpa draws with");
    emscripten_webgl_make_context_current(context);
}

}  // namespace

struct Window::Impl {
    explicit Impl(const WindowOptions& options) {
        browser::fit_canvas();
        browser::set_title(options.title.c_str());
        open_gl();
        pointers.mouse.button.hold_s = options.mouse_hold_s;
        pointers.keyboard.button.hold_s = options.mouse_hold_s;
        open_pointers = &pointers;
        browser::listen();
    }
    ~Impl() { open_pointers = nullptr; }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    Pointers pointers;
    bool stirred = false;  // of the last poll()
};

Window::Window(const WindowOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Window::~Window() = default;

void Window::poll(double, std::vector<Sample>& out) {
    Pointers& pointers = impl_->pointers;
    browser::fit_canvas();
    hold(browser::now_s(), pointers);
    out.insert(out.end(), pointers.pending.begin(), pointers.pending.end());
    pointers.pending.clear();
    impl_->stirred = std::exchange(pointers.stirred, false);
}

const PressureWatch& Window::pressure() const { return impl_->pointers.presses.pressure; }

bool Window::stirred() const { return impl_->stirred; }
bool Window::uncovered() const { return false; }  // the browser keeps what was drawn

void Window::set_event_filter(EventFilter filter, void* user) {
    impl_->pointers.filter = filter;
    impl_->pointers.filter_user = user;
}

void Window::end_presses() { forget_presses(impl_->pointers); }

void Window::set_keyboard(double x0_px, double y0_px, double x1_px, double y1_px, double speed_px_per_s) {
    set_keyboard_area(browser::now_s(), {x0_px, y0_px, x1_px, y1_px, speed_px_per_s}, impl_->pointers);
}

bool Window::hidden() const { return false; }
bool Window::close_requested() const { return false; }
bool Window::stay_open() { return true; }
void Window::present() {}
double Window::now_s() const { return browser::now_s(); }
int Window::width_px() const { return browser::canvas_width_px(); }
int Window::height_px() const { return browser::canvas_height_px(); }
double Window::keyboard_x_px() const { return impl_->pointers.keyboard.x_px; }
double Window::keyboard_y_px() const { return impl_->pointers.keyboard.y_px; }

double Window::mouse_pressure() const {
    const Pointers& pointers = impl_->pointers;
    if (pointers.mouse.button.down && !presses_tissue(pointers.presses, kMousePointerId)) return 0.0;
    return pressure_at(pointers.mouse.button, browser::now_s());
}

// A browser lists no devices. This is the list of those that may be present; each counts as having a sensor until its
// samples show that it has none (platform/pressure.h).
std::vector<PointerDevice> Window::devices() const {
    const auto seen = [&](Tool tool) { return impl_->pointers.seen[static_cast<std::size_t>(tool)]; };
    std::vector<PointerDevice> devices;
    const auto add = [&](int id, const char* name, Tool tool) {
        PointerDevice device{id, name, tool, tool != Tool::mouse};
        device.pressure_max = device.has_pressure ? 1.0 : 0.0;
        devices.push_back(device);
    };
    if (seen(Tool::pen)) add(1, "pen", Tool::pen);
    if (browser::has_touch_screen() || seen(Tool::finger)) add(2, "touch screen", Tool::finger);
    if (seen(Tool::mouse) || devices.empty()) add(0, "mouse", Tool::mouse);
    return devices;
}

bool Window::lists_devices() const { return false; }

std::string Window::input_note() const {
    if (browser::is_secure()) return {};
    return "this page came without https, so that the browser keeps samples between frames from it";
}

void Window::set_title(const std::string& title) { browser::set_title(title.c_str()); }
bool Window::full_screen() const { return browser::full_screen(); }
void Window::set_full_screen(bool full) { browser::set_full_screen(full); }

std::string Window::screen_name() const {
    return "browser, " + std::to_string(browser::screen_long_px()) + " x " + std::to_string(browser::screen_short_px());
}

double Window::touch_px_per_mm() const {
    return browser::has_touch_screen() ? kTouch_css_px_per_mm * browser::px_per_css_px() : kMissing;
}

}  // namespace palpa::platform

namespace {

void append_utf8(int letter, std::string& text) {
    const auto put = [&](int byte) { text += static_cast<char>(byte); };
    if (letter < 0x80) return put(letter);
    if (letter < 0x800) {
        put(0xc0 | letter >> 6);
    } else {
        if (letter < 0x10000) put(0xe0 | letter >> 12);
        if (letter >= 0x10000) put(0xf0 | letter >> 18);
        if (letter >= 0x10000) put(0x80 | (letter >> 12 & 0x3f));
        put(0x80 | (letter >> 6 & 0x3f));
    }
    put(0x80 | (letter & 0x3f));
}

}  // namespace

// The functions that the page calls (platform/web/browser.cpp).
extern "C" {

EMSCRIPTEN_KEEPALIVE void palpa_pointer(int kind, double pointer_id, int tool, double x_css, double y_css,
                                        double pressure, double tilt_x_deg, double tilt_y_deg, double width_css,
                                        double height_css, double time_ms, int buttons) {
    using namespace palpa::platform;
    if (open_pointers == nullptr) return;
    open_pointers->stirred = true;
    const double scale = browser::px_per_css_px();
    BrowserPointer event;
    event.kind = static_cast<BrowserPointer::Kind>(kind);
    event.pointer_id = static_cast<std::int64_t>(pointer_id);
    event.tool = tool == 0 ? Tool::pen : tool == 1 ? Tool::finger : Tool::mouse;
    event.x_px = scale * x_css;
    event.y_px = scale * y_css;
    event.pressure = pressure;
    event.tilt_x_deg = tilt_x_deg;
    event.tilt_y_deg = tilt_y_deg;
    event.width_px = scale * width_css;
    event.height_px = scale * height_css;
    event.time_s = 1e-3 * time_ms;
    event.buttons = buttons;
    receive(event, browser::now_s(), *open_pointers);
}

EMSCRIPTEN_KEEPALIVE void palpa_wheel(double notches, double time_ms) {
    using namespace palpa::platform;
    if (open_pointers == nullptr) return;
    open_pointers->stirred = true;
    receive_wheel(notches, 1e-3 * time_ms, browser::now_s(), *open_pointers);
}

EMSCRIPTEN_KEEPALIVE void palpa_key(int down, int code, int typed, int ctrl, int shift, int repeat) {
    using namespace palpa::platform;
    if (open_pointers == nullptr) return;
    open_pointers->stirred = true;
    WindowEvent event;
    event.kind = down != 0 ? WindowEvent::Kind::key_down : WindowEvent::Kind::key_up;
    event.key = code;
    event.ctrl = ctrl != 0;
    event.shift = shift != 0;
    event.repeat = repeat != 0;
    if (code != 0) receive_key(event, browser::now_s(), *open_pointers);
    // letters that the font has not are kept in answers all the same
    if (down == 0 || typed < ' ' || (typed > '~' && typed < 0xa0) || open_pointers->filter == nullptr) return;
    event.kind = WindowEvent::Kind::text;
    append_utf8(typed, event.text);
    open_pointers->filter(event, open_pointers->filter_user);
}

EMSCRIPTEN_KEEPALIVE void palpa_focus_lost() {
    using namespace palpa::platform;
    if (open_pointers == nullptr) return;
    open_pointers->stirred = true;
    release_all(browser::now_s(), *open_pointers);
}
}
