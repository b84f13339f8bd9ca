#include "platform/linux/gl_window.h"

#include <SDL.h>
#include <algorithm>
#include <cstdlib>
#include <signal.h>
#include <stdexcept>

namespace palpa::platform {
namespace {

bool is_set(const char* variable) {
    const char* value = std::getenv(variable);
    return value != nullptr && *value != '\0';
}

// Nothing names a display: SDL need not look, and libwayland need not complain in words of its own.
bool names_no_display() {
    return !is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY") && !is_set("XDG_RUNTIME_DIR") && !is_set("SDL_VIDEODRIVER");
}

std::string no_display_message() {
    const std::string cause =
        is_set("DISPLAY") ? "the X server at DISPLAY=" + std::string(std::getenv("DISPLAY")) + " does not answer"
                          : "DISPLAY is not set";
    return "no display: " + cause + "; palpa run --replay TRACE.tsv --headless works without one";
}

std::string no_gl_message(const std::string& what) {
    return what + " (SDL: " + SDL_GetError() +
           "); Mesa gives OpenGL ES 3 on any machine (Debian: libegl1 libgles2 libgl1-mesa-dri), and palpa run "
           "--headless draws nothing unless asked for a screenshot";
}

extern "C" void pass_on_as_term(int) { ::raise(SIGTERM); }

// A terminal that is closed (SIGHUP) asks to quit as SIGTERM does, which SDL takes: an open trial is then logged as
// interrupted. Under nohup the signal stays ignored.
void end_with_the_terminal() {
    struct sigaction hangup {};
    if (::sigaction(SIGHUP, nullptr, &hangup) != 0 || hangup.sa_handler != SIG_DFL) return;
    hangup.sa_handler = pass_on_as_term;  // SDL's own handler takes SIGINT and SIGTERM alone
    hangup.sa_flags = SA_RESTART;
    ::sigaction(SIGHUP, &hangup, nullptr);
}

void init_video(bool visible) {
    if (visible) {
        if (names_no_display()) throw std::runtime_error(no_display_message());
        // closing the window only asks to quit; signals and the end of the session do quit
        SDL_SetHint(SDL_HINT_QUIT_ON_LAST_WINDOW_CLOSE, "0");
        if (SDL_InitSubSystem(SDL_INIT_VIDEO) != 0) throw std::runtime_error(no_display_message());
        // without a display, SDL falls back to drivers that show nothing
        const std::string driver = SDL_GetCurrentVideoDriver();
        if (driver != "offscreen" && driver != "dummy") return end_with_the_terminal();
        SDL_QuitSubSystem(SDL_INIT_VIDEO);
        throw std::runtime_error(no_display_message());
    }
    const char* before = SDL_GetHint(SDL_HINT_VIDEODRIVER);
    const std::string asked = before != nullptr ? before : "";
    SDL_SetHintWithPriority(SDL_HINT_VIDEODRIVER, "offscreen", SDL_HINT_OVERRIDE);
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");  // nobody asks such a window for events: signals end the program
    const int failed = SDL_InitSubSystem(SDL_INIT_VIDEO);
    SDL_ResetHint(SDL_HINT_NO_SIGNAL_HANDLERS);
    SDL_ResetHint(SDL_HINT_VIDEODRIVER);  // a later window may be a visible one
    if (!asked.empty()) SDL_SetHint(SDL_HINT_VIDEODRIVER, asked.c_str());
    if (failed != 0) throw std::runtime_error(no_gl_message("no off-screen drawing"));
}

void ask_for_es3() {
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK, SDL_GL_CONTEXT_PROFILE_ES);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 3);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MINOR_VERSION, 0);
    SDL_GL_SetAttribute(SDL_GL_DOUBLEBUFFER, 1);
    SDL_GL_SetAttribute(SDL_GL_DEPTH_SIZE, 24);
}

}  // namespace

SizePx fitted(const SizePx& size, const SizePx& room) {
    if (room.width <= 0 || room.height <= 0) return size;
    const auto fits = [&](const SizePx& one) { return one.width <= room.width && one.height <= room.height; };
    const SizePx turned{size.height, size.width};
    if (fits(size)) return size;
    if (fits(turned)) return turned;
    return {std::min(size.width, room.width), std::min(size.height, room.height)};
}

GlWindow::GlWindow(const WindowOptions& options) {
    init_video(options.visible);
    try {
        create(options);
    } catch (...) {
        destroy();
        throw;
    }
}

GlWindow::~GlWindow() { destroy(); }

void GlWindow::create(const WindowOptions& options) {
    ask_for_es3();
    const Uint32 shown = options.visible ? SDL_WINDOW_SHOWN | SDL_WINDOW_RESIZABLE : SDL_WINDOW_HIDDEN;
    SizePx size{options.width_px, options.height_px};
    SDL_Rect room{};
    if (options.visible && options.within_screen && SDL_GetDisplayUsableBounds(0, &room) == 0)
        size = fitted(size, {room.w, room.h});
    window_ = SDL_CreateWindow(options.title.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, size.width,
                               size.height, SDL_WINDOW_OPENGL | SDL_WINDOW_ALLOW_HIGHDPI | shown);
    if (window_ == nullptr) throw std::runtime_error(no_gl_message("no window with OpenGL ES 3"));
    context_ = SDL_GL_CreateContext(window_);
    if (context_ == nullptr) throw std::runtime_error(no_gl_message("no OpenGL ES 3 context"));
    SDL_GL_SetSwapInterval(options.visible ? 1 : 0);  // software drawing refuses this, which does no harm
}

void GlWindow::destroy() {
    if (context_ != nullptr) SDL_GL_DeleteContext(context_);
    if (window_ != nullptr) SDL_DestroyWindow(window_);
    SDL_QuitSubSystem(SDL_INIT_VIDEO);
}

}  // namespace palpa::platform
