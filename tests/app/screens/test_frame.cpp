// A frame that would look like what is on the screen is not drawn again; whatever changes is. Off screen.

#include <array>
#include <doctest/doctest.h>
#include <optional>

#include "app/scene_choices.h"
#include "app/screens/frame.h"
#include "render/gl.h"
#include "scene/advance.h"
#include "tests/off_screen.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::stiffnessmaps;
using namespace palpa::scene;
using namespace palpa::render;
using namespace palpa::session;
using namespace palpa::app;
using namespace palpa::test;

namespace {

struct Screening {
    Window window{off_screen()};
    Gui gui{window};
    std::optional<TissueDrawer> tissue;
    Session session;
    Settings settings;
    Notices notices;
    Doing doing;
    std::optional<Wishes> asked;
    ViewState view;
    double now_s = 1.0;  // of a clock of the test's own

    explicit Screening(const std::string& scene) {
        tissue.emplace();
        Scene first = load_scene(scene);
        auto plan = std::make_shared<const Plan>(make_plan(first));
        change_tissue(std::move(first), std::move(plan), {}, session);
        begin_trial({}, {640, 400, kMissing, kMissing, "test"}, TrialMode::practice, session);
        take_sample(resize_sample(window, gui, settings, now_s), session);
        for (int i = 0; i < 5; ++i) drawn();  // panels find their size
    }

    bool drawn() {
        draw_frame({session.scene, *session.plan, session.trial, settings, notices, doing, asked, now_s},
                   {gui, *tissue}, view, session.state);
        return view.on_screen.drawn;
    }

    void press(Phase phase, double share, double pressure) {
        const ScreenArea& area = session.state.screen;
        press_px(phase, {area.x_px + share * area.width_px, area.y_px + 0.5 * area.height_px}, pressure);
    }

    void press_px(Phase phase, const Eigen::Vector2d& at_px, double pressure) {
        Sample sample;
        sample.t_host_s = now_s;
        sample.pointer_id = 4;
        sample.tool = Tool::pen;
        sample.phase = phase;
        sample.x_px = at_px.x();
        sample.y_px = at_px.y();
        sample.pressure = pressure;
        take_sample(sample, session);
    }
};

}  // namespace

TEST_CASE("frame: a tissue that stays as it was is shown from a copy that looks the same") {
    Screening s("");
    s.press(Phase::down, 0.5, 0.3);
    const auto pixels = [&](const char* note) {
        s.notices.note = note;
        REQUIRE(s.drawn());
        return read_pixels(640, 400);
    };
    const auto first = pixels("a");
    pixels("b");                  // the copy is made here
    CHECK(pixels("a") == first);  // and drawn here
    s.now_s += 0.01;
    s.press(Phase::move, 0.5, 0.9);
    const auto deeper = pixels("a");
    CHECK(deeper != first);
    pixels("b");
    CHECK(pixels("a") == deeper);
    s.tissue.emplace();  // has no copy
    s.view.on_screen = {};
    CHECK(pixels("a") == deeper);
}

TEST_CASE("frame: nothing is drawn while nothing changes, and everything that does is") {
    Screening s("");
    CHECK_FALSE(s.drawn());
    s.now_s += 0.01;
    CHECK_FALSE(s.drawn());
    s.press(Phase::down, 0.5, 0.3);
    CHECK(s.drawn());
    CHECK_FALSE(s.drawn());
    s.now_s += 0.01;
    s.press(Phase::move, 0.5, 0.4);  // the force bar, the dent
    CHECK(s.drawn());
    s.notices.note = "saved";
    CHECK(s.drawn());
    s.now_s += 2.0;  // the trial's clock
    CHECK(s.drawn());
    s.view.on_screen.content = 0;  // the window was uncovered
    CHECK(s.drawn());
    CHECK_FALSE(s.drawn());
}

TEST_CASE("frame: a pen beside the tissue does not show the block's sides") {
    Screening s("");
    const auto beside = [&] {  // just left of the tissue
        const View& view = s.session.state.view;
        const double left_px = view.centre_px.x() - 0.5 * view.area.size_m.x() * view.px_per_m;
        const auto pixels = read_pixels(640, 400);
        const std::size_t at = 3 * (200 * 640 + static_cast<std::size_t>(left_px - 4.0));
        return std::array{pixels[at], pixels[at + 1], pixels[at + 2]};
    };
    s.press(Phase::hover, 0.5, 0.0);
    s.drawn();
    const auto empty = beside();
    s.press(Phase::hover, 0.0, 0.0);
    CHECK(s.drawn());
    CHECK(beside() == empty);
}

TEST_CASE("frame: an avatar that catches up while the pen rests is drawn") {
    Screening s(PALPA_SOURCE_DIR "/assets/scenes/delay.json");
    // over the first nodule, until the avatar moves without the pen
    const Nodule& nodule = s.session.plan->nodules.front();
    int caught_up = 0;
    for (int i = 0; i < 100; ++i) {
        s.now_s += 0.005;
        const double x_m = nodule.x_m + 1e-3 * (0.3 * i - 15.0);
        s.press_px(i == 0 ? Phase::down : Phase::move, px_of_tissue(s.session.state.view, {x_m, nodule.y_m}), 0.8);
        const Avatar then = avatar_at(s.session.scene, s.session.state, s.now_s);
        const Avatar later = avatar_at(s.session.scene, s.session.state, s.now_s + 0.02);
        if ((later.p_m - then.p_m).norm() < 1e-4) continue;
        ++caught_up;
        s.drawn();
        s.now_s += 0.02;
        CHECK(s.drawn());  // no sample came
    }
    CHECK(caught_up > 0);
}

TEST_CASE("frame: the side view can be switched off, and stands only in scenes that ask for it") {
    Screening s("");
    s.press(Phase::down, 0.5, 0.6);
    CHECK(s.drawn());
    const auto with = read_pixels(640, 400);
    s.settings.side_view = false;
    CHECK(s.drawn());
    const auto without = read_pixels(640, 400);
    CHECK(with != without);
    s.session.scene.cues.side_view = false;
    CHECK_FALSE(s.drawn());
    s.settings.side_view = true;
    CHECK_FALSE(s.drawn());
}

TEST_CASE("frame: strengths of zero look as no cues do, and each cue changes the picture") {
    const auto pixels = [](const DrawnCues& cues, double pressure) {
        Screening s(PALPA_SOURCE_DIR "/assets/scenes/display-ratio.json");
        s.session.scene.cues = cues;
        s.session.plan = std::make_shared<const Plan>(make_plan(s.session.scene));
        s.press(Phase::down, 0.5, pressure);
        s.drawn();
        return read_pixels(640, 400);
    };
    const auto absent = pixels({}, 0.6);
    CHECK(pixels({0.0, 0.0, 0.0, false}, 0.6) == absent);
    CHECK(pixels({0.7, 0.0, 0.0, false}, 0.6) != absent);
    CHECK(pixels({0.0, 0.5, 0.0, false}, 0.6) != absent);
    CHECK(pixels({0.0, 0.0, 0.4, false}, 0.6) != absent);
}
