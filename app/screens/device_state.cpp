#include "app/screens/device_state.h"

#include <algorithm>
#include <cmath>

#include "app/screens/screens.h"
#include "app/screens/tactile_screen.h"
#include "app/screens/tangible_screen.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"

namespace palpa::app {
namespace {

// What a stop or a fault means for the devices of this scene; empty if there is none.
std::string banner_words(const Shown& shown) {
    const bool study = study_of(shown.doing) != nullptr;
    // the screens of the devices say it themselves
    if (std::holds_alternative<WatchingTactile>(shown.doing) || std::holds_alternative<WatchingTangible>(shown.doing))
        return {};
    if (shown.tactile != nullptr && shown.tactile->moment.stopped)
        return words::filled(study ? words::kStoppedInStudy : words::kStoppedBanner, {shown.tactile->moment.fault});
    if (shown.tangible != nullptr && shown.tangible->moment.stopped)
        return words::filled(study ? words::kSoftStoppedInStudy : words::kSoftStoppedBanner,
                             {shown.tangible->moment.fault});
    if (study) return {};  // the trial is interrupted, which the study says
    // a fault that goes by itself
    if (shown.tactile != nullptr && shown.tactile->runs && *shown.tactile->moment.fault != '\0')
        return words::filled(words::kRestsSince, {shown.tactile->moment.fault});
    if (shown.tangible == nullptr || !shown.tangible->runs || shown.tangible->moment.held) return {};
    const char* fault = shown.tangible->moment.fault;
    return *fault == '\0' ? std::string() : words::filled(words::kSoftRestsSince, {fault});
}

}  // namespace

std::string in_unit(double value, double scale, int digits, const char* unit) {
    return std::isfinite(value) ? fixed(scale * value, digits) + " " + unit : "-";
}

HalfScreen halves_of(const Gui& gui) {
    constexpr float kShare = 0.45f;
    const WindowSize window = gui.size_px();
    const float gap_px = 4.0f * gui.mm();
    const bool wide = window.width >= window.height;
    const PanelArea panel = wide ? PanelArea{0.0f, 0.0f, kShare * window.width, window.height}
                                 : PanelArea{0.0f, 0.0f, window.width, kShare * window.height};
    const PanelArea rest = wide ? PanelArea{panel.x1 + gap_px, gap_px, window.width - gap_px, window.height - gap_px}
                                : PanelArea{gap_px, panel.y1 + gap_px, window.width - gap_px, window.height - gap_px};
    return {panel, rest};
}

void cover_window(Gui& gui) {
    const WindowSize window = gui.size_px();
    gui.claim({0.0f, 0.0f, window.width, window.height});
    ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(0.0f, 0.0f), ImVec2(window.width, window.height), kDark);
}

void draw_devices(const std::vector<session::TactileDevice>& devices) {
    for (const session::TactileDevice& device : devices) {
        const char* kind = device.simulated ? words::kSimulatedDevice : words::kRealDevice;
        paragraph(words::filled(words::kDeviceLine, {device.role, device.name, kind, device.port}));
    }
}

void draw_stop_or_release(const DriveState& drive, bool stopped, float width_px, float height_mm, const Gui& gui,
                          Wishes& wishes) {
    if (drive.devices.empty() && !stopped) return;
    if (stopped) {
        if (big_button(words::kReleaseDevices, "", {width_px, height_mm, true, true}, gui))
            wishes.release_devices = true;
        return;
    }
    ButtonLook look{width_px, height_mm, drive.runs, false};
    look.stops = true;
    if (big_button(words::kStopDevices, "F12", look, gui)) wishes.stop_devices = true;
}

void draw_stopped_banner(const Shown& shown, const Gui& gui) {
    const std::string text = banner_words(shown);
    if (text.empty()) return;
    const WindowSize window = gui.size_px();
    const float gap_px = 2.0f * gui.mm();
    const float wrap_px = std::max(20.0f, window.width - 6.0f * gap_px);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap_px);
    const float left = 0.5f * (window.width - size.x);
    const float top = window.height - size.y - 2.0f * gap_px;
    ImDrawList& draw = *ImGui::GetForegroundDrawList();
    draw.AddRectFilled(ImVec2(left - gap_px, top - gap_px), ImVec2(left + size.x + gap_px, top + size.y + gap_px), kLag,
                       gui.mm());
    draw.AddText(ImGui::GetFont(), ImGui::GetFontSize(), ImVec2(left, top), kDark, text.c_str(), nullptr, wrap_px);
}

}  // namespace palpa::app
