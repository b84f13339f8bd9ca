#pragma once
// From px on the screen to a position on the tissue, and where the tissue is drawn.
//
// Direct: the tissue lies under the pen; the avatar is drawn where the pen is. Indirect: the whole pad (screen
// area) is stretched over the tissue, which is drawn elsewhere. On the tissue x points to the right and y upwards,
// before rotation (counter-clockwise, as seen) and flip (left and right exchanged, before the rotation).

#include <Eigen/Core>
#include <limits>
#include <optional>

namespace palpa::scene {

enum class MappingKind { direct, indirect };

struct Mapping {
    MappingKind kind = MappingKind::direct;
    int rotate_deg = 0;  // 0, 90, 180, 270: how the tissue is turned on the screen
    bool flip = false;
    std::optional<Eigen::Vector2d> tissue_m;  // width, height; absent: as large as the map
    bool true_size = true;  // direct: as large as it is, where the screen's scale is known and it fits
};

// Where on the screen the tissue may be (the rest belongs to panels), in px of the window.
struct ScreenArea {
    double width_px = 0.0;
    double height_px = 0.0;
    double x_px = 0.0;                                           // of the left edge
    double y_px = 0.0;                                           // of the top edge
    double px_per_m = std::numeric_limits<double>::quiet_NaN();  // of the screen itself; NaN: nobody measured it
};

// The block of tissue in the map's own frame.
struct TissueArea {
    Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d size_m = Eigen::Vector2d::Zero();
};

// Screen px = centre_px + px_per_m * axes * (tissue position - tissue centre), and its inverse for input,
// which has a scale of its own along both screen axes when the mapping is indirect.
struct View {
    TissueArea area;
    Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
    Eigen::Matrix2d axes = Eigen::Matrix2d::Identity();       // orthogonal; screen y points down
    double px_per_m = 1.0;                                    // as drawn
    double scale = std::numeric_limits<double>::quiet_NaN();  // drawn size / true size; NaN: not known
    Eigen::Vector2d input_px_per_m = Eigen::Vector2d::Ones();
};

View make_view(const Mapping& mapping, const TissueArea& area, const ScreenArea& screen);

Eigen::Vector2d tissue_of_px(const View& view, const Eigen::Vector2d& px);   // input
Eigen::Vector2d px_of_tissue(const View& view, const Eigen::Vector2d& p_m);  // drawing
bool on_tissue(const View& view, const Eigen::Vector2d& p_m);

}  // namespace palpa::scene
