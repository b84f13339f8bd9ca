#include "app/screens/part_screen.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/screens/force_bar.h"
#include "app/screens/plot.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"
#include "scene/tissue.h"

namespace palpa::app {
namespace {

using scene::PartDesign;
using scene::PartTissue;
using scene::PartWork;

constexpr std::size_t kMostPoints = 4000;  // of a press that is kept for the curves
constexpr float kBetweenPoints_s = 0.01f;
constexpr float kPlots_mm = 50.0f;  // height of the curves

void draw_press(const Plot& plot, const std::vector<PressPoint>& points, bool over_time, ImU32 colour, float width_px,
                ImDrawList& draw) {
    for (std::size_t i = 1; i < points.size(); ++i) {
        const auto at = [&](const PressPoint& p) {
            return plot.at(static_cast<double>(over_time ? p.t_s : 1e3f * p.travel_m), static_cast<double>(p.force_N));
        };
        draw.AddLine(at(points[i - 1]), at(points[i]), colour, width_px);
    }
}

struct Reach {
    double time_s = 1.0;
    double travel_mm = 0.1;
    double force_N = 0.5;
};

Reach reach_of(const PartView& view) {
    Reach out;
    for (const auto* presses : {&view.press, &view.last}) {
        for (const auto& points : *presses) {
            for (const PressPoint& p : points) {
                out.time_s = std::max(out.time_s, static_cast<double>(p.t_s));
                out.travel_mm = std::max(out.travel_mm, 1.05e3 * static_cast<double>(p.travel_m));
                out.force_N = std::max(out.force_N, 1.05 * static_cast<double>(p.force_N));
            }
        }
    }
    return out;
}

void draw_curves(const Shown& shown, const Layout& layout, const PartView& view, Gui& gui) {
    const PanelArea& t = layout.tissue_px;
    const float mm = gui.mm();
    const float height_px = std::min(kPlots_mm * mm, 0.4f * t.height());
    begin_panel("curves", {t.x0, t.y1 - height_px, t.x1, t.y1}, gui, 0.9f);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const Reach reach = reach_of(view);
    for (const bool over_time : {true, false}) {
        const float x0 = over_time ? t.x0 : 0.5f * (t.x0 + t.x1);
        const PanelArea whole{x0 + 2.0f * mm, t.y1 - height_px + mm, x0 + 0.5f * t.width() - 2.0f * mm, t.y1 - mm};
        const Plot plot{data_area(whole, mm), 0.0, over_time ? reach.time_s : reach.travel_mm, 0.0, reach.force_N};
        draw_plot_axes(plot,
                       {over_time ? words::kForceOverTime : words::kForceOverTravel,
                        over_time ? words::kSeconds : words::kMillimetres, words::kNewtons},
                       mm, draw);
        const std::size_t designs = scene::parts_of(shown.plan.tissue)->designs.size();
        for (std::size_t i = 0; i < designs; ++i) {
            const ImU32 colour = i == 0 ? kInk : kLag;
            const ImU32 faded = (colour & ~IM_COL32_A_MASK) | (110U << IM_COL32_A_SHIFT);
            draw_press(plot, view.last[i], over_time, faded, 0.3f * mm, draw);
            draw_press(plot, view.press[i], over_time, colour, 0.6f * mm, draw);
        }
    }
    end_panel("curves", gui);
}

// Force, displacement and stiffness of each design, side by side.
void draw_design_numbers(const Shown& shown, const PartTissue& tissue, const PartWork& work) {
    for (std::size_t i = 0; i < tissue.designs.size(); ++i) {
        const PartDesign& design = tissue.designs[i];
        ImGui::PushStyleColor(ImGuiCol_Text, i == 0 ? kInk : kLag);
        ImGui::Text("%s  %s N", i == 0 ? "a" : "b", fixed(work.force_N[i], 2).c_str());
        // the mark of a warning, which stands below
        ImGui::Text("   %s mm%s", fixed(1e3 * work.depth_m[i], 2).c_str(),
                    scene::doubt_of(tissue, work, i) ? " !" : "");
        ImGui::PopStyleColor();
        if (design.button) paragraph(work.button[i].on ? words::kButtonOn : words::kButtonOff);
    }
    const bool air = shown.state.pointer && !work.touching;  // also beyond the plane, where a touch is none
    ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1.0f, 0.84f, 0.35f, 1.0f));
    wrapped_text(air ? words::kPressesAir : "");
    ImGui::PopStyleColor();
}

// Stiffness by every method at the named load, its difference to the finite cells, and where it stands.
void draw_methods(const PartTissue& tissue, const PartWork& work) {
    if (tissue.methods.empty()) return;
    for (std::size_t m = 0; m < tissue.methods.size(); ++m) {
        std::string line = std::string(m == work.method ? "> " : "  ") + parts::name_of(tissue.methods[m]);
        for (const PartDesign& design : tissue.designs) {
            const auto stiffness = [&](std::size_t k) {
                const parts::Response& response = design.responses[k];
                return 1e-3 / response.compliance_m_per_N[response.named];
            };
            line += (&design == tissue.designs.data() ? ": " : "; ") + fixed(stiffness(m), 2);
            const bool cells = tissue.methods.back() == parts::Method::voxels;
            if (cells && m + 1 < tissue.methods.size())  // figure and percentage stay together
                line += "\u00a0(" + fixed(100.0 * (stiffness(m) / stiffness(tissue.methods.size() - 1) - 1.0), 0) +
                        "\u00a0%)";
        }
        wrapped_text(line + "\u00a0N/mm");
    }
}

// Why what the chosen method says of each design is not to be trusted.
void draw_doubts(const PartTissue& tissue, const PartWork& work) {
    for (std::size_t i = 0; i < tissue.designs.size(); ++i) {
        const std::optional<scene::PartDoubt> doubt = scene::doubt_of(tissue, work, i);
        if (!doubt) continue;
        const char* method = parts::name_of(tissue.methods[work.method]);
        const char* design = i == 0 ? "a" : "b";
        const std::string why(doubt->why_not);
        warning_paragraph(doubt->to_m > 0.0 ? words::filled(words::kMethodAppliesTo,
                                                            {design, method, fixed(1e3 * doubt->to_m, 2), why})
                                            : words::filled(words::kMethodNeverApplies, {design, method, why}));
    }
}

void next_radius(PartView& view) { view.radius = (view.radius + 1) % static_cast<int>(kToolRadii_mm.size()); }

void next_material(const PartTissue& tissue, PartView& view) {
    view.material = (view.material + 1) % materials_of(tissue).size();
}

void draw_tools(const PartTissue& tissue, const Gui& gui, PartView& view) {
    constexpr const char* kTools[] = {words::kToolPress, words::kToolSculpt, words::kToolPermute};
    constexpr const char* kHints[] = {words::kHintToolPress, words::kHintToolSculpt, words::kHintToolPermute};
    constexpr const char* kKeys[] = {"1", "2", "3"};
    const float width_px = share_of_line_px(3);
    for (int i = 0; i < 3; ++i) {
        if (i > 0) ImGui::SameLine();
        const auto tool = static_cast<PartTool>(i);
        if (big_button(kTools[i], kKeys[i], {width_px, kTarget_mm, true, view.tool == tool, kHints[i]}, gui))
            view.tool = tool;
    }
    if (view.tool == PartTool::press) return;
    const std::vector<std::string> materials = materials_of(tissue);
    const bool permutes = view.tool == PartTool::permute;
    const float half_px = share_of_line_px(permutes ? 2 : 1);
    const std::string radius =
        words::filled(words::kToolRadius, {fixed(kToolRadii_mm[static_cast<std::size_t>(view.radius)], 1)}) +
        "###radius";
    if (big_button(radius.c_str(), words::kKeyRadius, {half_px, kTarget_mm, true, false}, gui)) next_radius(view);
    if (!permutes) return;
    ImGui::SameLine();
    view.material = std::min(view.material, materials.size() - 1);
    const std::string material = materials[view.material] + "###material";
    const ButtonLook look{half_px, kTarget_mm, true, false, words::kHintMaterial};
    if (big_button(material.c_str(), words::kKeyMaterial, look, gui)) next_material(tissue, view);
}

// The design that a place on the plane belongs to.
std::size_t design_at(const PartTissue& tissue, double y_m) {
    if (tissue.designs.size() < 2) return 0;
    const auto far = [&](const PartDesign& d) { return std::abs(y_m - d.origin_m.y() - 0.5 * d.size_m.y()); };
    return far(tissue.designs[1]) < far(tissue.designs[0]) ? 1 : 0;
}

PartWish edit_of(const PartTissue& tissue, const PartView& view) {
    PartWish out;
    out.kind = PartWish::Kind::edit;
    out.tool = view.tool;
    out.design = design_at(tissue, view.stroke_m.front()[1]);
    const Eigen::Vector2d& origin = tissue.designs[out.design].origin_m;
    for (const auto& p : view.stroke_m) out.path_m.push_back({p[0] - origin.x(), p[1] - origin.y()});
    out.radius_m = 1e-3 * kToolRadii_mm[static_cast<std::size_t>(view.radius)];
    const std::vector<std::string> materials = materials_of(tissue);
    out.material = materials[std::min(view.material, materials.size() - 1)];
    return out;
}

// Goes on with a stroke in steps of at most `apart_m`: frames may be slow, and the part is cut without gaps all the same.
void draw_stroke_to(const Eigen::Vector2d& p_m, double apart_m, std::vector<std::array<double, 2>>& stroke_m) {
    constexpr std::size_t kMostStroke = 2000;
    const Eigen::Vector2d from_m = stroke_m.empty() ? p_m : Eigen::Vector2d(stroke_m.back()[0], stroke_m.back()[1]);
    if (stroke_m.empty()) stroke_m.push_back({p_m.x(), p_m.y()});
    const auto steps = static_cast<int>(std::floor((p_m - from_m).norm() / apart_m));
    for (int i = 1; i <= steps && stroke_m.size() < kMostStroke; ++i) {
        const Eigen::Vector2d at_m = from_m + (p_m - from_m) * i / steps;
        stroke_m.push_back({at_m.x(), at_m.y()});
    }
}

// While a tool is chosen that changes the part, the pen draws a stroke instead of pressing; the edit follows its end.
void take_stroke(const Shown& shown, const Layout& layout, Gui& gui, PartView& view, Wishes& wishes) {
    if (view.tool == PartTool::press) return;
    const PanelArea& t = layout.tissue_px;
    const PanelArea area{t.x0, t.y0, t.x1, t.y1 - std::min(kPlots_mm * gui.mm(), 0.4f * t.height())};
    gui.claim(area);
    const ImGuiIO& io = ImGui::GetIO();
    const bool inside = area.holds(io.MousePos.x, io.MousePos.y);
    // A pen that comes straight from a button finds that one still hovered in the frame of its touch: then it begins in the next.
    const bool on_item = ImGui::IsAnyItemHovered() || ImGui::IsAnyItemActive();
    const bool begins = io.MouseDown[0] && area.holds(io.MouseClickedPos[0].x, io.MouseClickedPos[0].y) && !on_item;
    if ((begins || !view.stroke_m.empty()) && inside) {  // also where the pen was lifted
        const Eigen::Vector2d p_m = scene::tissue_of_px(
            shown.state.view, {static_cast<double>(io.MousePos.x), static_cast<double>(io.MousePos.y)});
        draw_stroke_to(p_m, 0.5e-3 * kToolRadii_mm[static_cast<std::size_t>(view.radius)], view.stroke_m);
    }
    if (io.MouseDown[0] || view.stroke_m.empty()) return;
    wishes.part = edit_of(*scene::parts_of(shown.plan.tissue), view);
    view.stroke_m.clear();
}

PartWish wish_of(PartWish::Kind kind) {
    PartWish wish;
    wish.kind = kind;
    return wish;
}

// In a browser a person takes the changed designs away as files.
void draw_saves(const Gui& gui, const PartView& view, Wishes& wishes) {
    for (std::size_t i = 0; view.in_browser && i < view.kept.size(); ++i) {
        const std::string label = words::filled(words::kSaveDesign, {i == 0 ? "a" : "b"});
        if (view.kept[i].empty() ||
            !big_button(label.c_str(), "", {0.0f, kTarget_mm, true, false, words::kHintSaveDesign}, gui))
            continue;
        wishes.part = wish_of(PartWish::Kind::offer);
        wishes.part->design = i;
    }
}

void draw_part_buttons(const Shown& shown, const PartTissue& tissue, const Gui& gui, PartView& view, Wishes& wishes) {
    draw_tools(tissue, gui, view);
    const float width_px = share_of_line_px(3);
    const bool undoes = view.edits[0] + view.edits[1] > 0;
    if (big_button(words::kUndo, words::kKeyUndo, {width_px, kTarget_mm, undoes, false, words::kHintUndoEdit}, gui))
        wishes.part = wish_of(PartWish::Kind::undo);
    ImGui::SameLine();
    if (big_button(words::kRedo, words::kKeyRedo, {width_px, kTarget_mm, view.undone > 0, false, words::kHintRedoEdit},
                   gui))
        wishes.part = wish_of(PartWish::Kind::redo);
    ImGui::SameLine();
    if (big_button(words::kMagnify, words::kKeyMagnify,
                   {width_px, kTarget_mm, true, view.magnified, words::kHintMagnify}, gui))
        view.magnified = !view.magnified;
    const bool changes = tissue.methods.size() > 1 && !shown.state.touch.down;
    if (!tissue.methods.empty() &&
        big_button(words::kNextMethod, words::kKeyMethod, {0.0f, kTarget_mm, changes, false, words::kHintMethod}, gui))
        wishes.action = platform::Action::method;
    // what comes and goes stands last, so that no button moves under the pen
    const ButtonLook look{0.0f, kTarget_mm, true, false, words::kHintEarlierEdits};
    if (view.earlier && big_button(words::kEarlierEdits, words::kKeyEarlier, look, gui))
        wishes.part = wish_of(PartWish::Kind::earlier);
    draw_saves(gui, view, wishes);
}

void draw_part_header(const Shown& shown, const Gui& gui, ViewState& view, Wishes& wishes) {
    const bool* has_menu = menu_of(shown.doing);
    const bool menu = has_menu != nullptr && *has_menu;
    if (big_button(menu ? words::kClose : words::kMenu, "", {20.0f * gui.mm(), kTarget_mm, true, menu}, gui))
        wishes.menu = !menu;
    ImGui::SameLine();
    if (icon_button(Icon::question, words::kHintHelp, gui)) view.help = true;
    one_line(shown.scene.name);
}

// Where the changed designs are.
void draw_kept(const PartView& view) {
    if (view.kept[0].empty() && view.kept[1].empty()) return;
    if (view.in_browser && view.unstored) return warning_paragraph(words::kDesignNotKept);
    if (view.in_browser) return paragraph(words::kDesignKeptHere);
    for (const auto& file : view.kept) {
        if (file.empty()) continue;
        paragraph(words::filled(words::kDesignKept, {file.filename().string(), file.parent_path().string()}));
    }
}

void draw_part_notes(const Shown& shown, const Gui& gui, const PartView& view, Wishes& wishes) {
    draw_problems(shown, gui, wishes);
    if (view.pending) paragraph(words::filled(words::kCellsPending, {fixed(100.0 * *view.pending, 0)}));
    if (!shown.notices.note.empty()) paragraph(shown.notices.note);
    draw_kept(view);
    const auto& designs = scene::parts_of(shown.plan.tissue)->designs;
    const auto buttons =
        std::count_if(designs.begin(), designs.end(), [](const auto& d) { return d.button.has_value(); });
    if (buttons > 0) paragraph(words::kSimulatedButtons);
    if (static_cast<std::size_t>(buttons) < designs.size()) paragraph(words::kSimulatedParts);
}

}  // namespace

std::vector<std::string> materials_of(const PartTissue& tissue) {
    std::vector<std::string> names;
    for (const PartDesign& design : tissue.designs) {
        for (const parts::PartMaterial& material : design.part.materials) {
            if (std::find(names.begin(), names.end(), material.name) == names.end()) names.push_back(material.name);
        }
    }
    return names;
}

void note_press(const scene::State& state, double now_s, PartView& view) {
    const PartWork* work = scene::part_work_of(state.tissue);
    const bool down = work != nullptr && state.touch.down && work->touching;
    const bool begins = down && !view.was_down;
    view.was_down = down;
    if (begins) {
        view.began_s = now_s;
        view.last = std::exchange(view.press, {});
    }
    const auto t_s = static_cast<float>(now_s - view.began_s);
    const std::vector<PressPoint>& points = view.press[0];
    if (!down || points.size() >= kMostPoints) return;
    if (!points.empty() && t_s < points.back().t_s + kBetweenPoints_s) return;
    for (std::size_t i = 0; i < view.press.size(); ++i)
        view.press[i].push_back({t_s, static_cast<float>(work->force_N[i]), static_cast<float>(work->depth_m[i])});
}

void draw_part_panel(const Shown& shown, const Layout& layout, Gui& gui, ViewState& view, Wishes& wishes) {
    const PartTissue& tissue = *scene::parts_of(shown.plan.tissue);
    const PartWork& work = *scene::part_work_of(shown.state.tissue);
    note_press(shown.state, shown.now_s, view.part);
    if (!layout.controls) {
        draw_too_small();
        return;
    }
    draw_curves(shown, layout, view.part, gui);
    take_stroke(shown, layout, gui, view.part, wishes);
    begin_panel("parts", layout.controls_px, gui);
    const float half_px = layout.column ? 0.0f : 0.5f * ImGui::GetContentRegionAvail().x;
    ImGui::BeginChild("numbers", ImVec2(half_px, layout.column ? 52.0f * gui.mm() : 0.0f), false,
                      ImGuiWindowFlags_NavFlattened);
    draw_part_header(shown, gui, view, wishes);
    const float left_px = ImGui::GetCursorPosX();
    draw_force_bar(shown, 30.0f * gui.mm(), gui);
    ImGui::SameLine();
    const float bar_px = 10.0f * gui.mm() + ImGui::CalcTextSize(words::kMedium).x;  // with the names of its zones
    ImGui::SetCursorPosX(left_px + std::max(24.0f * gui.mm(), bar_px + 2.0f * gui.mm()));
    ImGui::BeginGroup();
    draw_design_numbers(shown, tissue, work);
    ImGui::EndGroup();
    ImGui::EndChild();
    if (!layout.column) ImGui::SameLine();
    ImGui::BeginChild("tools", ImVec2(0.0f, 0.0f), false, ImGuiWindowFlags_NavFlattened);
    draw_part_buttons(shown, tissue, gui, view.part, wishes);
    draw_methods(tissue, work);
    draw_doubts(tissue, work);
    draw_part_notes(shown, gui, view.part, wishes);
    ImGui::EndChild();
    end_panel("parts", gui);
}

void part_keys(const Shown& shown, const Gui& gui, PartView& view, Wishes& wishes) {
    if (gui.pressed('h')) wishes.press_by_hold = true;
    if (gui.pressed('j') && !shown.state.touch.down) wishes.action = platform::Action::method;
    if (gui.pressed('u') || gui.pressed('z', true)) wishes.part = wish_of(PartWish::Kind::undo);
    if (gui.pressed('y', true)) wishes.part = wish_of(PartWish::Kind::redo);
    for (int i = 0; i < 3; ++i) {
        if (gui.pressed('1' + i)) view.tool = static_cast<PartTool>(i);
    }
    if (gui.pressed('5')) view.magnified = !view.magnified;
    if (gui.pressed('k') && view.tool != PartTool::press) next_radius(view);
    if (gui.pressed('l') && view.tool == PartTool::permute) next_material(*scene::parts_of(shown.plan.tissue), view);
    if (gui.pressed('o') && view.earlier) wishes.part = wish_of(PartWish::Kind::earlier);
}

}  // namespace palpa::app
