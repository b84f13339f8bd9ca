#include "tests/app/screens/screen_checks.h"

#include <doctest/doctest.h>
#include <filesystem>
#include <stdlib.h>

#include "scene/advance.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::scene;
using namespace palpa::session;
using namespace palpa::app;

namespace palpa::test {
namespace {

// Counts up to `enough` colours.
std::size_t colours_in(const Pixels& picture, const PanelArea& area, std::size_t enough) {
    std::vector<bool> seen(std::size_t{1} << 24);
    std::size_t colours = 0;
    for (int y = static_cast<int>(area.y0); y < static_cast<int>(area.y1); ++y) {
        for (int x = static_cast<int>(area.x0); x < static_cast<int>(area.x1); ++x) {
            const unsigned char* p = &picture.rgb[3 * static_cast<std::size_t>(y * picture.width + x)];
            const auto colour = static_cast<std::size_t>((p[0] << 16) | (p[1] << 8) | p[2]);
            if (seen[colour]) continue;
            seen[colour] = true;
            if (++colours == enough) return colours;
        }
    }
    return colours;
}

bool covers_all(const Screens& screens) {
    return screens.asked || screens.view.help || (menu_of(screens.doing) == nullptr && !palpates(screens.doing));
}

}  // namespace

const char* kept_pictures() { return ::getenv("PALPA_KEEP_PICTURES"); }

Pixels draw(const Session& session, const Settings& settings, const Screens& screens, OffScreen& screen, State& state) {
    ViewState view = screens.view;
    for (int i = 0; i < 4; ++i) {
        screen.draw({session.scene, *session.plan, session.trial, settings, screens.notices, screens.doing,
                     screens.asked, state.timeline.now_s, 1.0 / 60.0, screens.tactile, screens.tangible},
                    view, state);
        // a panel whose lines change with its scroll bar flickers: it overflows in every other frame
        if (i > 1) CHECK(screen.gui().overflow() == "");
    }
    return {screen.window().width_px(), screen.window().height_px(), screen.pixels()};
}

OffScreen screen_of(const Case& c) { return {c.width_px, c.height_px, c.px_per_mm, c.text_percent}; }

void check_case(const Session& session, Screens& screens, const Case& c, const std::string& name, OffScreen& screen) {
    CAPTURE(name);
    CAPTURE(c.width_px);
    CAPTURE(c.height_px);
    Settings settings;
    settings.left_handed = c.left_handed;
    settings.above_finger = c.above_finger;
    settings.text_percent = c.text_percent;
    screens.notices.px_per_mm = c.px_per_mm;
    State state = session.state;
    const auto width_px = static_cast<float>(c.width_px);
    const auto height_px = static_cast<float>(c.height_px);
    const float hand_mm = control_scale(c.px_per_mm, width_px, height_px);
    const float mm = larger_scale(hand_mm, 0.01f * static_cast<float>(c.text_percent), width_px, height_px);
    const Layout layout = layout_of(width_px, height_px, mm, c.left_handed, c.above_finger, hand_mm);
    const PanelArea& t = layout.tissue_px;
    Sample resize;
    resize.phase = Phase::ui;
    resize.action = Action::resize;
    resize.x_px = static_cast<double>(t.x0);
    resize.y_px = static_cast<double>(t.y0);
    resize.width_px = static_cast<double>(t.width());
    resize.height_px = static_cast<double>(t.height());
    advance(session.scene, *session.plan, resize, state);
    const Pixels picture = draw(session, settings, screens, screen, state);
    CHECK(picture.width == c.width_px);
    constexpr std::size_t kTextHas = 40;  // colours of smoothed letters
    const PanelArea all{0.0f, 0.0f, static_cast<float>(c.width_px), static_cast<float>(c.height_px)};
    if (layout.controls)
        CHECK(colours_in(picture, covers_all(screens) ? all : layout.controls_px, kTextHas) == kTextHas);
    CHECK(colours_in(picture, covers_all(screens) ? all : layout.tissue_px, kTextHas) == kTextHas);
    if (const char* keep = kept_pictures()) {
        const std::string size = std::to_string(c.width_px) + "x" + std::to_string(c.height_px);
        save_screen(screen.window(), std::filesystem::path(keep) / (name + "-" + size + (c.left_handed ? "-left" : "") +
                                                                    (c.text_percent > 100 ? "-large" : "") + ".png"));
    }
}

}  // namespace palpa::test
