// Shows what each pointing device declares, and what it really sends while it is tried in the test area.

#include <algorithm>
#include <cmath>

#include "app/screens/screens.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"

namespace palpa::app {
namespace {

std::string range_text(const Range& range, int digits) {
    return std::isfinite(range.lowest) ? fixed(range.lowest, digits) + " ... " + fixed(range.highest, digits) : "-";
}

void said_lines(const std::vector<platform::PointerDevice>& devices) {
    ImGui::TextDisabled(words::kReportedCapabilities);
    for (const platform::PointerDevice& device : devices) {
        std::string text = device.name + " (" + std::string(name_of(device.tool)) + "): ";
        text += device.has_pressure ? words::filled(words::kPressureRange,
                                                    {fixed(device.pressure_min, 0), fixed(device.pressure_max, 0)})
                                    : words::kNoPressure;
        if (device.levels > 0) text += words::filled(words::kLevels, {std::to_string(device.levels)});
        if (device.has_tilt) text += std::string(", ") + words::kTilt;
        if (device.has_contact_size) text += std::string(", ") + words::kContactSize;
        wrapped_text(text);
    }
    if (devices.empty()) paragraph(words::kNoDevice);
}

std::string verdict(platform::Tool which, const DeviceCheck& check) {
    if (which == platform::Tool::mouse || which == platform::Tool::keyboard) return words::kByTimeHeld;
    switch (platform::pressure_kind(check.pressure, which)) {
        case platform::PressureKind::varies:
            return words::kVaries;
        case platform::PressureKind::constant:
            return words::filled(words::kAlways, {fixed(platform::constant_pressure(check.pressure, which), 2)});
        case platform::PressureKind::missing:
            return words::kNone;
        case platform::PressureKind::unknown:
            break;
    }
    return words::kVaryIt;
}

void seen_lines(platform::Tool which, const DeviceCheck& check, const Gui& gui) {
    const ToolCheck& tool = of_tool(which, check);
    if (tool.samples == 0) return;
    const float column_px = 40.0f * gui.mm();
    ImGui::Separator();
    ImGui::Text("%s", std::string(name_of(which)).c_str());
    value_line(words::kPressure, verdict(which, check), column_px);
    value_line("",
               words::filled(words::kValues, {range_text(tool.pressure, 3), std::to_string(distinct_pressures(tool))}),
               column_px);
    value_line(words::kCounts, range_text(tool.pressure_raw, 0), column_px);
    value_line(words::kRate,
               words::filled(words::kRateAndGap, {fixed(rate_Hz(tool), 0), fixed(1e3 * worst_gap_s(tool), 0)}),
               column_px);
    const ClockDrift drift = clock_drift(tool);
    const std::string clock =
        std::isfinite(drift.ppm) ? fixed(drift.ppm, 0) + " +- " + fixed(drift.standard_error_ppm, 0) + " ppm" : "-";
    value_line(words::kClockDrift, clock, column_px);
    const std::string delivery =
        words::filled(words::kAtATime, {fixed(samples_per_delivery(tool), 1), fixed(1e3 * median_delay_s(tool), 0)});
    if (which != platform::Tool::keyboard) value_line(words::kDelivery, delivery, column_px);
    value_line(words::kTiltAndSize,
               std::string(tool.tilt ? words::kTilt : "-") + ", " + (tool.contact_size ? words::kContactSize : "-"),
               column_px);
    value_line(words::kSamples, std::to_string(tool.samples), column_px);
}

struct Verdict {
    bool good = false;
    std::string text;
};

// Says in one sentence whether there is a pen or finger whose pressure can be used.
Verdict verdict_of(const DeviceCheck& check, const std::vector<platform::PointerDevice>& devices) {
    constexpr std::int64_t kEnough = 20;  // distinct values: what a constant or a switch never gives
    std::string tried;
    for (const platform::Tool tool : {platform::Tool::pen, platform::Tool::finger}) {
        const ToolCheck& seen = of_tool(tool, check);
        const std::string name(name_of(tool));
        const platform::PressureKind kind = platform::pressure_kind(check.pressure, tool);
        const std::string values = std::to_string(distinct_pressures(seen));
        const bool varies = kind == platform::PressureKind::varies;
        if (varies && distinct_pressures(seen) >= kEnough)
            return {true, words::filled(words::kVerdictGood, {name, values, fixed(rate_Hz(seen), 0)})};
        if (varies) tried = words::filled(words::kVerdictFew, {name, values});
        const bool none = kind == platform::PressureKind::constant || kind == platform::PressureKind::missing;
        if (none && tried.empty()) tried = words::filled(words::kVerdictNoSensor, {name});
    }
    if (!tried.empty()) return {false, tried};
    const bool sensor =
        std::any_of(devices.begin(), devices.end(), [](const platform::PointerDevice& d) { return d.has_pressure; });
    return {false, sensor ? words::kVerdictTry : words::kVerdictNone};
}

void draw_verdict(const Verdict& verdict, const Gui& gui) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float side_px = ImGui::GetFontSize();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 middle(at.x + 0.5f * side_px, at.y + 0.5f * side_px);
    if (verdict.good) {  // a tick, and not only a colour
        const ImVec2 tick[3] = {ImVec2(at.x, middle.y), ImVec2(middle.x - 0.1f * side_px, at.y + 0.85f * side_px),
                                ImVec2(at.x + side_px, at.y + 0.1f * side_px)};
        draw.AddPolyline(tick, 3, kInk, 0, 0.7f * gui.mm());
    } else {
        draw.AddCircle(middle, 0.45f * side_px, kLag, 24, 0.6f * gui.mm());
    }
    ImGui::Dummy(ImVec2(1.2f * side_px, side_px));
    ImGui::SameLine();
    wrapped_text(verdict.text);
}

void draw_test_area(const PanelArea& area, const Gui& gui, const std::vector<Dot>& dots) {
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw.AddRectFilled(ImVec2(area.x0, area.y0), ImVec2(area.x1, area.y1), IM_COL32(40, 44, 48, 255));
    draw.AddRect(ImVec2(area.x0, area.y0), ImVec2(area.x1, area.y1), kPale);
    draw.AddText(ImGui::GetFont(), ImGui::GetFontSize(), ImVec2(area.x0 + 2.0f * gui.mm(), area.y0 + 2.0f * gui.mm()),
                 kInk, words::kTryHere, nullptr, area.width() - 4.0f * gui.mm());
    for (const Dot& dot : dots) {
        const float level = std::isfinite(dot.pressure) ? std::clamp(dot.pressure, 0.0f, 1.0f) : 0.0f;
        draw.AddCircle(ImVec2(dot.x_px, dot.y_px), (0.4f + 5.0f * level) * gui.mm(), dot.touching ? kLag : kPale, 16,
                       0.2f * gui.mm());
    }
}

}  // namespace

void add_dot(const platform::Sample& sample, std::vector<Dot>& dots) {
    constexpr std::size_t kDots = 400;
    const bool touching = sample.phase == platform::Phase::down || sample.phase == platform::Phase::move;
    if (sample.phase == platform::Phase::ui || !std::isfinite(sample.x_px + sample.y_px)) return;
    if (dots.size() >= kDots) dots.erase(dots.begin(), dots.begin() + kDots / 4);
    dots.push_back({static_cast<float>(sample.x_px), static_cast<float>(sample.y_px),
                    static_cast<float>(sample.pressure), touching});
}

void draw_device_screen(const Shown& shown, const CheckingDevices& checking, Gui& gui, Wishes& wishes) {
    const WindowSize window = gui.size_px();
    const bool wide = window.width >= window.height;
    const float share = 0.45f;
    const PanelArea panel = wide ? PanelArea{0.0f, 0.0f, share * window.width, window.height}
                                 : PanelArea{0.0f, 0.0f, window.width, share * window.height};
    const PanelArea test = wide ? PanelArea{panel.x1, 0.0f, window.width, window.height}
                                : PanelArea{0.0f, panel.y1, window.width, window.height};
    ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(0.0f, 0.0f), ImVec2(window.width, window.height), kDark);
    draw_test_area(test, gui, checking.dots);
    begin_panel("devices", panel, gui);
    if (big_button(words::kBack, words::kEscape, {40.0f * gui.mm(), kTarget_mm, true, false}, gui)) {
        wishes.screen = Screen::trial;
    }
    draw_verdict(verdict_of(*checking.check, shown.notices.devices), gui);
    ImGui::BeginChild("list");  // this part may scroll, since there may be any number of devices
    said_lines(shown.notices.devices);
    for (const std::string& note : shown.notices.pressure_notes) warning_paragraph(note);
    for (const std::string& note : shown.notices.device_notes) warning_paragraph(note);
    for (const platform::Tool tool :
         {platform::Tool::pen, platform::Tool::finger, platform::Tool::mouse, platform::Tool::keyboard})
        seen_lines(tool, *checking.check, gui);
    if (ImGui::GetScrollMaxX() > 1.0f) gui.note_overflow("devices");  // what is cut off at the right cannot be read
    ImGui::EndChild();
    end_panel("devices", gui);
}

}  // namespace palpa::app
