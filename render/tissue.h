#pragma once
// The tissue's surface with its dent, and the indenter: plain numbers in, pixels out.

#include <array>
#include <memory>

namespace palpa {

inline constexpr int kSinkPoints = 64;

// Where and how the tissue is drawn. Positions on the tissue are in metres, x and y in the map's frame, z
// upwards from the undisturbed surface.
//   screen px (y down) = centre_px + px_per_m * axes * (p - centre_m), then tilted about the screen's x axis
struct TissueView {
    float width_px = 1.0f;  // of the drawing area
    float height_px = 1.0f;
    float centre_px[2] = {0.0f, 0.0f};
    float centre_m[2] = {0.0f, 0.0f};
    float size_m[2] = {0.1f, 0.1f};
    float axes[4] = {1.0f, 0.0f, 0.0f, 1.0f};  // row by row
    float px_per_m = 1.0f;
    float tilt_rad = 0.0f;  // 0: from straight above
};

// Dent around (x, y): sink at r_i = reach (i / 63)^2, metres downwards; reach 0: no dent.
struct Dent {
    float centre_m[2] = {0.0f, 0.0f};
    float reach_m = 0.0f;
    std::array<float, kSinkPoints> sink_m{};
};

struct Ball {
    float centre_m[2] = {0.0f, 0.0f};
    float height_m = 0.0f;  // of its centre above the undisturbed surface
    float radius_m = 0.0f;  // 0: not drawn
    float opacity = 1.0f;
};

class TissueDrawer {
 public:
    TissueDrawer();  // needs a current context; throws std::runtime_error
    ~TissueDrawer();
    TissueDrawer(const TissueDrawer&) = delete;
    TissueDrawer& operator=(const TissueDrawer&) = delete;

    // Clears the drawing area and draws.
    void draw(const TissueView& view, const Dent& dent, const Ball& ball);

 private:
    struct Gpu;
    std::unique_ptr<Gpu> gpu_;
};

// Where a point lands on the screen, the same as in the shader; for marks drawn on top.
void project_px(const TissueView& view, float x_m, float y_m, float z_m, float& x_px, float& y_px);

}  // namespace palpa
