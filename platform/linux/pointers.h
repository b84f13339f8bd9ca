#pragma once
// All pointers of one window: SDL's events come in, samples go out.

#include <optional>
#include <vector>

#include "platform/keyboard.h"
#include "platform/linux/window_event.h"
#include "platform/linux/xinput.h"
#include "platform/mouse.h"
#include "platform/press.h"
#include "platform/sample.h"

union SDL_Event;
struct SDL_Window;

namespace palpa::platform {

struct Pointers {
    SDL_Window* window = nullptr;
    std::optional<XInput> xinput;  // absent: no pressure, and fingers come from SDL
    Mouse mouse;
    Keyboard keyboard;
    Presses presses;
    EventFilter filter = nullptr;
    void* filter_user = nullptr;

    // The tool that moved the common pointer last. A device's own event comes right before the event by which it moves
    // the common pointer, so the device that sent the last one is the device whose mouse event SDL reports.
    Tool mover = Tool::mouse;
    double mover_device_s = kMissing;
    std::optional<bool> finger_on_panel;  // the filter's answer for the touch that is about to begin

    bool close_requested = false;  // by the window's button
    bool quit_requested = false;   // by a signal, or the end of the session
    bool stirred = false;          // an event came since the last poll()
    bool uncovered = false;        // one of these requires the window to be drawn again
    std::vector<Sample> made;      // scratch
    std::vector<Sample> pending;   // for the next poll()
};

// Takes one event; to be called for each event, in order, from an SDL event watch.
void receive(const SDL_Event& event, double t_host_s, Pointers& pointers);

// Appends the samples of a mouse button or key that has been held until now.
void hold(double t_host_s, Pointers& pointers);

void forget_presses(Pointers& pointers);  // as Window::end_presses

// As Window::set_keyboard(). A press in progress when the keyboard is turned off ends with phase cancel.
void set_keyboard_area(double t_host_s, const KeyboardArea& area, Pointers& pointers);

}  // namespace palpa::platform
