#pragma once
// A browser's Pointer Events, keys and wheel: events come in, samples go out. The code calls no browser, so it can be
// tested.

#include <array>
#include <cstdint>
#include <vector>

#include "platform/keyboard.h"
#include "platform/mouse.h"
#include "platform/press.h"
#include "platform/sample.h"
#include "platform/window_event.h"

namespace palpa::platform {

// One pointer event, as the browser reports it; each coalesced event becomes one of these.
struct BrowserPointer {
    enum class Kind : std::uint8_t { down, move, up, cancel };
    Kind kind = Kind::move;
    std::int64_t pointer_id = 0;
    Tool tool = Tool::mouse;
    double x_px = 0.0;  // in the drawing area
    double y_px = 0.0;
    double pressure = 0.0;  // 0..1
    double tilt_x_deg = 0.0;
    double tilt_y_deg = 0.0;
    double width_px = 0.0;  // contact
    double height_px = 0.0;
    double time_s = 0.0;  // the clock of now_s()
    int buttons = 0;      // bit mask: 1 the tip or the left button, 32 a pen's other end
};

struct Pointers {
    Mouse mouse;
    Keyboard keyboard;
    Presses presses;
    EventFilter filter = nullptr;
    void* filter_user = nullptr;
    std::vector<std::int64_t> touching;   // pens and fingers, by their number in samples
    std::array<bool, kToolCount> seen{};  // tools that have sent an event
    bool stirred = false;                 // an event came since the last poll()
    std::vector<Sample> made;             // scratch
    std::vector<Sample> pending;          // for the next poll()
};

void receive(const BrowserPointer& event, double t_host_s, Pointers& pointers);
void receive_wheel(double notches, double t_device_s, double t_host_s, Pointers& pointers);
void receive_key(const WindowEvent& event, double t_host_s, Pointers& pointers);

// Cancels all presses: the window has lost the focus, or is out of sight.
void release_all(double t_host_s, Pointers& pointers);

// Appends the samples of a mouse button or key that has been held until now.
void hold(double t_host_s, Pointers& pointers);

void forget_presses(Pointers& pointers);  // as Window::end_presses

// As Window::set_keyboard().
void set_keyboard_area(double t_host_s, const KeyboardArea& area, Pointers& pointers);

}  // namespace palpa::platform
