#pragma once
// From px on the screen to a position on the tissue, and where the tissue is drawn.
//
// Direct mapping: the tissue lies under the pen, and the avatar is drawn at the pen. Indirect mapping: the whole screen
// area acts as a touchpad that is stretched over the tissue. On the tissue x points to the right and y upwards; it is
// first flipped (left and right exchanged) and then rotated (counter-clockwise as seen).

#include <Eigen/Core>
#include <limits>
#include <optional>

namespace palpa::scene {

enum class MappingKind { direct, indirect };

struct Mapping {
    MappingKind kind = MappingKind::direct;
    int rotate_deg = 0;  // 0, 90, 180, 270: how the tissue is turned on the screen
    bool flip = false;
    bool random_turn = false;                 // the app draws another turn for each trial
    std::optional<Eigen::Vector2d> tissue_m;  // width and height of the tissue; absent: those of the map
    bool true_size = true;  // direct mapping: draws in true size if the screen's scale is known and the tissue fits
};

// The part of the window that the tissue may use, in px; the rest belongs to panels.
struct ScreenArea {
    double width_px = 0.0;
    double height_px = 0.0;
    double x_px = 0.0;                                           // of the left edge
    double y_px = 0.0;                                           // of the top edge
    double px_per_m = std::numeric_limits<double>::quiet_NaN();  // of the screen itself; NaN if nobody measured it
};

// The block of tissue in the map's own frame.
struct TissueArea {
    Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d size_m = Eigen::Vector2d::Zero();
};

// Drawing: screen px = centre_px + px_per_m * axes * (tissue position - tissue centre). Input is the inverse with
// input_px_per_m instead, which differs between the screen's axes when the mapping is indirect.
struct View {
    TissueArea area;
    Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
    Eigen::Matrix2d axes = Eigen::Matrix2d::Identity();        // orthogonal; screen y points down
    double px_per_m = 1.0;                                     // of the drawing
    double scale = std::numeric_limits<double>::quiet_NaN();   // drawn size / true size; NaN if not known
    Eigen::Vector2d input_px_per_m = Eigen::Vector2d::Ones();  // along the screen's x and y
};

View make_view(const Mapping& mapping, const TissueArea& area, const ScreenArea& screen);

Eigen::Vector2d tissue_of_px(const View& view, const Eigen::Vector2d& px);   // input
Eigen::Vector2d px_of_tissue(const View& view, const Eigen::Vector2d& p_m);  // drawing
bool on_tissue(const View& view, const Eigen::Vector2d& p_m);                // inside the area, its edges included

// The part of the screen's area in which input is on the tissue, at every place of it, also at its corners.
ScreenArea input_area(const View& view, const ScreenArea& screen);

}  // namespace palpa::scene
