#pragma once
// A window with an OpenGL ES 3 context, and the pens, fingers and mice that move over it.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "platform/pressure.h"
#include "platform/sample.h"
#include "platform/window_event.h"

struct SDL_Window;

namespace palpa::platform {

struct WindowOptions {
    std::string title = "Palpa";
    int width_px = 1280;
    int height_px = 800;
    bool within_screen = false;  // true: a size that the screen has no room for is fitted to it
    bool visible = true;         // false: an off-screen context that needs no display
    double mouse_hold_s = 2.0;   // how long the mouse button or the Space key is held for full pressure
};

// Returns a size of a window that a screen has room for: as it is if it fits, turned upright or lengthwise if it fits so,
// else cut. A room of 0 is not known and takes any size.
struct SizePx {
    int width = 0;
    int height = 0;
    bool operator==(const SizePx&) const = default;
};
SizePx fitted(const SizePx& size, const SizePx& room);

// What a pointing device reports, for messages to the person ("this pen has no pressure sensor").
struct PointerDevice {
    int id = 0;
    std::string name;
    Tool tool = Tool::pen;
    bool has_pressure = false;
    double pressure_min = 0.0;  // counts
    double pressure_max = 0.0;  // counts
    std::int64_t levels = 0;    // number of counts from pressure_min to pressure_max; 0 without pressure
    bool has_tilt = false;
    bool has_contact_size = false;
    std::vector<std::string> axes{};  // names as the driver gives them
};

// One window. Its constructor throws std::runtime_error with a message for people if there is no display or no OpenGL
// ES 3.
class Window {
  public:
    explicit Window(const WindowOptions& options);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    // Appends all samples that arrived since the last call, oldest first; no two are merged. Waits for input up to
    // `wait_s` seconds (0: not at all). Positions are in px of the drawing area. A press in progress when the window
    // loses the focus ends with phase cancel. t_device_s is one clock for all tools (on X11 the server's, in whole ms).
    // It is missing if no device sent the sample: while a mouse button is held still (a sample each 1/240 s), and for a
    // cancel.
    void poll(double wait_s, std::vector<Sample>& out);

    // Sets a filter that is called with every event as it arrives, before it becomes a sample (Dear ImGui listens
    // here). If it returns true for button_down or finger_down, that whole press belongs to a panel and none of its
    // samples come out of poll(). The filter should judge by the position in the event, since the pointer may not have
    // been there before. If it returns true for wheel, the wheel sets no pressure. A pen's press comes as button_down
    // too.
    void set_event_filter(EventFilter filter, void* user);

    // Sets the area (px of the drawing area) and the speed of a pointer that keys move. An empty area turns the pointer
    // off, as it is at the start. Arrows move it, slower with Shift; Space presses harder the longer it is held; Page
    // Up and Page Down set how hard. The pointer starts in the middle of the area; to be called again when the area
    // changes. It takes only keys for whose key_down the event filter returned false. While one of its keys is held, a
    // sample comes each 1/240 s.
    void set_keyboard(double x0_px, double y0_px, double x1_px, double y1_px, double speed_px_per_s);

    // What the pens and fingers have sent so far, in presses on panels too.
    const PressureWatch& pressure() const;

    // True if the last poll() met any event: a sample, or anything else that may change the look of panels.
    bool stirred() const;
    // True if the last poll() met a reason to draw an unchanged frame again: the window was uncovered, sized or shown.
    bool uncovered() const;

    // Ends all presses without a sample: their later samples, up to the lift, are dropped, and so are the samples that
    // poll() has not returned yet.
    void end_presses();

    bool hidden() const;  // minimised, or taken from the screen otherwise; never in a browser, whose page knows it
    bool close_requested() const;
    // Forgets that the person asked to close the window. Returns false if the system itself ends the program, which
    // cannot be refused.
    bool stay_open();
    void present();        // shows what was drawn
    double now_s() const;  // steady clock; the same as t_host_s
    int width_px() const;  // drawing area
    int height_px() const;
    double keyboard_x_px() const;  // position of the cursor that keys move
    double keyboard_y_px() const;
    double mouse_pressure() const;  // present pressure of the mouse (by wheel or hold), or the level of its wheel
    std::vector<PointerDevice> devices() const;
    bool lists_devices() const;      // false in a browser, where only devices that sent something are known
    std::string input_note() const;  // why pens and fingers have no pressure here, for people; or empty
    void set_title(const std::string& title);
    bool full_screen() const;
    void set_full_screen(bool full);
    std::string screen_name() const;  // of the screen that shows the window, with its size
    // Returns px per millimetre of a touch screen, as far as the system knows it; NaN if unknown, as on a desktop.
    double touch_px_per_mm() const;
    SDL_Window* sdl() const;  // desktop only

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace palpa::platform
