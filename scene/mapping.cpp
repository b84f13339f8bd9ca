#include "scene/mapping.h"

#include <algorithm>
#include <cmath>

namespace palpa::scene {
namespace {

constexpr double kShareOfScreen = 0.94;  // of the area's width or height, whichever the tissue would fill first

}  // namespace

View make_view(const Mapping& mapping, const TissueArea& area, const ScreenArea& screen) {
    View view;
    view.area = area;
    const Eigen::Vector2d size_px(screen.width_px, screen.height_px);
    view.centre_px = Eigen::Vector2d(screen.x_px, screen.y_px) + 0.5 * size_px;

    Eigen::Matrix2d turn = Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d quarter = (Eigen::Matrix2d() << 0.0, -1.0, 1.0, 0.0).finished();
    for (int deg = 0; deg < mapping.rotate_deg; deg += 90) turn = quarter * turn;
    Eigen::Matrix2d flip = Eigen::Matrix2d::Identity();
    if (mapping.flip) flip(0, 0) = -1.0;
    Eigen::Matrix2d y_down = Eigen::Matrix2d::Identity();
    y_down(1, 1) = -1.0;
    view.axes = y_down * turn * flip;

    const bool on_its_side = mapping.rotate_deg % 180 != 0;
    const Eigen::Vector2d shown_m =
        on_its_side ? Eigen::Vector2d(area.size_m.y(), area.size_m.x()) : Eigen::Vector2d(area.size_m);
    const Eigen::Vector2d fill_px_per_m = size_px.cwiseQuotient(shown_m);
    view.px_per_m = kShareOfScreen * fill_px_per_m.minCoeff();
    if (mapping.kind == MappingKind::direct && mapping.true_size && std::isfinite(screen.px_per_m)) {
        view.px_per_m = std::min(view.px_per_m, screen.px_per_m);
    }
    view.scale = view.px_per_m / screen.px_per_m;
    view.input_px_per_m.setConstant(view.px_per_m);
    if (mapping.kind == MappingKind::indirect) {
        view.input_px_per_m = fill_px_per_m;
    }
    return view;
}

Eigen::Vector2d tissue_of_px(const View& view, const Eigen::Vector2d& px) {
    const Eigen::Vector2d screen_m = (px - view.centre_px).cwiseQuotient(view.input_px_per_m);
    return view.area.centre_m + view.axes.transpose() * screen_m;
}

Eigen::Vector2d px_of_tissue(const View& view, const Eigen::Vector2d& p_m) {
    return view.centre_px + view.px_per_m * (view.axes * (p_m - view.area.centre_m));
}

bool on_tissue(const View& view, const Eigen::Vector2d& p_m) {
    const Eigen::Vector2d off = (p_m - view.area.centre_m).cwiseAbs();
    return off.x() <= 0.5 * view.area.size_m.x() && off.y() <= 0.5 * view.area.size_m.y();
}

ScreenArea input_area(const View& view, const ScreenArea& screen) {
    constexpr double kRoundOff_px = 1e-6;  // at the very edge, round-off would decide whether a place is on the tissue
    const Eigen::Vector2d half_px =
        (view.axes * (0.5 * view.area.size_m)).cwiseAbs().cwiseProduct(view.input_px_per_m) -
        Eigen::Vector2d::Constant(kRoundOff_px);
    const Eigen::Vector2d from_px(screen.x_px, screen.y_px), size_px(screen.width_px, screen.height_px);
    const Eigen::Vector2d low_px = from_px.cwiseMax(view.centre_px - half_px);
    const Eigen::Vector2d extent_px = (from_px + size_px).cwiseMin(view.centre_px + half_px) - low_px;
    return {extent_px.x(), extent_px.y(), low_px.x(), low_px.y(), screen.px_per_m};
}

}  // namespace palpa::scene
