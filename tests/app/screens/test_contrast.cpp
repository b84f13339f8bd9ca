// Text can be read: its contrast to what it stands on, measured in pictures of the screens. Off screen.

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <imgui.h>
#include <optional>
#include <set>

#include "app/scene_choices.h"
#include "app/screens/calibrate_form.h"
#include "app/screens/frame.h"
#include "app/screens/history_screen.h"
#include "app/screens/map_screen.h"
#include "app/screens/widgets.h"
#include "app/study/study_run.h"
#include "render/gl.h"
#include "tests/app/screens/contrast.h"
#include "tests/off_screen.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::scene;
using namespace palpa::render;
using namespace palpa::session;
using namespace palpa::app;
using namespace palpa::test;

namespace {

constexpr int kWidth = 1280;
constexpr int kHeight = 800;
constexpr double kLeastContrast = 4.5;  // WCAG 2.2, 1.4.3

double luminance_of(ImU32 c, const Eye& eye) {
    return luminance(static_cast<int>(c & 0xFF), static_cast<int>((c >> 8) & 0xFF), static_cast<int>((c >> 16) & 0xFF),
                     eye);
}

struct Letter {
    ImVec2 low, high;
    ImU32 colour;
};

// The letters of the frame that was built last, from what Dear ImGui draws. Text of controls that do nothing now is
// translucent and left out, as is the dark rim of text on tissue.
std::vector<Letter> letters() {
    std::set<std::pair<float, float>> corners;
    for (const ImFontGlyph& glyph : ImGui::GetFont()->Glyphs) corners.insert({glyph.U0, glyph.V0});
    std::vector<Letter> out;
    const ImDrawData& data = *ImGui::GetDrawData();
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            for (unsigned k = 0; k + 5 < command.ElemCount; k += 3) {
                const ImDrawIdx* at = &list.IdxBuffer[static_cast<int>(command.IdxOffset + k)];
                const ImDrawVert& a = list.VtxBuffer[static_cast<int>(command.VtxOffset) + at[0]];
                const ImDrawVert& c = list.VtxBuffer[static_cast<int>(command.VtxOffset) + at[2]];
                const bool glyph = corners.count({a.uv.x, a.uv.y}) > 0 && c.uv.x > a.uv.x && c.uv.y > a.uv.y;
                const bool clipped = a.pos.x < command.ClipRect.x || c.pos.x > command.ClipRect.z ||
                                     a.pos.y < command.ClipRect.y || c.pos.y > command.ClipRect.w;
                if (glyph && !clipped && (a.col >> 24) == 255 && a.col != kDark) out.push_back({a.pos, c.pos, a.col});
            }
        }
    }
    return out;
}

// The share of the pixels around a letter to which it has enough contrast. A letter covers less than half of its own
// rectangle; on tissue a dark rim takes the place of a background.
double readable_share(const Letter& letter, const std::vector<unsigned char>& rgb, const Eye& eye) {
    int all = 0;
    int good = 0;
    const double text = luminance_of(letter.colour, eye);
    for (int y = static_cast<int>(letter.low.y) - 1; y <= static_cast<int>(letter.high.y); ++y) {
        for (int x = static_cast<int>(letter.low.x) - 1; x <= static_cast<int>(letter.high.x); ++x) {
            if (x < 0 || y < 0 || x >= kWidth || y >= kHeight) continue;
            const unsigned char* p = &rgb[3 * static_cast<std::size_t>(y * kWidth + x)];
            ++all;
            good += contrast(text, luminance(p[0], p[1], p[2], eye)) >= kLeastContrast;
        }
    }
    return all == 0 ? 1.0 : static_cast<double>(good) / all;
}

struct Pictures {
    WindowOptions options() {
        WindowOptions out = off_screen();
        out.width_px = kWidth;
        out.height_px = kHeight;
        return out;
    }
    Window window{options()};
    Gui gui{window};
    std::optional<TissueDrawer> tissue;
    Session session;
    Settings settings;
    Notices notices;
    Doing doing;
    std::optional<Wishes> asked;
    ViewState view;

    Pictures() {
        tissue.emplace();
        Scene scene = load_scene("");
        auto plan = std::make_shared<const Plan>(make_plan(scene));
        change_tissue(std::move(scene), std::move(plan), {}, session);
        notices.scenes = scene_choices();
        notices.profiles = profile_choices();
        notices.problems = {"scene.json: tissue.map: found nothing, expected a map folder"};
        notices.note = "Saved a picture";
        begin();
    }

    void begin() {
        begin_trial({}, {kWidth, kHeight, kMissing, kMissing, "test"}, TrialMode::practice, session);
        take_sample(resize_sample(window, gui, settings, 1.0), session);
    }

    void act(Action action, double x_m, double y_m) {
        Sample sample;
        sample.t_host_s = 2.0;
        sample.phase = Phase::ui;
        sample.action = action;
        const Eigen::Vector2d px = px_of_tissue(session.state.view, {x_m, y_m});
        sample.x_px = px.x();
        sample.y_px = px.y();
        take_sample(sample, session);
    }

    static void check_letters(const std::vector<Letter>& text, const std::vector<unsigned char>& rgb, const Eye& eye) {
        CAPTURE(eye.name);
        constexpr double kLeastShare = 0.2;
        int bad = 0;
        double worst = 1.0;
        ImVec2 where(0.0f, 0.0f);
        for (const Letter& letter : text) {
            const double share = readable_share(letter, rgb, eye);
            if (share < worst) where = letter.low;
            worst = std::min(worst, share);
            bad += share < kLeastShare;
        }
        CAPTURE(worst);
        CAPTURE(where.x);
        CAPTURE(where.y);
        CHECK(bad == 0);
    }

    void check(const char* name) {
        CAPTURE(name);
        view.on_screen = {};
        for (int i = 0; i < 3; ++i) {
            view.on_screen.content = 0;
            draw_frame({session.scene, *session.plan, session.trial, settings, notices, doing, asked, 2.0},
                       {gui, *tissue}, view, session.state);
        }
        const std::vector<Letter> text = letters();
        CHECK(text.size() > 10);
        const std::vector<unsigned char> rgb = read_pixels(kWidth, kHeight);
        for (const Eye& eye : kEyes) check_letters(text, rgb, eye);
    }
};

}  // namespace

TEST_CASE("contrast: all text of every screen has 4.5 : 1 to what it stands on") {
    Pictures p;
    p.act(Action::mark, 0.035, 0.035);
    p.act(Action::confidence_4, 0.0, 0.0);
    p.check("trial");
    for (const MenuPage page : {MenuPage::trial, MenuPage::settings, MenuPage::experimenter}) {
        p.view.menu_page = page;
        p.doing = Palpating{true};
        p.check("menu");
    }
    p.doing = Palpating{false, true};
    p.check("guided start");
    p.doing = Palpating{};
    p.view.help = true;
    p.check("help");
    p.view.help = false;
    p.view.cost = true;
    p.check("performance");
    p.view.cost = false;
    p.asked.emplace().again = true;
    p.check("question");
    p.asked.reset();
    p.doing = MeasuringScreen{};
    p.check("screen scale");
    p.doing = CheckingDevices{std::make_shared<DeviceCheck>(), {}};
    p.check("device check");
    p.doing = Palpating{};
    p.act(Action::pause, 0.0, 0.0);
    p.check("paused");
    p.act(Action::resume, 0.0, 0.0);
    p.act(Action::finish, 0.0, 0.0);
    p.doing = review_of(*p.session.plan, p.session.trial, p.session.state.view);
    p.check("result");
    p.view.history = std::make_shared<HistoryView>();
    for (int i = 0; i < 3; ++i) p.view.history->trials.push_back(kept_trial(p.session, "2026-11-10T09:30:00Z"));
    choose_trial(1, *p.view.history);
    p.doing = BrowsingHistory{};
    p.check("history");
    p.view.maps = make_map_browser(p.session.scene, map_choices());
    add_pin({0.035, 0.035}, *p.view.maps);
    p.doing = BrowsingMaps{};
    p.check("maps");
    p.doing = Calibrating{make_calibrate_form()};
    p.check("calibration");
}

TEST_CASE("contrast: all text of every step of a study has 4.5 : 1 to what it stands on") {
    const TemporaryFolder folder;
    Pictures p;
    p.notices = {};
    auto* run = &p.doing.emplace<StudyRun>();
    run->protocol = study::read_protocol(PALPA_SOURCE_DIR "/assets/protocols/paper.json");
    run->protocol.consent = "You may stop at any time and need not say why.";
    run->scenes = load_study_scenes(run->protocol);
    run->directory = folder.path();
    run->code = "07";
    run->progress = study::progress_of(run->directory, run->protocol, run->code);
    run->progress.next = run->progress.plan.trials.front();
    const StudyStep steps[] = {
        step::Code{},   step::Again{},   step::Consent{},  step::Questions{},       step::Instructions{},
        step::Device{}, step::Present{}, step::Question{}, step::Feedback{2, 3, 1}, step::Ratings{},
        step::Pause{},  step::Leaving{}, step::Done{}};
    for (const StudyStep& step : steps) {
        run->step = step;
        ++run->entered;
        p.check(name_of(run->step));
    }
}
