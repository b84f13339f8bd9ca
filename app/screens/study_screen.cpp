// The screens of a study between its trials, for the participant and for the experimenter who types. They reveal
// nothing of what was found or is to be found.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/screens/screens.h"
#include "app/screens/study_widgets.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"
#include "app/study/study_run.h"
#include "files/text.h"

namespace palpa::app {
namespace {

// Puts text beside a button, at the height of the button's word.
void beside(const std::string& text, const Gui& gui) {
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() + 0.5f * (kTarget_mm * gui.mm() - ImGui::GetFontSize()));
    ImGui::TextUnformatted(text.c_str());
}

// A text field as high as the buttons, so that it can be touched.
bool text_field(const char* label, char* text, std::size_t size, ImGuiInputTextFlags flags, Gui& gui) {
    push_touchable_frame(2.0f, gui);
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const float width_px = ImGui::CalcItemWidth();
    const bool done = ImGui::InputText(label, text, size, flags);
    if (ImGui::IsItemActive()) gui.note_text_area({low.x, low.y, low.x + width_px, low.y + kTarget_mm * gui.mm()});
    ImGui::PopStyleVar();
    return done;
}

// The screen while the keeper stores the last step, usually for less than a frame.
void draw_keeping(double now_s, Gui& gui, const StudyRun& run, Wishes& wishes) {
    constexpr double kSoon_s = 0.5;
    if (now_s - *run.keeping_since_s < kSoon_s && run.warnings.empty()) return;
    title(words::kPleaseWait);
    paragraph(words::kBeingStored);
    for (const std::string& warning : run.warnings) warning_paragraph(warning);
    gap(gui);
    if (!run.warnings.empty()) trials_button(gui, run, wishes);
}

// A second Enter that was meant for the screen before must not take a code that is only offered, or leave questions open.
bool is_double_enter(const StudyRun& run, double now_s) {
    constexpr double kDoubleEnter_s = 1.0;
    return run.step_began_s == 0.0 || now_s - run.step_began_s < kDoubleEnter_s;
}

void draw_code(const step::Code& step, const StudyRun& run, double now_s, Gui& gui, StudyForm& form, Wishes& wishes) {
    title(words::kParticipantCode);
    paragraph(words::kCodeNoName);
    // the code that was offered has been taken at another screen
    if (form.refused != step.refused && step.refused > 0 && form.code == form.offered)
        form.code = form.offered = free_code(run);
    char text[24];
    std::snprintf(text, sizeof text, "%s", form.code.c_str());
    ImGui::SetNextItemWidth(60.0f * gui.mm());
    if (form.refused != step.refused || ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    form.refused = step.refused;
    // what is typed replaces a code that is offered, or was refused, also where the field had the letters before
    constexpr ImGuiInputTextFlags kFlags = ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll;
    const bool entered = text_field(words::kCode, text, sizeof text, kFlags, gui);
    form.code = text;
    // Escape takes the focus from the field, and there is no other field to give it to
    if (ImGui::IsItemDeactivated() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) form.refused = -1;
    gap(gui);
    const bool on = forward(words::kContinue, gui) || entered;
    const bool accident = form.code == form.offered && is_double_enter(run, now_s);
    if (on && !accident) wishes.study = EnterCode{text};
    if (on && accident) form.refused = -1;  // Enter has taken the focus from the field
    if (!run.note.empty()) warning_paragraph(run.note);
    for (const std::string& warning : run.warnings) warning_paragraph(warning);
    if (!run.on_tablet) return;
    gap(gui);
    trials_button(gui, run, wishes);
    leave_button(gui, run, wishes);
}

void draw_again(const StudyRun& run, Gui& gui, Wishes& wishes) {
    title(words::filled(words::kHasTakenPart, {run.code}));
    paragraph(words::filled(words::kTrialsDone, {std::to_string(run.progress.finished.size()),
                                                 std::to_string(run.progress.plan.trials.size())}));
    gap(gui);
    const bool same = forward(words::kContinueStudy, gui);
    const bool other = big_button(words::kAnotherParticipant, "", {70.0f * gui.mm(), kTarget_mm, true, false}, gui);
    if (same || other) wishes.study = SamePerson{same};
}

// Goes on in the line if there is room for width_px up to right_px, else in a new one.
void same_line_within(float right_px, float width_px) {
    ImGui::SameLine();
    if (ImGui::GetCursorPosX() + width_px > right_px + 0.5f * ImGui::GetStyle().ItemSpacing.x) ImGui::NewLine();
}

void draw_choices(const std::vector<std::string>& choices, float least_px, const Gui& gui, std::string& answer) {
    const float line_px = ImGui::GetContentRegionAvail().x;
    const float right_px = ImGui::GetCursorPosX() + line_px;
    for (std::size_t i = 0; i < choices.size(); ++i) {
        const float margin_px = (least_px > 0.0f ? 2.0f : 6.0f) * gui.mm();
        const std::string label = broken_at_spaces(choices[i], line_px - margin_px);
        const ImVec2 text_px = ImGui::CalcTextSize(label.c_str());
        const float width_px = std::max(least_px, text_px.x + margin_px);
        const float height_mm = std::max(kTarget_mm, text_px.y / gui.mm() + 3.0f);
        if (i > 0) same_line_within(right_px, width_px);
        ImGui::PushID(static_cast<int>(i));
        const bool chosen = answer == choices[i];
        if (big_button(label.c_str(), "", {width_px, height_mm, true, chosen}, gui))
            // a tap or Space takes an answer back; Enter twice, as people press it, does not
            answer = chosen && !gui.enter_presses_it() ? "" : choices[i];
        ImGui::PopID();
    }
}

// Says below a scale what its ends mean.
void draw_anchors(const study::Item& item, float width_px) {
    if (item.low.empty() && item.high.empty()) return;
    const float left_px = ImGui::GetCursorPosX();
    ImGui::TextDisabled("%s", item.low.c_str());
    ImGui::SameLine();
    const float end_px = left_px + std::max(width_px - ImGui::CalcTextSize(item.high.c_str()).x, 0.0f);
    ImGui::SetCursorPosX(std::max(end_px, ImGui::GetCursorPosX()));
    ImGui::TextDisabled("%s", item.high.c_str());
}

// What a number that is typed may be, and what the ends of its scale mean: "A number from 0 (low) to 100 (high)".
std::string scale_text(const study::Item& item) {
    const auto end = [](int number, const std::string& meaning) {
        const std::string digits = std::to_string(number);
        return meaning.empty() ? digits : words::filled(words::kEndOfScale, {digits, meaning});
    };
    return words::filled(words::kScaleFromTo, {end(*item.from, item.low), end(*item.to, item.high)});
}

// `focus`: the item's text field takes the keys.
void draw_item(const study::Item& item, bool focus, Gui& gui, std::string& answer) {
    wrapped_text(item.text);
    if (!item.choices.empty()) return draw_choices(item.choices, 0.0f, gui, answer);
    constexpr int kMostButtons = 11;
    if (item.from && *item.to - *item.from < kMostButtons) {
        std::vector<std::string> steps;
        for (int i = *item.from; i <= *item.to; ++i) steps.push_back(std::to_string(i));
        // on one line, if the buttons do not become too small
        const float share_px = share_of_line_px(static_cast<int>(steps.size()));
        const bool one_line = share_px > 8.0f * gui.mm();
        const float button_px = one_line ? std::min(11.0f * gui.mm(), share_px) : 11.0f * gui.mm();
        const float gap_px = ImGui::GetStyle().ItemSpacing.x;
        const float width_px = static_cast<float>(steps.size()) * (button_px + gap_px) - gap_px;
        draw_choices(steps, button_px, gui, answer);
        return draw_anchors(item, one_line ? width_px : ImGui::GetContentRegionAvail().x);
    }
    constexpr float kNumber_mm = 40.0f, kWords_mm = 120.0f;
    const float width_px = std::min((item.from ? kNumber_mm : kWords_mm) * gui.mm(), ImGui::GetContentRegionAvail().x);
    ImGui::SetNextItemWidth(width_px);
    char text[1000];
    std::snprintf(text, sizeof text, "%s", answer.c_str());
    const ImGuiInputTextFlags flags = item.from ? ImGuiInputTextFlags_CharsDecimal : ImGuiInputTextFlags_None;
    if (focus) ImGui::SetKeyboardFocusHere();
    if (text_field("##text", text, sizeof text, flags, gui)) answer = text;
    // Enter takes the focus from the field, which an answer that is refused needs again
    if (is_deactivated_by_enter() && !is_answer(item, answer)) ImGui::SetKeyboardFocusHere(-1);
    // what is refused is said in the hint's own line: another one would move the choices below from under a finger
    if (item.from && !is_answer(item, answer))
        warning_paragraph(words::filled(words::kWholeFromTo, {std::to_string(*item.from), std::to_string(*item.to)}));
    else if (item.from)
        paragraph(scale_text(item));
    if (answer.size() + 4 > sizeof text) warning_paragraph(words::kAnswerFull);  // a letter may have four bytes
    // the field scrolls; what it does not hold can still be read
    if (ImGui::CalcTextSize(answer.c_str()).x > width_px - 4.0f * gui.mm()) paragraph(answer);
}

// A scale whose steps have one digit each. A digit answers the first of them that is open.
bool takes_digits(const study::Item& item) {
    return item.choices.empty() && item.from && *item.from >= 0 && *item.to <= 9;
}

// Right after a step has begun the key may have been meant for the step before: it answers nothing, and Enter does not
// leave a page that is open behind somebody who was quick.
void take_digit(const StudyRun& run, double now_s, const Gui& gui, StudyForm& form) {
    if (ImGui::GetIO().WantTextInput) return;
    const std::vector<study::Item>& items = due_items(run);
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (!takes_digits(items[i]) || !form.answers[i].empty()) continue;
        for (int digit = *items[i].from; digit <= *items[i].to; ++digit) {
            if (!gui.pressed('0' + digit) && !gui.pressed(platform::key::pad_0 + digit)) continue;
            form.too_early = is_double_enter(run, now_s);
            if (form.too_early) return;
            form.told_too_early = false;
            form.answers[i] = std::to_string(digit);
        }
        return;
    }
}

void draw_items(const StudyRun& run, double now_s, Gui& gui, StudyForm& form, Wishes& wishes) {
    const std::vector<study::Item>& items = due_items(run);
    std::vector<std::string>& answers = form.answers;
    // On a desk the first question takes the keys at once. On a tablet a keyboard would come up over the page.
    const bool typed = !items.empty() && items[0].choices.empty() && !run.on_tablet;
    const bool focus = typed && answers.size() != items.size();
    answers.resize(items.size());
    take_digit(run, now_s, gui, form);
    const auto* rated = std::get_if<step::Ratings>(&run.step);
    title(rated == nullptr ? words::kQuestionsFirst : words::kHowWasIt);
    if (rated != nullptr) paragraph(words::kAboutLastTrials);  // a condition's name would tell what is compared
    if (form.told_too_early)
        warning_paragraph(words::kDigitTooEarly);
    else
        paragraph(words::kMayLeaveOpen);
    const float below_px = (kMark_mm + 4.0f) * gui.mm();
    ImGui::BeginChild("items", ImVec2(0.0f, ImGui::GetContentRegionAvail().y - below_px), false,
                      ImGuiWindowFlags_NavFlattened);
    if (form.anew) ImGui::SetScrollY(0.0f);
    bool good = true;
    for (std::size_t i = 0; i < items.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        draw_item(items[i], focus && i == 0, gui, answers[i]);
        good = good && is_answer(items[i], answers[i]);
        ImGui::PopID();
        gap(gui);
    }
    end_scrolled("items", gui);
    const bool open = std::all_of(answers.begin(), answers.end(), [](const std::string& a) { return a.empty(); });
    const bool quick = form.too_early && enter_pressed(gui);
    const bool accident = open && (is_double_enter(run, now_s) || quick);
    if (quick) form.too_early = false, form.told_too_early = true;
    if (forward(words::kContinue, gui, good) && !accident) wishes.study = SubmitAnswers{answers};
}

// What the due trial is done with, in a word.
std::string device_of(const StudyRun& run) {
    std::string device = name_of(due_condition(run).modality);
    std::replace(device.begin(), device.end(), '-', ' ');
    return device;
}

void draw_instructions(const StudyRun& run, Gui& gui, Wishes& wishes) {
    const study::PlannedTrial& trial = due_trial(run);
    title(words::filled(trial.practice ? words::kPracticeOf : words::kTrialOf, {progress_text(run)}));
    const float check_px =
        run.pressure == PressureVerdict::not_needed ? 0.0f : 2.0f * ImGui::GetTextLineHeightWithSpacing();
    const float below_px = (kMark_mm + kTarget_mm + 6.0f) * gui.mm() + check_px;
    ImGui::BeginChild("instructions", ImVec2(0.0f, ImGui::GetContentRegionAvail().y - below_px), false,
                      ImGuiWindowFlags_NavFlattened);
    wrapped_text(study::instructions_for(run.protocol, trial));
    if (run.protocol.count_told && !due_compares(run)) {
        gap(gui);
        wrapped_text(words::filled(words::kThereAre, {std::to_string(due_nodules(run).size())}));
    }
    end_scrolled("instructions", gui);
    if (run.pressure != PressureVerdict::not_needed) {
        paragraph(words::filled(run.pressure == PressureVerdict::ready       ? words::kPressureReady
                                : run.pressure == PressureVerdict::untried   ? words::kPressureUntried
                                : run.pressure == PressureVerdict::same_area ? words::kDeviceSameArea
                                                                             : words::kPressureMissing,
                                {device_of(run)}));
    }
    if (forward(words::kStart, gui)) wishes.study = BeginStep{};
    stop_button(gui, wishes);
}

void draw_device(const step::Device& step, const StudyRun& run, Gui& gui, Wishes& wishes) {
    const std::string device = device_of(run);
    const bool no_pressure = step.connected && refuses(run.pressure);
    const bool by_area = run.pressure == PressureVerdict::same_area;
    const char* text = no_pressure ? by_area ? words::kDeviceSameArea : words::kDeviceNoPressure
                       : step.here ? words::kDeviceIsBack
                                   : words::kDeviceMissing;
    title(step.no_level && step.here                     ? words::kNothingFelt
          : (step.untouched || step.unseen) && step.here ? words::kNothingTouched
                                                         : words::filled(text, {device}));
    if (step.no_level) {
        const calibration::Profile& profile = due_scene(run).plan->profile;
        warning_paragraph(words::filled(words::kWithoutLevel, {std::string(name_of(profile.level)), profile.id}));
    }
    if (step.left) paragraph(words::kTrialInterrupted);
    if (step.untouched) paragraph(words::kTimeOverUntouched);
    if (step.unseen) paragraph(words::kTimeOverUnseen);
    if (!run.devices_note.empty()) warning_paragraph(run.devices_note);
    if (no_pressure) {
        const bool finger = due_condition(run).modality == study::Modality::finger;
        warning_paragraph(by_area  ? words::kNeedsContactArea
                          : finger ? words::kNeedsFingerPressure
                                   : words::kNeedsPressure);
        paragraph(run.on_tablet ? words::kLeaveAndContinue : words::kCloseAndContinue);
    } else if (!step.here || step.no_level) {
        if (!step.here && run.devices_note.empty()) warning_paragraph(words::filled(words::kTrialWaits, {device}));
        paragraph(run.on_tablet ? words::kLeaveAndContinue : words::kCloseAndContinue);
    }
    if (step.here && run.pressure == PressureVerdict::untried)
        paragraph(words::filled(words::kPressureUntried, {device}));
    gap(gui);
    if (forward(words::kStart, gui, step.here)) wishes.study = BeginStep{};
    trials_button(gui, run, wishes);
    leave_button(gui, run, wishes);
}

void draw_present(const StudyRun& run, Gui& gui, Wishes& wishes) {
    title(words::filled(words::kPairOf, {progress_text(run)}));
    wrapped_text(run.interval == 0 ? words::kFeelFirst : words::kFeelSecond);
    gap(gui);
    if (forward(words::kDone, gui)) wishes.study = IntervalPresented{};
}

void draw_question(const StudyRun& run, double now_s, Gui& gui, Wishes& wishes) {
    title(words::kWhichSofter);
    gap(gui);
    const float width_px = std::min(60.0f * gui.mm(), share_of_line_px(2));
    const bool first = big_button(words::kTheFirst, "1", {width_px, 2.0f * kMark_mm, true, false}, gui) ||
                       gui.pressed('1') || gui.pressed(platform::key::pad_0 + 1);
    ImGui::SameLine();
    const bool second = big_button(words::kTheSecond, "2", {width_px, 2.0f * kMark_mm, true, false}, gui) ||
                        gui.pressed('2') || gui.pressed(platform::key::pad_0 + 2);
    gap(gui);
    paragraph(words::filled(words::kPairOf, {progress_text(run)}));
    gap(gui);
    stop_button(gui, wishes);
    if (first || second) wishes.study = ChooseSofter{first, now_s};
}

void stepper(const char* name, const Gui& gui, int& value) {
    ImGui::PushID(name);
    if (big_button("-", "", {12.0f * gui.mm(), kTarget_mm, value > 0, false}, gui)) --value;
    ImGui::SameLine();
    ImGui::BeginGroup();
    beside(std::to_string(value), gui);
    ImGui::EndGroup();
    ImGui::SameLine();
    if (big_button("+", "", {12.0f * gui.mm(), kTarget_mm, value < 1000, false}, gui)) ++value;
    ImGui::SameLine();
    ImGui::BeginGroup();
    beside(name, gui);
    ImGui::EndGroup();
    ImGui::PopID();
}

void draw_nodule_line(const std::string& name, const Gui& gui, int& said) {
    ImGui::PushID(name.c_str());
    const float right_px = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x;
    ImGui::BeginGroup();
    beside(name, gui);
    ImGui::EndGroup();
    const float name_px = ImGui::GetItemRectSize().x + ImGui::GetStyle().ItemSpacing.x;
    const float word_px = 24.0f * gui.mm(), digit_px = 10.0f * gui.mm();
    ImGui::SameLine(std::max(22.0f * gui.mm(), name_px));
    if (big_button(words::kMissed, "", {word_px, kTarget_mm, true, said == study::kMissed}, gui)) said = study::kMissed;
    same_line_within(right_px, word_px);
    if (big_button(words::kFound, "", {word_px, kTarget_mm, true, said == 0}, gui)) said = 0;
    constexpr const char* kDigits[5] = {"1", "2", "3", "4", "5"};
    for (int i = 1; i <= 5; ++i) {
        same_line_within(right_px, digit_px);
        if (big_button(kDigits[i - 1], "", {digit_px, kTarget_mm, true, said == i}, gui)) said = i;
    }
    ImGui::PopID();
}

void draw_typed_clock(double now_s, double limit_s, const Gui& gui, StudyForm& form) {
    study::TypedAnswers& typed = form.typed;
    const bool runs = form.clock_began_s > 0.0;
    if (runs) typed.duration_s = now_s - form.clock_began_s;
    const char* label = runs ? words::kStopClock : typed.duration_s > 0.0 ? words::kRestartClock : words::kStartClock;
    if (big_button(label, "T", {60.0f * gui.mm(), kTarget_mm, true, runs}, gui) || gui.pressed('t'))
        form.clock_began_s = runs ? 0.0 : now_s;
    ImGui::SameLine();
    std::string text = clock_text(typed.duration_s);
    if (limit_s > 0.0)
        text =
            words::filled(typed.duration_s < limit_s ? words::kTimeOf : words::kTimeOver, {text, clock_text(limit_s)});
    ImGui::BeginGroup();
    beside(text, gui);
    ImGui::EndGroup();
}

void draw_typed(const StudyRun& run, double now_s, Gui& gui, StudyForm& form, Wishes& wishes) {
    const study::Condition& condition = due_condition(run);
    title(words::filled(words::kExperimenter, {progress_text(run), name_of(condition.modality)}));
    paragraph(condition.modality == study::Modality::hand ? words::kTypeAnswers : words::kNotDriven);
    draw_typed_clock(now_s, due_limit_s(run), gui, form);
    const float below_px = (kMark_mm + 4.0f) * gui.mm();
    ImGui::BeginChild("answers", ImVec2(0.0f, ImGui::GetContentRegionAvail().y - below_px), false,
                      ImGuiWindowFlags_NavFlattened);
    if (form.anew) ImGui::SetScrollY(0.0f);
    const std::vector<std::string> names = due_nodules(run);
    if (names.empty()) {
        stepper(words::kNodulesFound, gui, form.typed.found);
        stepper(words::kNodulesMissed, gui, form.typed.missed);
    } else {
        paragraph(words::kFoundAndSure);
        for (std::size_t i = 0; i < names.size(); ++i) draw_nodule_line(names[i], gui, form.typed.nodules[i]);
    }
    stepper(words::kFalsePositiveCount, gui, form.typed.false_marks);
    end_scrolled("answers", gui);
    const bool timed = form.typed.duration_s > 0.0 && form.clock_began_s == 0.0;
    if (forward(words::kSave, gui, timed)) wishes.study = SubmitTyped{form.typed};
}

void draw_done(const StudyRun& run, Gui& gui, Wishes& wishes) {
    title(words::kThatWasAll);
    paragraph(words::filled(words::kAllSaved, {run.code, std::to_string(run.progress.finished.size())}));
    if (!run.where.empty()) paragraph(run.where);
    gap(gui);
    if (forward(words::kNextParticipant, gui)) wishes.study = SamePerson{false};
    trials_button(gui, run, wishes);
    leave_button(gui, run, wishes);
}

void draw_stopped(const step::Stopped& step, const StudyRun& run, Gui& gui, Wishes& wishes) {
    title(words::kStudyStopped);
    warning_paragraph(step.why);
    paragraph(words::kRestKept);
    gap(gui);
    trials_button(gui, run, wishes);
    leave_button(gui, run, wishes);
}

void draw_pause(const StudyRun& run, double now_s, Gui& gui, Wishes& wishes) {
    title(words::kBreak);
    paragraph(words::filled(words::kComesNext, {progress_text(run)}));
    gap(gui);
    ImGui::Text("%s", clock_text(now_s - run.step_began_s).c_str());
    gap(gui);
    if (forward(words::kContinue, gui)) wishes.study = BeginStep{};
    gap(gui);
    stop_button(gui, wishes);
}

// Returns an empty form for the present step of the study.
StudyForm form_for(const StudyRun& run) {
    StudyForm form;
    form.step = run.entered;
    if (at<step::Code>(run)) form.code = form.offered = free_code(run);
    if (at<step::Typed>(run)) form.typed.nodules.assign(due_nodules(run).size(), study::kMissed);
    return form;
}

void draw_step(const StudyRun& run, double now_s, Gui& gui, StudyForm& form, Wishes& wishes) {
    if (const auto* code = std::get_if<step::Code>(&run.step)) return draw_code(*code, run, now_s, gui, form, wishes);
    if (at<step::Again>(run)) return draw_again(run, gui, wishes);
    if (draw_consent_step(run, gui, wishes)) return;
    if (at<step::Questions>(run) || at<step::Ratings>(run)) return draw_items(run, now_s, gui, form, wishes);
    if (at<step::Instructions>(run)) return draw_instructions(run, gui, wishes);
    if (const auto* device = std::get_if<step::Device>(&run.step)) return draw_device(*device, run, gui, wishes);
    if (at<step::Present>(run)) return draw_present(run, gui, wishes);
    if (at<step::Question>(run)) return draw_question(run, now_s, gui, wishes);
    if (at<step::Typed>(run)) return draw_typed(run, now_s, gui, form, wishes);
    if (at<step::Pause>(run)) return draw_pause(run, now_s, gui, wishes);
    if (at<step::Done>(run)) return draw_done(run, gui, wishes);
    if (const auto* stopped = std::get_if<step::Stopped>(&run.step)) draw_stopped(*stopped, run, gui, wishes);
    if (trial_waits(run) && feels_device(run)) paragraph(words::kDevicesOpening);
    // else the trial is on the tissue
}

}  // namespace

bool answers_at_stake(const StudyForm& form) {
    const study::TypedAnswers& typed = form.typed;
    const auto given = [](const std::string& answer) { return !answer.empty(); };
    const auto seen = [](int nodule) { return nodule != study::kMissed; };
    return std::any_of(form.answers.begin(), form.answers.end(), given) ||
           std::any_of(typed.nodules.begin(), typed.nodules.end(), seen) || form.clock_began_s > 0.0 ||
           typed.found + typed.missed + typed.false_marks > 0 || typed.duration_s > 0.0;
}

void draw_study_screen(const StudyRun& run, double now_s, Gui& gui, StudyForm& form, Wishes& wishes) {
    if (form.step != run.entered) form = form_for(run);
    const WindowSize window = gui.size_px();
    ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(0.0f, 0.0f), ImVec2(window.width, window.height), kDark);
    // lines of readable length, in the middle of a large window
    const float width_px = std::min(window.width, 170.0f * gui.mm());
    const float height_px = std::min(window.height, 190.0f * gui.mm());
    const float x0 = 0.5f * (window.width - width_px);
    const float y0 = 0.5f * (window.height - height_px);
    begin_panel("study", {x0, y0, x0 + width_px, y0 + height_px}, gui);
    if (run.keeping_since_s) {
        draw_keeping(now_s, gui, run, wishes);
    } else {
        draw_step(run, now_s, gui, form, wishes);
        form.anew = false;
    }
    end_panel("study", gui);
}

}  // namespace palpa::app
