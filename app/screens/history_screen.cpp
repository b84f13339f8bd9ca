#include "app/screens/history_screen.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "app/screens/nodule_outline.h"
#include "app/screens/plot.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"
#include "scene/mapping.h"

namespace palpa::app {
namespace {

using session::KeptTrial;

double path_s(const KeptTrial& trial) {
    double last_s = trial.path.empty() ? 0.0 : trial.path.back().time_s;
    for (const session::KeptMark& mark : trial.marks) last_s = std::max(last_s, mark.time_s);
    return last_s + 0.2;
}

const char* mode_word(const KeptTrial& trial) {
    return trial.mode == session::TrialMode::test ? words::kTest : words::kPractice;
}

void trial_list(const Gui& gui, HistoryView& history) {
    for (std::size_t k = history.trials.size(); k-- > 0;) {  // the newest first
        const KeptTrial& trial = history.trials[k];
        ImGui::PushID(static_cast<int>(k));
        ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, ImVec2(0.0f, 0.5f));
        ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(1.5f * gui.mm(), 0.0f));
        const float width_px = ImGui::GetContentRegionAvail().x - 4.0f * gui.mm();
        const std::string text =
            broken_at_spaces(words::filled(words::kHistoryLine,
                                           {local_time_text(trial.utc), mode_word(trial), clock_text(trial.clock_s)}),
                             width_px) +
            "\n" + broken_at_spaces(found_text(trial), width_px);
        const float text_mm = ImGui::CalcTextSize(text.c_str()).y / gui.mm();
        if (big_button(text.c_str(), "", {0.0f, std::max(1.5f * kTarget_mm, text_mm + 2.0f), true, k == history.chosen},
                       gui))
            choose_trial(k, history);
        if (k == history.chosen) ImGui::SetItemDefaultFocus();
        ImGui::PopStyleVar(2);
        ImGui::PopID();
    }
    if (history.trials.empty() && history.problems.empty()) paragraph(words::kNoHistory);
}

void ask_to_delete(const Gui& gui, HistoryView& history, Wishes& wishes) {
    const std::string read = std::to_string(history.trials.size()),
                      unread = std::to_string(history.files.size() - history.trials.size());
    warning_paragraph(history.problems.empty() ? words::filled(words::kDeleteAsk, {read})
                                               : words::filled(words::kDeleteAskUnread, {read, unread}));
    const float width_px = share_of_line_px(2);
    if (big_button(words::kCancel, words::kEscape, {width_px, kTarget_mm, true, false}, gui)) history.asks = false;
    ImGui::SameLine();
    if (!big_button(words::kDeleteNow, "", {width_px, kTarget_mm, true, false}, gui)) return;
    history.asks = false;
    wishes.delete_results = true;
}

void left_column(const Shown& shown, const PanelArea& area, Gui& gui, HistoryView& history, Wishes& wishes) {
    begin_part("results", area);
    if (big_button(words::kBack, words::kEscape, {40.0f * gui.mm(), kTarget_mm, true, false}, gui))
        wishes.screen = Screen::trial;
    const float there_px = ImGui::GetContentRegionAvail().y;
    const float list_px =
        std::max(there_px - (kTarget_mm + 26.0f) * gui.mm(), 0.55f * there_px);  // the rest may scroll
    ImGui::BeginChild("trials", ImVec2(0.0f, list_px), false, ImGuiWindowFlags_NavFlattened);
    trial_list(gui, history);
    scroll_by_drag(gui);
    ImGui::EndChild();
    ImGui::BeginChild("below", ImVec2(0.0f, 0.0f), false, ImGuiWindowFlags_NavFlattened);
    if (history.asks) {
        ask_to_delete(gui, history, wishes);
    } else if (big_button(words::kDeleteResults, "", {0.0f, kTarget_mm, !history.trials.empty(), false}, gui)) {
        history.asks = true;
    }
    for (const std::string& problem : history.problems) warning_paragraph(problem);
    if (!shown.settings.keep_results)
        paragraph(words::kHistoryNotKept);
    else
        paragraph(history.folder.empty() ? words::kHistoryNotThisRun
                                         : words::filled(words::kHistoryKeptIn, {history.folder.string()}));
    ImGui::EndChild();
    end_part("results", gui);
}

// Of tissue that has nodules.
double found_percent(const KeptTrial& trial) { return 100.0 * trial.found / static_cast<double>(trial.nodules.size()); }

void draw_learning_curve(const PanelArea& whole, const Gui& gui, HistoryView& history) {
    const float mm = gui.mm();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const auto count = static_cast<double>(history.trials.size());
    Plot plot{data_area(whole, mm), 0.5, std::max(count, 5.0) + 0.5, 0.0, 105.0, true};
    draw_plot_axes(plot, {words::kLearningCurve, words::kTrialAxis, words::kFoundAxis}, mm, draw);
    std::vector<ImVec2> tests;
    for (std::size_t k = 0; k < history.trials.size(); ++k) {
        const KeptTrial& trial = history.trials[k];
        if (trial.nodules.empty()) continue;
        const ImVec2 at = plot.at(static_cast<double>(k + 1), found_percent(trial));
        if (trial.mode == session::TrialMode::test) tests.push_back(at);
    }
    if (tests.size() > 1) draw.AddPolyline(tests.data(), static_cast<int>(tests.size()), kPale, 0, 0.4f * mm);
    for (std::size_t k = 0; k < history.trials.size(); ++k) {
        const KeptTrial& trial = history.trials[k];
        if (trial.nodules.empty()) continue;  // nothing could be found there
        const ImVec2 at = plot.at(static_cast<double>(k + 1), found_percent(trial));
        const bool test = trial.mode == session::TrialMode::test;
        draw.AddCircleFilled(at, 1.2f * mm, test ? kInk : kDark);
        draw.AddCircle(at, 1.2f * mm, kInk, 24, 0.4f * mm);
        if (k == history.chosen) draw.AddCircle(at, 2.0f * mm, kLag, 24, 0.5f * mm);
    }
    // a press chooses the nearest trial
    ImGui::SetCursorScreenPos(ImVec2(plot.area.x0, plot.area.y0));
    const ImVec2 size(std::max(1.0f, plot.area.width()), std::max(1.0f, plot.area.height()));
    if (!press_area("curve", size) || history.trials.empty()) return;
    const double share = static_cast<double>((ImGui::GetMousePos().x - plot.area.x0) / plot.area.width());
    const double x = plot.least_x + share * (plot.most_x - plot.least_x);
    choose_trial(static_cast<std::size_t>(std::clamp(std::round(x), 1.0, count)) - 1, history);
}

// Draws the path up to now, as deep as it pressed, with the marks made so far and the nodules.
void draw_replay(const KeptTrial& trial, double shown_s, const PanelArea& area, float mm, ImDrawList& draw) {
    scene::Mapping mapping;
    mapping.rotate_deg = trial.rotate_deg;
    mapping.flip = trial.flip;
    const scene::TissueArea tissue{1e-3 * Eigen::Vector2d(trial.x_mm, trial.y_mm),
                                   1e-3 * Eigen::Vector2d(trial.width_mm, trial.height_mm)};
    const scene::View view = scene::make_view(mapping, tissue,
                                              {static_cast<double>(area.width()), static_cast<double>(area.height()),
                                               static_cast<double>(area.x0), static_cast<double>(area.y0)});
    const auto px = [&](double x_mm, double y_mm) {
        const Eigen::Vector2d p = scene::px_of_tissue(view, {1e-3 * x_mm, 1e-3 * y_mm});
        return ImVec2(static_cast<float>(p.x()), static_cast<float>(p.y()));
    };
    const double half_x = 0.5 * trial.width_mm;
    const double half_y = 0.5 * trial.height_mm;
    draw.AddQuadFilled(px(trial.x_mm - half_x, trial.y_mm - half_y), px(trial.x_mm + half_x, trial.y_mm - half_y),
                       px(trial.x_mm + half_x, trial.y_mm + half_y), px(trial.x_mm - half_x, trial.y_mm + half_y),
                       IM_COL32(44, 50, 56, 255));
    const double deepest_mm = std::max(1e-3, trial.known_depth_mm);
    for (std::size_t i = 0; i < trial.path.size() && trial.path[i].time_s <= shown_s; ++i) {
        const session::KeptPoint& p = trial.path[i];
        const auto level = static_cast<std::size_t>(std::clamp(3.0 * p.depth_mm / deepest_mm, 0.0, 2.0));
        draw.AddCircleFilled(px(p.x_mm, p.y_mm), (0.4f + 0.5f * static_cast<float>(level)) * mm, kAreaTints[level], 10);
    }
    for (const session::KeptNodule& n : trial.nodules) {
        const Outline outline = outline_of({n.x_mm, n.y_mm}, n.diameter_mm, n.length_mm, n.angle_deg);
        const bool found = n.finding == session::Finding::found;
        const float right_px = draw_outline(outline, px, {0.6f * mm, 0.3f * mm, !found}, draw);
        const float middle_px = px(n.x_mm, n.y_mm).y;
        plated_text(draw, ImVec2(right_px + mm, middle_px - 0.5f * ImGui::GetFontSize()), kInk, n.id);
    }
    for (const session::KeptMark& m : trial.marks) {
        if (m.time_s > shown_s) continue;
        cross(draw, px(m.x_mm, m.y_mm), 1.6f * mm, kDark, 1.2f * mm);
        cross(draw, px(m.x_mm, m.y_mm), 1.6f * mm, m.hit ? kInk : kLag, 0.6f * mm);
    }
}

void replay_controls(const Gui& gui, const KeptTrial& trial, HistoryView& history) {
    const char* label = history.plays ? words::kPause : words::kPlay;
    if (big_button(label, "", {30.0f * gui.mm(), kTarget_mm, true, false}, gui)) {
        history.plays = !history.plays;
        if (history.plays && history.shown_s >= path_s(trial)) history.shown_s = 0.0;
    }
    ImGui::SameLine();
    push_touchable_frame(1.0f, gui);
    ImGui::PushStyleVar(ImGuiStyleVar_GrabMinSize, 5.0f * gui.mm());
    ImGui::SetNextItemWidth(-1.0f);
    auto shown_s = static_cast<float>(history.shown_s);
    const std::string text = clock_text(history.shown_s);
    if (ImGui::SliderFloat("##time", &shown_s, 0.0f, static_cast<float>(path_s(trial)), text.c_str(),
                           ImGuiSliderFlags_NoInput)) {
        history.shown_s = static_cast<double>(shown_s);
        history.plays = false;
    }
    ImGui::PopStyleVar(2);
}

}  // namespace

std::string local_time_text(const std::string& utc) {
    std::tm time{};
    const int read = std::sscanf(utc.c_str(), "%d-%d-%dT%d:%d:%d", &time.tm_year, &time.tm_mon, &time.tm_mday,
                                 &time.tm_hour, &time.tm_min, &time.tm_sec);
    if (read != 6) return utc;
    time.tm_year -= 1900;
    time.tm_mon -= 1;
    const std::time_t seconds = timegm(&time);
    std::tm local{};
    localtime_r(&seconds, &local);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", &local);
    return text;
}

std::string found_text(const KeptTrial& trial) {
    if (!trial.scored) return words::filled(words::kHistoryNotScored, {std::to_string(trial.marks.size())});
    if (trial.nodules.empty()) return words::filled(words::kHistoryNone, {std::to_string(trial.false_positives)});
    return words::filled(words::kHistoryFound, {std::to_string(trial.found), std::to_string(trial.nodules.size()),
                                                std::to_string(trial.false_positives)});
}

std::shared_ptr<HistoryView> make_history_view(const std::filesystem::path& folder) {
    auto history = std::make_shared<HistoryView>();
    history->folder = folder;
    if (!folder.empty()) history->files = session::history_files(folder, history->problems);
    history->trials = session::read_history(history->files, history->problems);
    if (!history->trials.empty()) choose_trial(history->trials.size() - 1, *history);
    return history;
}

void choose_trial(std::size_t index, HistoryView& history) {
    history.chosen = index;
    history.shown_s = 0.0;
    history.plays = true;
}

void play_on(double dt_s, HistoryView& history) {
    if (!history.plays || history.chosen >= history.trials.size()) return;
    constexpr double kMost_s = 8.0;
    const double all_s = path_s(history.trials[history.chosen]);
    history.shown_s += dt_s * std::max(1.0, all_s / kMost_s);
    if (history.shown_s < all_s) return;
    history.shown_s = all_s;
    history.plays = false;
}

void draw_history_screen(const Shown& shown, Gui& gui, HistoryView& history, Wishes& wishes) {
    play_on(shown.dt_s, history);
    if (history.asks && gui.pressed(platform::key::escape)) {  // it answers the question, and does not leave the screen
        history.asks = false;
        wishes.screen.reset();
    }
    const WindowSize window = gui.size_px();
    const float mm = gui.mm();
    const bool wide = window.width >= window.height;
    const float list_px = wide ? std::min(0.45f * window.width, 84.0f * mm) : 0.36f * window.height;
    const PanelArea list =
        wide ? PanelArea{0.0f, 0.0f, list_px, window.height} : PanelArea{0.0f, 0.0f, window.width, list_px};
    const PanelArea rest = wide ? PanelArea{list_px, 0.0f, window.width, window.height}
                                : PanelArea{0.0f, list_px, window.width, window.height};
    begin_bare_panel("history", gui);
    left_column(shown, list, gui, history, wishes);
    begin_part("progress", rest);
    ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(rest.x0, rest.y0), ImVec2(rest.x1, rest.y1), kDark);
    const float margin_px = 3.0f * mm;
    const float split = rest.y0 + 0.36f * rest.height();
    draw_learning_curve({rest.x0 + margin_px, rest.y0 + margin_px, rest.x1 - margin_px, split}, gui, history);
    if (history.chosen < history.trials.size()) {
        const KeptTrial& trial = history.trials[history.chosen];
        const float controls_px = (kTarget_mm + 3.0f) * mm;
        const PanelArea picture{rest.x0 + margin_px, split + margin_px, rest.x1 - margin_px,
                                rest.y1 - controls_px - margin_px};
        draw_replay(trial, history.shown_s, picture, mm, *ImGui::GetWindowDrawList());
        ImGui::SetCursorScreenPos(ImVec2(rest.x0 + margin_px, rest.y1 - controls_px));
        replay_controls(gui, trial, history);
    }
    end_part("progress", gui);
    end_panel("history", gui);
}

}  // namespace palpa::app
