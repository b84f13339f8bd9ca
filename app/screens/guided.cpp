// The guided start: five steps on a practice trial, then what the result means.

#include <algorithm>
#include <cmath>

#include "app/screens/screens.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"

namespace palpa::app {
namespace {

constexpr int kGuidedSteps = 6;
constexpr float kGuidedText = 1.2f;  // size beside that of other text
constexpr double kNear_m = 8e-3;
constexpr double kEnough = 1.0 / 6.0;  // of the known depth: a press that shows on the picture

bool pressed_near(const scene::Plan& plan, const session::Trial& trial, const Eigen::Vector2d& p_m) {
    return study::deepest_near(trial.coverage, p_m.x(), p_m.y(), kNear_m) >= kEnough * plan.greatest_depth_m;
}

// The nodule that is easiest to feel.
const stiffnessmaps::Nodule* largest(const scene::Plan& plan) {
    const auto smaller = [](const stiffnessmaps::Nodule& a, const stiffnessmaps::Nodule& b) {
        return a.diameter_m.value_or(0.0) < b.diameter_m.value_or(0.0);
    };
    const auto found = std::max_element(plan.nodules.begin(), plan.nodules.end(), smaller);
    return found == plan.nodules.end() ? nullptr : &*found;
}

// Stroked across: the path that presses crosses the nodule from one side to the other.
bool slid_across(const scene::Plan& plan, const session::Trial& trial) {
    const stiffnessmaps::Nodule* nodule = largest(plan);
    if (nodule == nullptr) return true;
    const Eigen::Vector2d at_m(nodule->x_m, nodule->y_m);
    if (!pressed_near(plan, trial, at_m)) return false;
    constexpr double kAcross_m = 6e-3;
    double way_m = 0.0;
    for (std::size_t i = 1; i < trial.path.size(); ++i) {
        const bool near = (trial.path[i].p_m - at_m).norm() < kNear_m;
        if (near && !trial.path[i].begins) way_m += (trial.path[i].p_m - trial.path[i - 1].p_m).norm();
    }
    return way_m >= kAcross_m;
}

const char* text_of(GuidedStep step) {
    constexpr const char* kTexts[] = {words::kGuidedPress, words::kGuidedSlide, words::kGuidedMark, words::kGuidedSure,
                                      words::kGuidedFinish};
    return kTexts[static_cast<std::size_t>(step)];
}

// Two rings, dark and light, that can be seen on any tissue.
void draw_target(const Shown& shown, const Eigen::Vector2d& p_m, const Gui& gui) {
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    const ImVec2 at = on_screen(shown.view, p_m.x(), p_m.y());
    const float radius_px = static_cast<float>(kNear_m) * shown.view.px_per_m;
    draw.AddCircle(at, radius_px, kDark, 64, 1.4f * gui.mm());
    draw.AddCircle(at, radius_px, kLag, 64, 0.8f * gui.mm());
}

// The place of the present step; nothing if it asks for a button.
std::optional<Eigen::Vector2d> target_of(const Shown& shown, GuidedStep step) {
    if (step == GuidedStep::press) return plain_place_m(shown.plan);
    const stiffnessmaps::Nodule* nodule = largest(shown.plan);
    if (step != GuidedStep::slide || nodule == nullptr) return std::nullopt;
    return Eigen::Vector2d(nodule->x_m, nodule->y_m);
}

// A panel as high as its text needs, at the tissue's lower or upper edge.
PanelArea guided_area(const Layout& layout, const std::string& text, float mm, bool below) {
    const PanelArea& t = layout.tissue_px;
    const ImGuiStyle& style = ImGui::GetStyle();
    const float wrap_px = t.width() - 2.0f * style.WindowPadding.x;
    const float text_px = kGuidedText * ImGui::CalcTextSize(broken_at_spaces(text, wrap_px / kGuidedText).c_str()).y;
    const float height_px = std::min(0.6f * t.height(), ImGui::GetFontSize() + text_px + kTarget_mm * mm +
                                                            3.0f * style.ItemSpacing.y + 2.0f * style.WindowPadding.y);
    if (below) return {t.x0, t.y1 - height_px, t.x1, t.y1};
    return {t.x0, t.y0, t.x1, t.y0 + height_px};
}

// How many nodules a panel would hide.
std::ptrdiff_t hidden_by(const PanelArea& panel, const Shown& shown) {
    return std::count_if(shown.plan.nodules.begin(), shown.plan.nodules.end(), [&](const auto& nodule) {
        const ImVec2 at = on_screen(shown.view, nodule.x_m, nodule.y_m);
        return panel.holds(at.x, at.y);
    });
}

// The text stands where it does not hide what the step is about: the target, or the nodules that the result shows.
PanelArea guided_area(const Shown& shown, const Layout& layout, const std::string& text, float mm,
                      const std::optional<Eigen::Vector2d>& target_m) {
    const PanelArea above = guided_area(layout, text, mm, false), below = guided_area(layout, text, mm, true);
    if (target_m) {
        const PanelArea& t = layout.tissue_px;
        return on_screen(shown.view, target_m->x(), target_m->y()).y < 0.5f * (t.y0 + t.y1) ? below : above;
    }
    return shown.trial.finished && hidden_by(below, shown) < hidden_by(above, shown) ? below : above;
}

void guided_title(int step) {
    ImGui::TextDisabled("%s: %s", words::kGuidedStart,
                        words::filled(words::kStepOf, {std::to_string(step), std::to_string(kGuidedSteps)}).c_str());
}

}  // namespace

Eigen::Vector2d plain_place_m(const scene::Plan& plan) {
    Eigen::Vector2d best_m = plan.area.centre_m;
    double best = -1.0;
    constexpr int kGrid = 6;
    for (int i = 1; i < kGrid; ++i) {
        for (int j = 1; j < kGrid; ++j) {
            const Eigen::Vector2d share(static_cast<double>(i) / kGrid - 0.5, static_cast<double>(j) / kGrid - 0.5);
            const Eigen::Vector2d p_m = plan.area.centre_m + share.cwiseProduct(plan.area.size_m);
            double nearest_m = 1e3;
            for (const stiffnessmaps::Nodule& n : plan.nodules)
                nearest_m = std::min(nearest_m, (p_m - Eigen::Vector2d(n.x_m, n.y_m)).norm());
            const double worth_m = nearest_m - 0.5 * (p_m - plan.area.centre_m).norm();  // rather not at the edge
            if (worth_m <= best) continue;
            best = worth_m;
            best_m = p_m;
        }
    }
    return best_m;
}

GuidedStep guided_step(const scene::Plan& plan, const session::Trial& trial) {
    if (!trial.marks.empty()) return trial.marks.back().confidence == 0 ? GuidedStep::confidence : GuidedStep::finish;
    if (!pressed_near(plan, trial, plain_place_m(plan))) return GuidedStep::press;
    return slid_across(plan, trial) ? GuidedStep::mark : GuidedStep::slide;
}

void draw_guided(const Shown& shown, const Layout& layout, Gui& gui, Wishes& wishes) {
    const bool result = shown.trial.finished;
    const GuidedStep step = guided_step(shown.plan, shown.trial);
    const std::optional<Eigen::Vector2d> target_m = result ? std::nullopt : target_of(shown, step);
    if (target_m) draw_target(shown, *target_m, gui);
    const std::string text =
        result ? std::string(words::kGuidedResult) + "\n" + words::kGuidedEnds : std::string(text_of(step));
    begin_panel("guided", guided_area(shown, layout, text, gui.mm(), target_m), gui);
    guided_title(result ? kGuidedSteps : static_cast<int>(step) + 1);
    ImGui::SetWindowFontScale(kGuidedText);
    wrapped_text(text);
    ImGui::SetWindowFontScale(1.0f);
    if (result) {
        const bool menu = menu_of(shown.doing) != nullptr && *menu_of(shown.doing);
        const bool by_key =
            (gui.pressed(platform::key::enter) && !gui.shows_focus()) ||
            (gui.pressed(platform::key::escape) && shown.notices.problems.empty());  // which it dismisses first
        const float half_px = share_of_line_px(2);
        const float start_px = std::min(60.0f * gui.mm(), half_px), repeat_px = std::min(44.0f * gui.mm(), half_px);
        if (big_button(words::kStartPractice, words::kEnter, {start_px, kTarget_mm, true, true}, gui) ||
            (by_key && !menu))
            wishes.guided = false;
        ImGui::SameLine();
        if (big_button(words::kRepeatGuided, "", {repeat_px, kTarget_mm, true, false}, gui)) wishes.guided = true;
    } else if (big_button(words::kSkip, words::kEscape, {34.0f * gui.mm(), kTarget_mm, true, false}, gui) ||
               (gui.pressed(platform::key::escape) && !*menu_of(shown.doing) && shown.notices.problems.empty())) {
        wishes.guided = false;
    }
    end_panel("guided", gui);
}

}  // namespace palpa::app
