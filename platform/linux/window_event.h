#pragma once
// SDL's events as those of platform/window_event.h.

#include <optional>

#include "platform/window_event.h"

union SDL_Event;
struct SDL_Window;

namespace palpa::platform {

struct Scale {
    double x = 1.0;
    double y = 1.0;
};

// SDL counts in window units; on screens of high density the drawing area has more px than that.
Scale px_per_unit(SDL_Window* window);

// Nothing for what no panel is interested in.
std::optional<WindowEvent> window_event(const SDL_Event& event, SDL_Window* window);

}  // namespace palpa::platform
