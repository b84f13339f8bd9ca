#include "app/screens/calibrate_screen.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <ctime>
#include <exception>

#include "app/scene_choices.h"
#include "app/screens/plot.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"
#include "calibration/profile_file.h"
#include "files/input_error.h"

namespace palpa::app {
namespace {

std::filesystem::path session_folder(const CalibrateForm& form) {
    const std::filesystem::path folder = user_folder();
    if (folder.empty()) throw files::InputError("HOME: found nothing, expected a folder to keep the calibration in");
    return folder / "calibrations" / form.name;
}

bool plain(const char* name) {
    const std::string text = name;
    return !text.empty() && std::all_of(text.begin(), text.end(),
                                        [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; });
}

calibration::RecordArguments arguments_of(const CalibrateForm& form) {
    if (!plain(form.name)) throw files::bad_input("name", "", files::shown(form.name), "letters, digits, - and _");
    calibration::RecordArguments arguments;
    arguments.folder = session_folder(form).string();
    arguments.resume = std::filesystem::exists(calibration::points_file(arguments));
    arguments.sensor = form.kind == 0   ? "typed"
                       : form.kind == 1 ? "netft:" + std::string(form.address)
                                        : "serial:" + std::string(form.port);
    arguments.counts_per_N = form.counts_per_N;
    arguments.N_per_count = form.N_per_count;
    return arguments;
}

template <class Work>
void attempt(CalibrateForm& form, const Work& work) {
    try {
        work();
    } catch (const std::exception& error) {
        form.problem = error.what();
    }
}

// Returns a free name beside those that exist already: NAME, NAME-2, ...
std::filesystem::path free_profile(const CalibrateForm& form) {
    const std::filesystem::path folder = user_folder() / "profiles";
    std::filesystem::create_directories(folder);
    std::filesystem::path file = folder / (std::string(form.name) + ".json");
    for (int i = 2; std::filesystem::exists(file); ++i)
        file = folder / (std::string(form.name) + "-" + std::to_string(i) + ".json");
    return file;
}

std::string today() {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    char text[16];
    std::strftime(text, sizeof text, "%Y-%m-%d", &local);
    return text;
}

double share_of(const calibration::RecordOptions& options, double level) {
    return (level - options.range.lowest) / (options.range.highest - options.range.lowest);
}

bool reads_area(const calibration::Recording& recording) {
    return recording.arguments.level.level == calibration::LevelField::contact_area;
}

double residual_percent(const calibration::CapturedPoint& point, const calibration::Curve& curve) {
    const double curve_N = calibration::value_N(curve, point.level);
    return 100.0 * (point.force_N - curve_N) / std::max(curve_N, 1e-6);
}

// The axis that shows all residuals, or 100 %: a mistyped force is many times the curve's.
double residual_axis_percent(const calibration::RecordSession& session, const Guide& guide) {
    double most = 0.0;
    for (const calibration::CapturedPoint& point : session.points) {
        if (guide.fit) most = std::max(most, std::abs(residual_percent(point, guide.fit->profile.curve)));
    }
    return most <= 20.0 ? 20.0 : most <= 50.0 ? 50.0 : 100.0;
}

// Draws points and curve above, and the points' residuals below. The band to press next is tinted.
void draw_plots(const calibration::Recording& recording, const Guide& guide, const PanelArea& area, const Gui& gui,
                ImDrawList& draw) {
    const calibration::RecordOptions& options = recording.arguments.options;
    const calibration::RecordSession& session = recording.session;
    const float split = area.y0 + 0.66f * area.height();
    constexpr double kFull_percent = 100.0;
    Plot curve{data_area({area.x0, area.y0 + gui.mm(), area.x1, split}, gui.mm()), 0.0, kFull_percent, 0.0, 0.5};
    // a number that was typed is no present force: it belongs to the point that it made
    const bool measures = recording.sensor && !session.forces.empty();
    const double now_N = measures ? session.forces.back().value : 0.0;
    for (const calibration::CapturedPoint& point : session.points)
        curve.most_y = std::max(curve.most_y, 1.1 * point.force_N);
    curve.most_y = std::max(curve.most_y, 1.1 * now_N);
    const int band = calibration::target_band(options, session, recording.knowledge.band_error);
    if (band >= 0) {
        const ImVec2 low = curve.at(kFull_percent * band / options.bands, 0.0);
        const ImVec2 high = curve.at(kFull_percent * (band + 1) / options.bands, curve.most_y);
        draw.AddRectFilled(ImVec2(low.x, high.y), ImVec2(high.x, low.y), kForceTints[1]);
    }
    const bool by_area = reads_area(recording);
    const char* level_axis = by_area ? words::kAreaAxis : words::kPressureAxis;
    const char* top = by_area ? words::kForceOverArea : words::kForceOverPressure;
    draw_plot_axes(curve, {top, level_axis, words::kForceAxis}, gui.mm(), draw);
    const double most_percent = residual_axis_percent(session, guide);
    const Plot rest{data_area({area.x0, split, area.x1, area.y1 - gui.mm()}, gui.mm()), 0.0, kFull_percent,
                    -most_percent, most_percent};
    draw_plot_axes(rest, {words::kResiduals, level_axis, words::kPercentAxis}, gui.mm(), draw);
    draw.AddLine(rest.at(0.0, 0.0), rest.at(kFull_percent, 0.0), kPale);
    const float dot_px = 0.6f * gui.mm();
    for (const calibration::CapturedPoint& point : session.points) {
        const double x = kFull_percent * share_of(options, point.level);
        draw.AddCircleFilled(curve.at(x, point.force_N), dot_px, kInk);
        if (guide.fit)
            draw.AddCircleFilled(rest.at(x, residual_percent(point, guide.fit->profile.curve)), dot_px, kInk);
    }
    if (guide.fit) {
        constexpr int kSteps = 100;
        const auto at = [&](int i) {
            const double level = options.range.lowest + (options.range.highest - options.range.lowest) * i / kSteps;
            return curve.at(kFull_percent * i / kSteps, calibration::value_N(guide.fit->profile.curve, level));
        };
        draw.PushClipRect(ImVec2(curve.area.x0, curve.area.y0), ImVec2(curve.area.x1, curve.area.y1), true);
        for (int i = 0; i < kSteps; ++i) draw.AddLine(at(i), at(i + 1), kLag, 0.4f * gui.mm());
        draw.PopClipRect();
    }
    if (!session.levels.empty()) {
        const double x = kFull_percent * share_of(options, session.levels.back().value);
        if (measures)
            cross(draw, curve.at(x, now_N), 1.2f * gui.mm(), kLag, 0.4f * gui.mm());
        else
            draw.AddLine(curve.at(x, 0.0), curve.at(x, curve.most_y), kLag, 0.4f * gui.mm());
    }
}

void draw_typed(calibration::Recording& recording, const Gui& gui, Guide& guide) {
    paragraph(words::kHoldStill);
    ImGui::SetNextItemWidth(share_of_line_px(2));
    // Enter takes it, and the field is empty for the next one: a second Enter records nothing. While the pen is held down, the
    // display gives a click of the mouse to nobody, so that the field takes the keys then, and a button would be of no use.
    const bool presses = recording.session.touching;
    if (presses && !guide.pressed && guide.note == words::kRecorded) guide.note.clear();  // of the press before
    guide.pressed = presses;
    constexpr int kFocusTakes = 4;  // frames; asking again meanwhile would drop letters
    const bool lost = presses && !guide.typing && guide.frames_since_focus >= kFocusTakes;
    ++guide.frames_since_focus;
    if (guide.again || lost) {
        ImGui::SetKeyboardFocusHere();
        guide.frames_since_focus = 0;
    }
    guide.again = false;
    push_touchable_frame(2.0f, gui);
    number_field(words::kGramForce, guide.shown_gf, "%.2f");
    ImGui::PopStyleVar();
    guide.typing = ImGui::IsItemActive();
    if (!is_deactivated_by_enter()) return;
    guide.again = true;  // the next number is typed at once
    if (!std::isfinite(guide.shown_gf) && guide.note == words::kRecorded) return;
    const double force_N = guide.shown_gf * calibration::kN_per_gf;
    const bool good = force_N >= 0.0 && force_N <= calibration::kMostForce_N;  // a profile takes no more
    const bool recorded = good && calibration::take_typed_N(force_N, recording);
    guide.note = !good ? words::kNotAForce : recorded ? words::kRecorded : words::kNotRecorded;
    if (recorded) guide.shown_gf = platform::kMissing;
}

void form_lines(Gui& gui, CalibrateForm& form) {
    constexpr const char* kKinds[] = {words::kTypedScale, words::kNetFt, words::kLoadCell};
    for (int i = 0; i < 3; ++i) {
        if (big_button(kKinds[i], "", {0.0f, kTarget_mm, true, form.kind == i}, gui)) form.kind = i;
    }
    const float width_px = 0.6f * ImGui::GetContentRegionAvail().x;
    const auto field = [&] { ImGui::SetNextItemWidth(width_px); };
    push_touchable_frame(2.0f, gui);
    if (form.kind == 1) {
        field();
        ImGui::InputText(words::kAddress, form.address, sizeof form.address);
        field();
        number_field(words::kCountsPerN, form.counts_per_N, "%.6g");
    }
    if (form.kind == 2) {
        field();
        ImGui::InputText(words::kPort, form.port, sizeof form.port);
        field();
        number_field(words::kNPerCount, form.N_per_count, "%.6g");
    }
    field();
    ImGui::InputText(words::kName, form.name, sizeof form.name);
    ImGui::PopStyleVar();
}

}  // namespace

void keep_profile(CalibrateForm& form) {
    form.problem.clear();
    attempt(form, [&] {
        calibration::close_recording(*form.recording);
        calibration::CalibrateOptions options;
        options.range = form.recording->arguments.options.range;
        calibration::CalibrationRows rows =
            calibration::read_points(calibration::points_file(form.recording->arguments), {});
        calibration::Calibration calibration = calibration::calibrate(rows, options);
        calibration.profile.device.pen = form.name;
        calibration.profile.device.date = today();
        const std::filesystem::path file = free_profile(form);
        const files::Json quality{{"median_relative_error", calibration.median_relative_error},
                                  {"n_points", calibration.n_points},
                                  {"warnings", calibration.warnings}};
        calibration::write_profile(calibration.profile, quality, file);
        form.guide.note = words::filled(words::kSavedAs, {file.string()});
        for (const std::string& warning : calibration.warnings) form.guide.note += "\n! " + warning;
        form.recording.reset();
    });
    if (!form.recording) return;
    form.guide.note = form.problem;  // why there is no profile
    form.refused_at = form.recording->session.points.size();
}

const char* number_to_type(const CalibrateForm& form) {
    const bool counts = form.counts_per_N >= 1e-9 && form.counts_per_N <= 1e12;  // as on the command line
    if (form.kind == 1 && !counts) return words::kGiveCountsPerN;
    const bool newtons = std::isfinite(form.N_per_count) && form.N_per_count != 0.0;
    return form.kind == 2 && !newtons ? words::kGiveNPerCount : "";
}

void refresh_fit(const calibration::Recording& recording, Guide& guide) {
    if (guide.next_fit.valid()) {
        if (guide.next_fit.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
        guide.fit = guide.next_fit.get();
    }
    const std::vector<calibration::CapturedPoint>& points = recording.session.points;
    if (points.size() == guide.fitted) return;
    guide.fitted = points.size();
    calibration::CalibrateOptions options;
    options.range = recording.arguments.options.range;
    options.bootstrap_fits = 0;
    guide.next_fit =
        std::async(std::launch::async,
                   [rows = calibration::rows_of(points), options]() -> std::optional<calibration::Calibration> {
                       try {
                           return calibration::calibrate(rows, options);
                       } catch (const std::exception&) {
                           return std::nullopt;  // too few points for a curve so far
                       }
                   });
}

GuideWishes draw_guide(calibration::Recording& recording, Gui& gui, Guide& guide) {
    const WindowSize window = gui.size_px();
    const float panel_px = std::min(0.5f * window.width, 76.0f * gui.mm());
    GuideWishes wishes;
    begin_panel("guide", {0.0f, 0.0f, panel_px, window.height}, gui);
    ImGui::SetWindowFontScale(1.5f);
    std::string advice = calibration::advice(recording);
    if (!advice.empty()) advice[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(advice[0])));
    wrapped_text(advice);
    ImGui::SetWindowFontScale(1.0f);
    const float column_px = 26.0f * gui.mm();
    const calibration::RecordSession& session = recording.session;
    const double level =
        session.levels.empty() ? 0.0 : share_of(recording.arguments.options, session.levels.back().value);
    value_line(reads_area(recording) ? words::kContactArea : words::kPressure, fixed(100.0 * level, 1) + " %",
               column_px);
    if (recording.sensor)
        value_line(words::kForce,
                   fixed(session.forces.empty() ? platform::kMissing : session.forces.back().value, 3) + " N",
                   column_px);
    value_line(words::kPoints, std::to_string(session.points.size()), column_px);
    value_line(words::kPressNumber, std::to_string(session.repeat + 1), column_px);
    if (!recording.sensor) draw_typed(recording, gui, guide);
    if (guide.makes_profile)
        wishes.keep = big_button(words::kCreateProfile, "", {0.0f, kMark_mm, guide.fit.has_value(), false}, gui);
    const bool points = !session.points.empty();
    if (big_button(words::kDropPoint, "", {0.0f, kTarget_mm, points, false}, gui)) {
        calibration::drop_last_point(recording);
        guide.note.clear();
    }
    if (big_button(words::kPauseRecording, "", {}, gui)) wishes.stop = true;
    ImGui::BeginChild("state", ImVec2(0.0f, 0.0f), false, ImGuiWindowFlags_NavFlattened);
    if (recording.sensor) {
        const devices::SensorHealth health = recording.sensor->health();
        paragraph(words::filled(
            words::kSensorHealth,
            {recording.sensor->name(), std::to_string(health.received), std::to_string(health.lost),
             std::to_string(health.duplicate), std::to_string(health.reordered), std::to_string(health.stalls)}));
        if (recording.silent) warning_paragraph(words::kSensorStopped);
    }
    if (recording.knowledge.done) wrapped_text(words::kCurveKnown);
    if (recording.knowledge.done && !recording.knowledge.missing.empty()) paragraph(recording.knowledge.missing + ".");
    // it is judged after each press, and not known in the middle of the first
    const bool judged = recording.known_repeats >= 0 || recording.resumed == session.points.size();
    if (judged && !recording.knowledge.done && !recording.knowledge.missing.empty()) {
        const std::string& missing = recording.knowledge.missing;
        const int press = recording.known_repeats + 1;  // points of the press that goes on now do not count yet
        paragraph(press > 0 ? words::filled(words::kAfterPress, {std::to_string(press), missing}) : missing);
    }
    if (!guide.note.empty()) paragraph(guide.note);
    ImGui::EndChild();
    end_panel("guide", gui);
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw.AddRectFilled(ImVec2(panel_px, 0.0f), ImVec2(window.width, window.height), kDark);
    draw_plots(recording, guide, {panel_px, 0.0f, window.width, window.height}, gui, draw);
    return wishes;
}

std::shared_ptr<CalibrateForm> make_calibrate_form() { return std::make_shared<CalibrateForm>(); }

void draw_calibrate_screen(const Shown&, Gui& gui, CalibrateForm& form, Wishes& wishes) {
    if (form.recording) {
        refresh_fit(*form.recording, form.guide);
        const bool more = form.recording->session.points.size() != form.refused_at;
        if (more && form.guide.note == form.problem) form.guide.note.clear();  // other points may be taken
        const GuideWishes asked = draw_guide(*form.recording, gui, form.guide);
        if (asked.keep) keep_profile(form);
        if (asked.stop) stop_recording(form);
        return;
    }
    const WindowSize window = gui.size_px();
    ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(0.0f, 0.0f), ImVec2(window.width, window.height), kDark);
    begin_panel("calibrate", {0.0f, 0.0f, window.width, window.height}, gui);
    ImGui::BeginChild("form", ImVec2(std::min(110.0f * gui.mm(), ImGui::GetContentRegionAvail().x), 0.0f), false,
                      ImGuiWindowFlags_NavFlattened);
    if (big_button(words::kBack, words::kEscape, {40.0f * gui.mm(), kTarget_mm, true, false}, gui)) {
        wishes.screen = Screen::trial;
    }
    wrapped_text(words::kHowToCalibrate);
    form_lines(gui, form);
    if (big_button(words::kStart, "", {0.0f, kMark_mm, true, false}, gui)) {
        form.guide = {};
        form.problem = number_to_type(form);
        if (form.problem.empty())
            attempt(form, [&] { form.recording = calibration::open_recording(arguments_of(form)); });
    }
    if (!form.problem.empty()) warning_paragraph(form.problem);
    if (!form.guide.note.empty()) wrapped_text(form.guide.note);
    ImGui::EndChild();
    end_panel("calibrate", gui);
}

void step_calibrate(const std::vector<platform::Sample>& samples, CalibrateForm& form) {
    if (!form.recording) return;
    std::vector<platform::Sample> pressed;
    bool mouse = false;
    for (const platform::Sample& sample : samples) {
        const bool sensor = sample.tool == platform::Tool::pen || sample.tool == platform::Tool::finger;
        if (sensor) pressed.push_back(sample);
        mouse = mouse || (!sensor && sample.phase == platform::Phase::down);
    }
    if (mouse) form.guide.note = words::kMouseHasNone;
    try {
        calibration::step(pressed, *form.recording);
    } catch (const std::exception& error) {
        form.problem = error.what();
        stop_recording(form);
    }
}

void stop_recording(CalibrateForm& form) {
    if (!form.recording) return;
    attempt(form, [&] { calibration::close_recording(*form.recording); });
    form.guide.note = words::filled(
        words::kPointsIn, {std::to_string(form.recording->session.points.size()), form.recording->arguments.folder});
    form.recording.reset();
}

}  // namespace palpa::app
