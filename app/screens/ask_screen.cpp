// The question before marks or answers are thrown away; it is the same for every action that would do it.

#include <algorithm>
#include <string>

#include "app/screens/screens.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"
#include "app/study/study_run.h"

namespace palpa::app {
namespace {

bool ends_trial(const Wishes& wishes) {
    return wishes.again || wishes.next || wishes.quit || wishes.scene || wishes.profile || wishes.mode ||
           wishes.above_finger || wishes.px_per_mm || wishes.studies || (wishes.guided && *wishes.guided);
}

// The question, and the names of the two ways to answer it.
struct Question {
    const char* title;
    std::string what;
    const char* stay;
    const char* end;
};

Question question_of(const Shown& shown) {
    const StudyRun* study = study_of(shown.doing);
    const std::size_t marks = shown.trial.marks.size();
    if (study != nullptr && due_compares(*study))
        return {words::kLosePair, words::kPairRepeated, words::kContinuePair, words::kClose};
    if (study != nullptr && !palpates(shown.doing))
        return {words::kLeaveAnswers, words::kLoseAnswers, words::kBackToAnswers, words::kClose};
    std::string what = words::kLoseTrial;
    if (study == nullptr)
        what = marks == 1 ? words::kLoseMark : words::filled(words::kLoseManyMarks, {std::to_string(marks)});
    return {words::kLoseMarks, what, words::kContinueTrial, words::kEndTrial};
}

}  // namespace

Wishes ask_first(Wishes wishes, std::optional<Wishes>& asked) {
    if (wishes.sure || !ends_trial(wishes)) return wishes;
    Wishes at_once;
    at_once.action = wishes.action;  // a mark made in the same frame is kept
    wishes.action.reset();
    asked = std::move(wishes);
    return at_once;
}

void draw_ask(const Shown& shown, Gui& gui, Wishes& wishes) {
    const WindowSize window = gui.size_px();
    gui.claim({0.0f, 0.0f, window.width, window.height});  // nothing is palpated meanwhile
    const float width_px = std::min(window.width, 110.0f * gui.mm());
    const float height_px = std::min(window.height, 62.0f * gui.mm());
    const float x0 = 0.5f * (window.width - width_px);
    const float y0 = 0.5f * (window.height - height_px);
    if (!palpates(shown.doing))
        ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(0.0f, 0.0f), ImVec2(window.width, window.height), kDark);
    begin_panel("ask", {x0, y0, x0 + width_px, y0 + height_px}, gui);
    if (ImGui::IsWindowAppearing()) ImGui::SetWindowFocus();
    const Question question = question_of(shown);
    wrapped_text(question.title);
    paragraph(question.what);
    const bool stay = big_button(question.stay, words::kEscape, {0.0f, kMark_mm, true, false}, gui) ||
                      gui.pressed(platform::key::escape);
    ImGui::SetItemDefaultFocus();         // a second Enter on the button that asked throws nothing away
    const bool ring = gui.shows_focus();  // then Enter presses the button that has it
    const bool by_key = gui.pressed(platform::key::enter) || gui.pressed(platform::key::pad_enter);
    const bool end =
        big_button(question.end, ring ? "" : words::kEnter, {0.0f, kTarget_mm, true, false}, gui) || by_key;
    end_panel("ask", gui);
    if (end && !stay) wishes = *shown.asked;
    wishes.sure = end && !stay;
    wishes.stay = stay;
}

}  // namespace palpa::app
