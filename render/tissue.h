#pragma once
// Draws the surface of the tissue, displaced as it is, and the indenter that presses into it.

#include <array>
#include <cstdint>
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

namespace palpa::render {

inline constexpr int kSinkPoints = 64;

// Where and how the tissue is drawn. Positions on the tissue are in metres, x and y in the map's frame, z upwards from
// the undisturbed surface.
//   seen      = eye_m + (p - eye_m) / (1 - z * eye_per_m)
//   screen px (y down) = centre_px + px_per_m * axes * (seen - centre_m), then tilted about the screen's x axis
// Whatever lies on the undisturbed surface (z = 0), or straight below the eye at any depth, stays where it is.
struct TissueView {
    glm::vec2 area_px{1.0f};  // width and height of the drawing area
    glm::vec2 centre_px{0.0f};
    glm::vec2 centre_m{0.0f};
    glm::vec2 size_m{0.1f};
    glm::mat2 axes{1.0f};
    float px_per_m = 1.0f;
    float tilt_rad = 0.0f;       // 0 looks straight down
    glm::vec2 eye_m{0.0f};       // the place that the eye is straight above
    float eye_per_m = 0.0f;      // 1 / height of the eye; 0: all lines of sight are parallel
    float thickness_m = 25e-3f;  // of the block, whose sides show where it is tilted
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

// What the contact does to the look of the surface around it.
struct Grip {
    glm::vec2 centre_m{0.0f};
    float contact_radius_m = 0.0f;  // 0: nothing touches
    float depth_m = 0.0f;
    float pull = 0.0f;         // share of the contact radius by which the tissue is drawn in at the contact's edge
    float pressure = 0.0f;     // 0 ... 1 of the force bar: blanching
    float crease = 0.0f;       // 0 ... 1: darkness of the crease at the contact's edge
    float footprint_m = 0.0f;  // radius of a ring on the surface; 0: none
};

enum class IndenterKind : std::uint32_t { ball, probe, fingertip };

struct Indenter {
    IndenterKind kind = IndenterKind::ball;
    glm::vec2 centre_m{0.0f};
    float height_m = 0.0f;  // height of the centre above the undisturbed surface
    float radius_m = 0.0f;  // 0 if no indenter is drawn
    float opacity = 1.0f;
    float covered = 0.0f;  // share of the radius that the tissue closes over, as seen from above
    float hand_x = 1.0f;   // -1: the hand comes from the left
};

enum class Material : std::uint32_t { skin, silicone };

// All that a picture of the tissue shows.
struct TissuePicture {
    TissueView view;
    Dent dent;
    Relief relief;
    Grip grip;
    Indenter indenter;
    Material material = Material::skin;
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
    void draw(const TissuePicture& picture, bool as_before);

  private:
    struct Gpu;
    std::unique_ptr<Gpu> gpu_;
};

// Returns where a point lands on the screen, by the formula of the shader.
glm::vec2 project_px(const TissueView& view, const glm::vec3& p_m);

// Returns where a point of the undisturbed surface is while the indenter presses, by the formula of the shader: moved
// down by the sink, and towards the contact by the grip's pull.
glm::vec3 displaced_m(const TissuePicture& picture, const glm::vec2& p_m);

// Returns where a point of the texture is while a finger drags the texture along, by the formula of the shader.
glm::vec2 dragged_m(const TissueView& view, const glm::vec2& p_m);

}  // namespace palpa::render
