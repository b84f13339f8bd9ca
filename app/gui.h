#pragma once
// Dear ImGui on a Window: set up, fed with events, drawn. The panels themselves are in panels.h.

#include <vector>

#include "platform/window.h"

struct ImDrawList;

namespace palpa {

// A rectangle of the screen that belongs to a panel: presses in it reach no tissue.
struct PanelArea {
    float x0 = 0.0f, y0 = 0.0f, x1 = 0.0f, y1 = 0.0f;
};

class Gui {
 public:
    explicit Gui(Window& window);  // also becomes the window's event filter
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    void begin_frame(double dt_s);
    void end_frame();  // closes the panels
    void draw();       // hands them to GL
    void claim(const PanelArea& area) { areas_.push_back(area); }
    float scale() const { return scale_; }

 private:
    static bool filter(const SDL_Event& event, void* self);
    bool owns(float x_px, float y_px) const;

    Window& window_;
    std::vector<PanelArea> areas_;  // of the frame before
    float scale_ = 1.0f;
};

}  // namespace palpa
