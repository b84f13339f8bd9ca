#pragma once
// An SDL window and its OpenGL ES 3.0 context.

#include "platform/window.h"

namespace palpa::platform {

// Owns SDL's video part, the window and the context. Throws std::runtime_error with a message for people.
class GlWindow {
  public:
    explicit GlWindow(const WindowOptions& options);
    ~GlWindow();
    GlWindow(const GlWindow&) = delete;
    GlWindow& operator=(const GlWindow&) = delete;

    SDL_Window* sdl() const { return window_; }

  private:
    void create(const WindowOptions& options);
    void destroy();

    SDL_Window* window_ = nullptr;
    void* context_ = nullptr;
};

}  // namespace palpa::platform
