// The picture of parts: their silhouettes in the materials' colours, displaced by what presses them.

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "app/screens/part_screen.h"
#include "app/screens/widgets.h"
#include "scene/tissue.h"

namespace palpa::app {
namespace {

using scene::PartDesign;
using scene::PartTissue;
using scene::PartWork;

constexpr int kPatchesAlong = 360;  // of the picture's grid, at most
constexpr int kMergedPatches = 6;   // that one rectangle holds, so that it bends with the part

// The material that is seen from the front, in a line through the part; -1 for none.
int seen_material(const PartDesign& design, int i, int j) {
    const mechanics::Voxels& voxels = design.part.voxels;
    const std::size_t third = 3 - static_cast<std::size_t>(design.slice.view[0] + design.slice.view[1]);
    std::array<int, 3> p{};
    p[static_cast<std::size_t>(design.slice.view[0])] = i;
    p[static_cast<std::size_t>(design.slice.view[1])] = j;
    for (p[third] = 0; p[third] < voxels.size[third]; ++p[third]) {
        const int material = mechanics::material_at(voxels, p[0], p[1], p[2]);
        if (material >= 0) return material;
    }
    return -1;
}

std::vector<PartPatch> patches_of(const PartDesign& design) {
    const mechanics::Voxels& voxels = design.part.voxels;
    const int n_u = voxels.size[static_cast<std::size_t>(design.slice.view[0])];
    const int n_v = voxels.size[static_cast<std::size_t>(design.slice.view[1])];
    const int step = std::max(1, (std::max(n_u, n_v) + kPatchesAlong - 1) / kPatchesAlong);
    const auto h = static_cast<float>(voxels.frame.pitch_m);
    std::vector<PartPatch> out;
    for (int j = 0; j < n_v; j += step) {
        int merged = 0;
        for (int i = 0; i < n_u; i += step) {
            const int material =
                seen_material(design, std::min(i + step / 2, n_u - 1), std::min(j + step / 2, n_v - 1));
            const bool goes_on = merged > 0 && merged < kMergedPatches && out.back().material == material;
            merged = material < 0 ? 0 : goes_on ? merged + 1 : 1;
            if (material < 0) continue;
            const float u1 = h * static_cast<float>(std::min(i + step, n_u));
            if (goes_on) {
                out.back().u1_m = u1;
                continue;
            }
            out.push_back({h * static_cast<float>(i), u1, h * static_cast<float>(j),
                           h * static_cast<float>(std::min(j + step, n_v)), material});
        }
    }
    return out;
}

// A button's cover between cap and rim, as a membrane stands (mechanics/button_cover.h).
double cover_share(const PartDesign& design, double u_m) {
    const mechanics::Button& button = *design.part.button;
    const double middle_m = design.load.at_m[static_cast<std::size_t>(design.slice.view[0])];
    const double r = std::abs(u_m - middle_m);
    const double cap_m = button.cover ? button.cover->cap_radius_m : 0.25 * design.size_m.x();
    const double rim_m = button.cover ? button.cover->radius_m : 0.5 * design.size_m.x();
    if (r <= cap_m) return 1.0;
    if (r >= rim_m) return 0.0;
    const auto root = [](double x) { return std::cbrt(x * x); };
    return (root(rim_m) - root(r)) / (root(rim_m) - root(cap_m));
}

struct PartMotion {
    const PartTissue& tissue;
    const PartWork& work;
    std::size_t design = 0;
    double drawn = 1.0;  // times the true displacement

    // Displacement of a place of the design.
    Eigen::Vector2d at(double u_m, double v_m) const {
        const PartDesign& its = tissue.designs[design];
        const Eigen::Vector2d d(tissue.direction_m[0], tissue.direction_m[1]);
        if (its.button) return work.depth_m[design] * cover_share(its, u_m) * d;  // true: travels are large
        const parts::Response& response = its.responses[work.method];
        const auto moved = parts::field_at(response, work.station[design], u_m, v_m);
        return drawn * work.force_N[design] * Eigen::Vector2d(moved[0], moved[1]);
    }
};

ImU32 shade(const std::string& colour, double strain) {
    const auto value = std::strtoul(colour.c_str() + 1, nullptr, 16);
    const double share = std::clamp(strain, 0.0, 1.0);
    const double yellow[3] = {255.0, 214.0, 90.0};
    int mixed[3];
    for (int c = 0; c < 3; ++c) {
        const auto own = static_cast<double>(value >> (16 - 8 * c) & 0xFFU);
        mixed[c] = static_cast<int>(own + 0.75 * share * (yellow[c] - own));
    }
    return IM_COL32(mixed[0], mixed[1], mixed[2], 255);
}

ImVec2 part_px(const Shown& shown, const Eigen::Vector2d& p_m) {
    const Eigen::Vector2d px = scene::px_of_tissue(shown.state.view, p_m);
    return {static_cast<float>(px.x()), static_cast<float>(px.y())};
}

void draw_design(const Shown& shown, const PartMotion& motion, const std::vector<PartPatch>& patches,
                 ImDrawList& draw) {
    const PartDesign& design = motion.tissue.designs[motion.design];
    const double full_m = std::max(1e-9, motion.drawn * shown.plan.greatest_depth_m);
    draw.PrimReserve(static_cast<int>(6 * patches.size()), static_cast<int>(4 * patches.size()));
    for (const PartPatch& patch : patches) {
        ImVec2 corner[4];
        double moved_m = 0.0;
        for (int c = 0; c < 4; ++c) {
            const auto u = static_cast<double>(c == 1 || c == 2 ? patch.u1_m : patch.u0_m);
            const auto v = static_cast<double>(c >= 2 ? patch.v1_m : patch.v0_m);
            const Eigen::Vector2d d = motion.at(u, v);
            moved_m = std::max(moved_m, d.norm());
            corner[c] = part_px(shown, design.origin_m + Eigen::Vector2d(u, v) + d);
        }
        const PartDesign& its = design;
        const ImU32 colour =
            shade(its.part.materials[static_cast<std::size_t>(patch.material)].colour, moved_m / full_m);
        draw.PrimQuadUV(corner[0], corner[1], corner[2], corner[3], ImGui::GetFontTexUvWhitePixel(),
                        ImGui::GetFontTexUvWhitePixel(), ImGui::GetFontTexUvWhitePixel(),
                        ImGui::GetFontTexUvWhitePixel(), colour);
    }
}

void draw_part_pen(const Shown& shown, const PartTissue& tissue, const PartWork& work, const Gui& gui,
                   ImDrawList& draw) {
    if (!shown.state.touch.down || !work.down) return;
    const PartDesign& design = tissue.designs[work.design];
    const ImVec2 pen = part_px(shown, shown.state.touch.p_m);
    const ImVec2 proxy = part_px(shown, design.origin_m + Eigen::Vector2d(work.proxy_m[0], work.proxy_m[1]));
    const float mm = gui.mm();
    for (const auto& [colour, more] : {std::pair{kDark, 0.5f}, {kLag, 0.0f}}) {
        draw.AddLine(proxy, pen, colour, (0.5f + more) * mm);
        draw.AddCircle(pen, 1.6f * mm, colour, 24, (0.5f + more) * mm);
        draw.AddCircleFilled(proxy, (1.0f + more) * mm, work.touching ? colour : kPale, 24);
    }
    if (shown.avatar.lag_m.norm() > 0.0)
        draw.AddCircle(part_px(shown, shown.avatar.p_m), 2.2f * mm, kInk, 32, 0.4f * mm);
}

void draw_stroke(const Shown& shown, const PartView& view, ImDrawList& draw) {
    const double radius_m = 1e-3 * kToolRadii_mm[static_cast<std::size_t>(view.radius)];
    const auto radius_px = static_cast<float>(radius_m * shown.state.view.px_per_m);
    for (const auto& p : view.stroke_m)
        draw.AddCircleFilled(part_px(shown, {p[0], p[1]}), radius_px, IM_COL32(255, 214, 90, 120), 24);
}

}  // namespace

bool shows_parts(const ToShow& what) { return scene::parts_of(what.plan.tissue) != nullptr; }

void draw_parts(const Shown& shown, const Gui& gui, PartView& view) {
    const PartTissue& tissue = *scene::parts_of(shown.plan.tissue);
    const PartWork& work = *scene::part_work_of(shown.state.tissue);
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    const scene::ScreenArea& area = shown.state.screen;
    const ImVec2 low(static_cast<float>(area.x_px), static_cast<float>(area.y_px));
    const ImVec2 high(low.x + static_cast<float>(area.width_px), low.y + static_cast<float>(area.height_px));
    draw.AddRectFilled(ImVec2(0.0f, 0.0f), ImGui::GetIO().DisplaySize, kDark);  // over the tissue's picture
    draw.PushClipRect(low, high, true);
    for (std::size_t i = 0; i < tissue.designs.size(); ++i) {
        const PartDesign& design = tissue.designs[i];
        if (view.drawn_sha256[i] != design.runs_sha256) {
            view.patches[i] = patches_of(design);
            view.drawn_sha256[i] = design.runs_sha256;
        }
        draw_design(shown, {tissue, work, i, view.magnified ? kMagnified : 1.0}, view.patches[i], draw);
        const ImVec2 at = part_px(shown, design.origin_m + Eigen::Vector2d(0.0, design.size_m.y()));
        const std::string letter = i == 0 ? "a  " : "b  ";
        draw.AddText(ImVec2(at.x, at.y - 1.4f * ImGui::GetFontSize()), i == 0 ? kInk : kLag,
                     (letter + design.part.name).c_str());
    }
    draw_stroke(shown, view, draw);
    draw_part_pen(shown, tissue, work, gui, draw);
    draw.PopClipRect();
}

}  // namespace palpa::app
