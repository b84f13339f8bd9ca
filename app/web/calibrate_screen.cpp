// Pressure is calibrated on the desk, where the force sensors are; this screen says so.

#include "app/screens/calibrate_form.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"

namespace palpa::app {

struct CalibrateForm {};

std::shared_ptr<CalibrateForm> make_calibrate_form() { return std::make_shared<CalibrateForm>(); }

void draw_calibrate_screen(const Shown& shown, Gui& gui, CalibrateForm&, Wishes& wishes) {
    const WindowSize window = gui.size_px();
    begin_panel("calibrate", {0.0f, 0.0f, window.width, window.height}, gui);
    if (big_button(words::kBack, words::kEscape, {40.0f * gui.mm(), kTarget_mm, true, false}, gui)) {
        wishes.screen = Screen::trial;
    }
    wrapped_text(words::kCalibratedOnDesk);
    paragraph(words::kHowOnDesk);
    paragraph(words::filled(words::kCurrentProfile, {shown.plan.profile.id}));
    end_panel("calibrate", gui);
}

void step_calibrate(const std::vector<platform::Sample>&, CalibrateForm&) {}
void stop_recording(CalibrateForm&) {}

}  // namespace palpa::app
