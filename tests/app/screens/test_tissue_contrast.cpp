// What is drawn on the tissue stands out from what is beside it, by 3 : 1 or more (WCAG 2.2, 1.4.11), measured from
// pictures of the app.

#include <algorithm>
#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include "app/scene_choices.h"
#include "app/screens/frame.h"
#include "app/screens/tissue_drawing.h"
#include "render/gl.h"
#include "scene/advance.h"
#include "tests/app/screens/contrast.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::scene;
using namespace palpa::session;
using namespace palpa::app;
using namespace palpa::test;

namespace {

constexpr int kWide_px = 1280;
constexpr int kHigh_px = 800;

WindowOptions large_window() {
    WindowOptions options;
    options.visible = false;
    options.width_px = kWide_px;
    options.height_px = kHigh_px;
    return options;
}

// A picture of the app with luminances as WCAG defines them, as an eye sees them.
struct Shot {
    std::vector<unsigned char> rgb;
    const Eye* eye = &kEyes[0];
    double luminance(const glm::vec2& at_px) const {
        const int x = std::clamp(static_cast<int>(at_px.x), 0, kWide_px - 1);
        const int y = std::clamp(static_cast<int>(at_px.y), 0, kHigh_px - 1);
        const unsigned char* p = &rgb[3 * static_cast<std::size_t>(y * kWide_px + x)];
        return test::luminance(p[0], p[1], p[2], *eye);
    }
};

struct Photographer {
    Window window{large_window()};
    Gui gui{window};
    render::TissueDrawer tissue;
    Session session;
    Settings settings;
    Notices notices;
    Doing doing;
    std::optional<Wishes> asked;
    ViewState view;
    double now_s = 1.0;

    explicit Photographer(SurfaceMaterial material) {
        Scene first = load_scene("");
        first.surface->material = material;
        first.cues = {1.0, 0.6, 0.3, false};
        auto plan = std::make_shared<const Plan>(make_plan(first));
        change_tissue(std::move(first), std::move(plan), {}, session);
        begin_trial({}, {kWide_px, kHigh_px, kMissing, kMissing, "test"}, TrialMode::practice, session);
        take_sample(resize_sample(window, gui, settings, now_s), session);
    }

    void press(Phase phase, const Eigen::Vector2d& at_m, double pressure) {
        Sample sample;
        sample.t_host_s = now_s += 0.01;
        sample.pointer_id = 4;
        sample.tool = Tool::pen;
        sample.phase = phase;
        const Eigen::Vector2d at_px = px_of_tissue(session.state.view, at_m);
        sample.x_px = at_px.x();
        sample.y_px = at_px.y();
        sample.pressure = pressure;
        take_sample(sample, session);
    }

    void act(Action action) {
        Sample sample;
        sample.t_host_s = now_s += 0.01;
        sample.phase = Phase::ui;
        sample.action = action;
        if (session.trial.last_px) {  // where a mark goes
            sample.x_px = session.trial.last_px->x();
            sample.y_px = session.trial.last_px->y();
        }
        take_sample(sample, session);
    }

    Shot shot() {
        for (int i = 0; i < 3; ++i)
            draw_frame({session.scene, *session.plan, session.trial, settings, notices, doing, asked, now_s},
                       {gui, tissue}, view, session.state);
        return {render::read_pixels(kWide_px, kHigh_px)};
    }

    // The tissue as the last frame drew it.
    render::TissuePicture picture() {
        render::TissuePicture out;
        const Avatar avatar = avatar_at(session.scene, session.state, now_s);
        out.view = tissue_view(session.scene, session.state, avatar, {kWide_px, kHigh_px});
        SurfaceShape shape;
        surface_now(session.scene, *session.plan, session.state, shape);
        add_surface(shape, session.scene.cues, avatar, out);
        add_indenter(*session.plan, session.state, shape.cues, avatar, out);
        return out;
    }
};

// Of a light line in a dark rim: its least contrast on either side. The core stands out from the rim; the rim stands out
// from light tissue, the core from the dark wall of a dent.
double least_step(const Shot& shot, const glm::vec2& at_px, const glm::vec2& across) {
    double core = 0.0;
    for (int i = -2; i <= 2; ++i) core = std::max(core, shot.luminance(at_px + static_cast<float>(i) * across));
    double least = 1e9;
    for (const float side : {-1.0f, 1.0f}) {
        double rim = 1.0;
        for (int i = 1; i <= 5; ++i) rim = std::min(rim, shot.luminance(at_px + side * static_cast<float>(i) * across));
        double tissue = 0.0;
        for (int i = 7; i <= 9; ++i)
            tissue = std::max(tissue, shot.luminance(at_px + side * static_cast<float>(i) * across));
        least = std::min({least, contrast(core, rim), std::max(contrast(rim, tissue), contrast(core, tissue))});
    }
    return least;
}

// The share of places round a ring on the tissue where the ring stands out.
double share_that_stands_out(const Shot& shot, const render::TissuePicture& picture, const glm::vec2& centre_m,
                             float radius_m) {
    int good = 0;
    constexpr int kPlaces = 72;
    const glm::vec2 centre_px = render::project_px(picture.view, render::displaced_m(picture, centre_m));
    for (int i = 0; i < kPlaces; ++i) {
        const float angle = 6.2831853f * static_cast<float>(i) / kPlaces;
        const glm::vec2 p_m = centre_m + radius_m * glm::vec2(std::cos(angle), std::sin(angle));
        const glm::vec2 px = render::project_px(picture.view, render::displaced_m(picture, p_m));
        if (least_step(shot, px, glm::normalize(px - centre_px)) >= 3.0) ++good;
    }
    return static_cast<double>(good) / kPlaces;
}

}  // namespace

TEST_CASE("contrast: rings of nodules and of the footprint stand out from both materials, also in a dent") {
    for (const SurfaceMaterial material : {SurfaceMaterial::skin, SurfaceMaterial::silicone}) {
        CAPTURE(static_cast<int>(material));
        Photographer desk(material);
        const stiffnessmaps::Nodule& pressed = desk.session.plan->nodules[1];
        const Eigen::Vector2d beside(pressed.x_m - 0.013, pressed.y_m);
        desk.press(Phase::down, beside, 0.3);
        desk.press(Phase::move, beside, 0.75);
        Shot shot = desk.shot();
        const render::TissuePicture picture = desk.picture();
        CHECK(picture.grip.footprint_m > 8e-3f);
        for (const Eye& eye : kEyes) {
            CAPTURE(eye.name);
            shot.eye = &eye;
            for (const stiffnessmaps::Nodule& nodule : desk.session.plan->nodules) {
                CAPTURE(nodule.id);
                const auto radius_m = static_cast<float>(0.5 * *nodule.diameter_m);
                // the name beside the ring covers a part of it
                CHECK(share_that_stands_out(shot, picture, {nodule.x_m, nodule.y_m}, radius_m) > 0.85);
            }
            CHECK(share_that_stands_out(shot, picture, picture.grip.centre_m, picture.grip.footprint_m) > 0.8);
        }
    }
}

TEST_CASE("contrast: a mark stands out from both materials") {
    for (const SurfaceMaterial material : {SurfaceMaterial::skin, SurfaceMaterial::silicone}) {
        Photographer desk(material);
        const Eigen::Vector2d at_m(0.06, 0.05);
        desk.press(Phase::down, at_m, 0.5);
        desk.press(Phase::up, at_m, 0.0);
        desk.act(Action::mark);
        REQUIRE(desk.session.trial.marks.size() == 1);
        desk.press(Phase::down, {0.02, 0.1}, 0.2);
        Shot shot = desk.shot();
        const render::TissuePicture picture = desk.picture();
        const glm::vec2 centre_px = render::project_px(picture.view, render::displaced_m(picture, {0.06f, 0.05f}));
        for (const Eye& eye : kEyes) {
            CAPTURE(eye.name);
            shot.eye = &eye;
            for (const glm::vec2 arm : {glm::vec2(1, 1), glm::vec2(-1, 1), glm::vec2(1, -1), glm::vec2(-1, -1)}) {
                const glm::vec2 across = glm::normalize(glm::vec2(-arm.y, arm.x));
                CHECK(least_step(shot, centre_px + 4.0f * arm, across) >= 3.0);
            }
        }
    }
}

TEST_CASE("contrast: the outlines of what was examined stand out from the tints on both sides") {
    Photographer desk(SurfaceMaterial::skin);
    int row = 0;
    for (const double pressure : {0.15, 0.45, 0.8}) {  // light, medium and deep, with bare tissue between
        const double y_m = 0.025 + 0.03 * row++;
        for (int i = 0; i <= 60; ++i) desk.press(i == 0 ? Phase::down : Phase::move, {0.03 + 1e-3 * i, y_m}, pressure);
        desk.press(Phase::up, {0.09, y_m}, 0.0);
    }
    desk.act(Action::finish);
    desk.doing = Reviewing{debrief(*desk.session.plan, desk.session.trial)};
    Shot shot = desk.shot();
    const render::TissuePicture picture = desk.picture();
    const study::Coverage& c = desk.session.trial.coverage;
    for (const Eye& eye : kEyes) {
        CAPTURE(eye.name);
        shot.eye = &eye;
        int levels_seen = 0;
        std::array<int, 2> counts{};  // outlines, and those of them that stand out
        for (int j = 2; j + 3 < c.n_y; ++j) {
            for (int i = 36; i < 84; i += 3) {
                const auto level = [&](int row_of) {
                    return level_of(c, static_cast<double>(c.depth_m[static_cast<std::size_t>(row_of * c.n_x + i)]));
                };
                if (level(j) == level(j + 1)) continue;
                levels_seen |= 1 << static_cast<int>(std::max(level(j), level(j + 1)));
                const auto px = [&](double rows) {
                    return render::project_px(picture.view,
                                              {c.x_m + (i + 0.5) * c.cell_m, c.y_m + (j + 1.0 + rows) * c.cell_m, 0.0});
                };
                double line = 1.0;
                double below = 0.0;
                double above = 0.0;
                for (double s = -1.0; s <= 1.0; s += 0.05) line = std::min(line, shot.luminance(px(s)));
                for (double s = 1.2; s <= 1.9; s += 0.1) {
                    below = std::max(below, shot.luminance(px(-s)));
                    above = std::max(above, shot.luminance(px(s)));
                }
                ++counts[0];
                if (contrast(line, below) >= 3.0 && contrast(line, above) >= 3.0) ++counts[1];
            }
        }
        CHECK(levels_seen == 0b1110);
        CHECK(counts[0] > 60);
        CHECK(counts[1] > 0.9 * counts[0]);  // the path and the grid cross some
    }
}
