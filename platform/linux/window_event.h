#pragma once
// Converts SDL's events to those of platform/window_event.h.

#include <optional>

#include "platform/window_event.h"

union SDL_Event;
struct SDL_Window;

namespace palpa::platform {

struct Scale {
    double x = 1.0;
    double y = 1.0;
};

// Returns the scale from SDL's window units to px: on screens of high density the drawing area has more px than window
// units.
Scale px_per_unit(SDL_Window* window);

// Returns nothing for an event that no panel uses.
std::optional<WindowEvent> window_event(const SDL_Event& event, SDL_Window* window);

}  // namespace palpa::platform
