// Pressure is calibrated on the desk, where the force sensors are; this says so.

#include "app/calibrate_form.h"
#include "app/look.h"

namespace palpa {

struct CalibrateForm {};

std::shared_ptr<CalibrateForm> make_calibrate_form() { return std::make_shared<CalibrateForm>(); }

void draw_calibrate_screen(const Shown& shown, Gui& gui, CalibrateForm&, Wishes& wishes) {
    const WindowSize window = gui.size_px();
    begin_panel("calibrate", {0.0f, 0.0f, window.width, window.height}, gui);
    if (big_button("Back", "Esc", {40.0f * gui.mm(), kTarget_mm, true, false}, gui)) {
        wishes.screen = shown.trial.finished ? Screen::reveal : Screen::trial;
    }
    ImGui::TextWrapped("Pressure is calibrated on the desk, which has the force sensors.");
    paragraph("palpa calibrate record takes the points and palpa calibrate fit makes a profile of them. Profiles that are "
              "shipped with the app stand in the menu. They were measured on single devices: another pen of the same model "
              "may differ by half, and the logs hold the pressure as the device sent it, so that newtons can be worked out later.");
    paragraph("Profile now: " + shown.plan.profile.id);
    end_panel("calibrate", gui);
}

void step_calibrate(const std::vector<Sample>&, CalibrateForm&) {}
void stop_recording(CalibrateForm&) {}

}  // namespace palpa
