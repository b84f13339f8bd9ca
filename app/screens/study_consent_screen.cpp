// The screens of a study on which a person agrees to take part, or stops; and what is told after practice.

#include <algorithm>

#include "app/screens/study_widgets.h"
#include "app/screens/widgets.h"

namespace palpa::app {
namespace {

// The buttons of one screen have the keys 1 and 2.
bool wide_button(const char* label, char digit, const Gui& gui) {
    const char key[2] = {digit, '\0'};
    const float width_px = std::min(90.0f * gui.mm(), share_of_line_px(1));
    const bool asked = big_button(label, key, {width_px, kTarget_mm, true, false}, gui);
    return asked || gui.pressed(digit) || gui.pressed(platform::key::pad_0 + (digit - '0'));
}

// Enter does not agree: nobody takes part by going on from screen to screen.
void draw_consent(const StudyRun& run, Gui& gui, Wishes& wishes) {
    title(words::kBeforeYouTakePart);
    const float below_px = (2.0f * kTarget_mm + 8.0f) * gui.mm();
    ImGui::BeginChild("consent", ImVec2(0.0f, ImGui::GetContentRegionAvail().y - below_px), false,
                      ImGuiWindowFlags_NavFlattened);
    wrapped_text(run.protocol.consent);
    end_scrolled("consent", gui);
    if (wide_button(words::kAgree, '1', gui)) wishes.study = GiveConsent{true};
    if (wide_button(words::kDoNotAgree, '2', gui)) wishes.study = GiveConsent{false};
}

void draw_leaving(Gui& gui, Wishes& wishes) {
    title(words::kWantToWithdraw);
    paragraph(words::kMayWithdraw);
    gap(gui);
    if (forward(words::kContinueStudy, gui)) wishes.study = LeaveStudy{study::Withdrawal::none};
    gap(gui);
    if (wide_button(words::kWithdrawKeepsData, '1', gui)) wishes.study = LeaveStudy{study::Withdrawal::keeps_data};
    if (wide_button(words::kWithdrawTakesData, '2', gui)) wishes.study = LeaveStudy{study::Withdrawal::takes_data};
}

void draw_withdrawn(const StudyRun& run, Gui& gui, Wishes& wishes) {
    title(words::kHasWithdrawn);
    paragraph(words::filled(words::kCodeHasWithdrawn, {run.code}));
    if (!run.where.empty()) paragraph(run.where);
    gap(gui);
    if (forward(words::kNextParticipant, gui)) wishes.study = SamePerson{false};
    trials_button(gui, run, wishes);
    leave_button(gui, run, wishes);
}

void draw_told(const step::Told& step, Gui& gui, Wishes& wishes) {
    title(step.right ? words::kWasRight : words::kWasWrong);
    paragraph(words::kOnlyInPractice);
    gap(gui);
    if (forward(words::kContinue, gui)) wishes.study = BeginStep{};
}

void draw_feedback(const step::Feedback& step, Gui& gui, Wishes& wishes) {
    title(words::filled(words::kFoundOf, {std::to_string(step.found), std::to_string(step.nodules)}));
    wrapped_text(words::filled(words::kFeedbackFalse, {std::to_string(step.false_positives)}));
    paragraph(words::kOnlyInPractice);
    gap(gui);
    if (forward(words::kContinue, gui)) wishes.study = BeginStep{};
}

}  // namespace

bool draw_consent_step(const StudyRun& run, Gui& gui, Wishes& wishes) {
    if (at<step::Consent>(run)) {
        draw_consent(run, gui, wishes);
    } else if (at<step::Leaving>(run)) {
        draw_leaving(gui, wishes);
    } else if (at<step::Withdrawn>(run)) {
        draw_withdrawn(run, gui, wishes);
    } else if (const auto* told = std::get_if<step::Told>(&run.step)) {
        draw_told(*told, gui, wishes);
    } else if (const auto* feedback = std::get_if<step::Feedback>(&run.step)) {
        draw_feedback(*feedback, gui, wishes);
    } else {
        return false;
    }
    return true;
}

}  // namespace palpa::app
