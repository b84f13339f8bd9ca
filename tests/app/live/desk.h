#pragma once
// The app with a window off screen and a keeper that is busy, for tests.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/live/live_app.h"
#include "app/scene_choices.h"
#include "app/screens/frame.h"
#include "tests/off_screen.h"

namespace palpa::test {

class BusyKeeper : public session::TrialKeeper {
  public:
    bool busy = true;
    std::vector<std::filesystem::path> designs;  // that were kept
    std::vector<std::filesystem::path> offered;
    void keep(const study::RunFiles&, bool) override {}
    void keep_part(const study::RunFiles&) override {}
    void keep_answers(const std::filesystem::path&, const std::string&) override {}
    void participant(const std::string&) override {}
    bool ready() const override { return !busy; }
    std::string problem() override { return {}; }
    std::string solved() override { return {}; }
    std::string note() const override { return {}; }
    std::string where(const std::string& code) const override { return "The trials of " + code + " are here."; }
    void keep_settings(const std::filesystem::path&) override {}
    void keep_design(const std::filesystem::path& file) override { designs.push_back(file); }
    void offer(const std::filesystem::path& file) override { offered.push_back(file); }
    void open() override {}
    void open_studies() override {}
};

struct Desk {
    BusyKeeper keeper;
    platform::Window window{off_screen()};
    app::Gui gui{window};
    render::TissueDrawer tissue;
    app::App app;

    explicit Desk(const std::string& scene) {
        app.keeper = &keeper;
        scene::Scene first = app::load_scene(scene);
        auto plan = std::make_shared<const scene::Plan>(scene::make_plan(first));
        app::put_scene(std::move(first), std::move(plan), window, app);
        app::begin(window, gui, app);
    }

    void sample(platform::Phase phase) {
        platform::Sample sample;
        sample.t_host_s = window.now_s();
        sample.pointer_id = 4;
        sample.tool = platform::Tool::pen;
        sample.phase = phase;
        const scene::ScreenArea& area = app.session.state.screen;
        sample.x_px = area.x_px + 0.5 * area.width_px;
        sample.y_px = area.y_px + 0.5 * area.height_px;
        sample.pressure = 0.5;
        session::take_sample(sample, app.session);
    }

    app::Wishes show_frame() {
        const session::Session& s = app.session;
        app::ToShow shown{s.scene, *s.plan, s.trial, app.settings, app.notices, app.doing, app.asked, window.now_s()};
        if (app.tactile.shown) shown.tactile = &*app.tactile.shown;
        return app::draw_frame(shown, {gui, tissue}, app.view, app.session.state);
    }
};

// Shows frames as the loop does: what a frame wishes is carried out.
inline void live_frames(Desk& desk, int count) {
    std::vector<platform::Sample> samples;
    for (int i = 0; i < count; ++i) {
        desk.window.poll(0.0, samples);
        carry_out(desk.show_frame(), desk.window, desk.gui, desk.app);
    }
}

// Takes the events that wait, and shows a frame, so many times.
inline void frames(Desk& desk, int count) {
    std::vector<platform::Sample> samples;
    for (int i = 0; i < count; ++i) {
        desk.window.poll(0.0, samples);
        desk.show_frame();
    }
}

}  // namespace palpa::test
