#pragma once
// Reads pens and touch screens by XInput2 on SDL's own connection to the X server.
//
// Supported: pressure, tilt, contact size and sub-pixel positions of every pen ("Abs Pressure") and touch screen ("Abs
// MT Pressure") that the X server knows, including devices plugged in later. Not supported yet: a pen's other buttons,
// its eraser as a tool of its own. Tried on Xorg 21.1 with its inputtest driver.

#include <cstdint>
#include <optional>
#include <vector>

#include "platform/linux/xinput_decode.h"

struct _XDisplay;
struct SDL_Window;
union SDL_Event;

namespace palpa::platform {

struct XInput {
    _XDisplay* display = nullptr;  // SDL's
    unsigned long window = 0;
    int opcode = 0;  // of the extension, in its events
    XiState state;
};

// Returns nothing if the window is not on an X server, or if that server has no XInput2.
std::optional<XInput> open_xinput(SDL_Window* window);

// False on an X server without a window manager, as in a kiosk: nobody there changes a window's size at a program's wish.
bool window_managed(SDL_Window* window);

enum class XiNews : std::uint8_t { none, event, devices_changed };

// Reads an SDL_SYSWMEVENT. It may be called only inside an SDL event watch: X frees the event's data right after the
// watch returns, and `out` points into these data.
XiNews read_event(const XInput& xinput, const SDL_Event& event, XiEvent& out);

// Waits until the X server has sent something, `wait_s` at most. SDL's own waiting is not used: for each event that it
// reads, it sends our window a message through a second connection, and if such a message is still on its way when the
// window is destroyed, an X error ends the program.
void wait_for_server(const XInput& xinput, double wait_s);

// Reads the list of devices and the screen's size again, and selects the events of each pen and mouse itself. Returns
// the ids of the pointers that are gone.
std::vector<std::int64_t> rescan(XInput& xinput);

}  // namespace palpa::platform
