#pragma once
// Draws the surface of the tissue with its dent, and the indenter.

#include <array>
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

namespace palpa::render {

inline constexpr int kSinkPoints = 64;

// Where and how the tissue is drawn. Positions on the tissue are in metres, x and y in the map's frame, z
// upwards from the undisturbed surface.
//   screen px (y down) = centre_px + px_per_m * axes * (p - centre_m), then tilted about the screen's x axis
struct TissueView {
    glm::vec2 area_px{1.0f};  // width and height of the drawing area
    glm::vec2 centre_px{0.0f};
    glm::vec2 centre_m{0.0f};
    glm::vec2 size_m{0.1f};
    glm::mat2 axes{1.0f};
    float px_per_m = 1.0f;
    float tilt_rad = 0.0f;  // 0 looks straight down
    // The texture is dragged along with a finger at drag_at_m by drag_m, and less and less farther away.
    glm::vec2 drag_at_m{0.0f};
    glm::vec2 drag_m{0.0f};
};

// Dent around (x, y): the sink at r_i = reach (i / 63)^2, in metres downwards. Without a dent, reach is 0.
struct Dent {
    glm::vec2 centre_m{0.0f};
    float reach_m = 0.0f;
    std::array<float, kSinkPoints> sink_m{};
};

// Sink of the whole surface, instead of a dent: n_x * n_y values on a grid over the area of the view, x fastest.
struct Relief {
    int n_x = 0;  // 0 without a relief
    int n_y = 0;
    std::vector<float> sink_m;
    glm::vec2 shift_m{0.0f};  // the relief is drawn moved by this, since the avatar lags
};

struct Ball {
    glm::vec2 centre_m{0.0f};
    float height_m = 0.0f;  // height of the centre above the undisturbed surface
    float radius_m = 0.0f;  // 0 if no indenter is drawn
    float opacity = 1.0f;
};

class TissueDrawer {
  public:
    TissueDrawer();  // needs a current context; throws std::runtime_error
    ~TissueDrawer();
    TissueDrawer(const TissueDrawer&) = delete;
    TissueDrawer& operator=(const TissueDrawer&) = delete;

    // Clears the drawing area and draws. `as_before`: all of it is what the last call got. A copy of what was drawn is
    // then shown, which costs a fraction of the shaders; with software drawing they are nearly all that an idle app
    // computes, since its clock changes every second.
    void draw(const TissueView& view, const Dent& dent, const Relief& relief, const Ball& ball, bool as_before);

  private:
    struct Gpu;
    std::unique_ptr<Gpu> gpu_;
};

// Returns the vertices of the drawn surface, (cells + 1)^2 of (sink, d sink/dx, d sink/dy), by Catmull-Rom interpolation
// that continues the values at the border. Needs relief.n_x and n_y >= 2.
void refine(const Relief& relief, const glm::vec2& size_m, int cells, std::vector<float>& out);

// Returns where a point lands on the screen, by the formula of the shader, for marks that are drawn on top.
glm::vec2 project_px(const TissueView& view, const glm::vec3& p_m);

}  // namespace palpa::render
