#include "app/screens/study_widgets.h"

#include <algorithm>

#include "app/screens/widgets.h"

namespace palpa::app {

bool enter_pressed(const Gui& gui) {
    return gui.pressed(platform::key::enter) || gui.pressed(platform::key::pad_enter);
}

bool forward(const char* label, const Gui& gui, bool enabled) {
    const float width_px = std::min(70.0f * gui.mm(), ImGui::GetContentRegionAvail().x);
    const bool asked = big_button(label, words::kEnter, {width_px, kMark_mm, enabled, enabled}, gui);
    return asked || (enabled && enter_pressed(gui));
}

void title(const std::string& text) {
    ImGui::SetWindowFontScale(1.4f);
    wrapped_text(text);
    ImGui::SetWindowFontScale(1.0f);
}

void gap(const Gui& gui) { ImGui::Dummy(ImVec2(0.0f, 2.0f * gui.mm())); }

void leave_button(const Gui& gui, const StudyRun& run, Wishes& wishes) {
    const char* label = run.on_tablet ? words::kCloseStudy : words::kClose;
    const char* key = run.on_tablet ? "" : words::kCtrlQ;
    if (big_button(label, key, {std::min(70.0f * gui.mm(), share_of_line_px(1)), kTarget_mm, true, false}, gui))
        wishes.quit = true;
}

void trials_button(const Gui& gui, const StudyRun& run, Wishes& wishes) {
    if (!run.on_tablet) return;
    if (big_button(words::kTrialsOnTablet, "",
                   {std::min(70.0f * gui.mm(), share_of_line_px(1)), kTarget_mm, true, false}, gui))
        wishes.trials = true;
}

void stop_button(const Gui& gui, Wishes& wishes) {
    const float width_px = std::min(70.0f * gui.mm(), share_of_line_px(1));
    if (big_button(words::kWithdraw, "", {width_px, kTarget_mm, true, false}, gui)) wishes.study = WantToLeave{};
}

}  // namespace palpa::app
