#pragma once
// Screens drawn without a display at some size of window: nothing blank, nothing that does not fit.

#include <optional>
#include <string>
#include <vector>

#include "app/screens/frame.h"
#include "app/screens/tactile_screen.h"
#include "app/screens/tangible_screen.h"

namespace palpa::test {

// A window's size and density, the hand, the cue above the finger, and the size of text.
struct Case {
    int width_px, height_px;
    double px_per_mm;
    bool left_handed;
    bool above_finger = false;
    int text_percent = 100;
};

// What is open, and what the app says.
struct Screens {
    app::Notices notices{};
    app::Doing doing{};
    std::optional<app::Wishes> asked{};
    app::ViewState view{};
    const app::TactileShown* tactile = nullptr;
    const app::TangibleShown* tangible = nullptr;
};

struct Pixels {
    int width = 0;
    int height = 0;
    std::vector<unsigned char> rgb;
};

app::OffScreen screen_of(const Case& c);

// Draws a few frames, since panels find their size in the first. Returns the pixels of the last.
Pixels draw(const session::Session& session, const app::Settings& settings, const Screens& screens,
            app::OffScreen& screen, scene::State& state);

// The folder for pictures to be looked at, or null.
const char* kept_pictures();

// Draws the screen and checks it. With PALPA_KEEP_PICTURES the picture NAME-WIDTHxHEIGHT.png stays in that folder.
void check_case(const session::Session& session, Screens& screens, const Case& c, const std::string& name,
                app::OffScreen& screen);

}  // namespace palpa::test
