// The first minutes of somebody who has only a mouse, or only a pen: the guided start, a practice trial and a test. Run it under
// tests/platform/xorg/with-xorg.

#include <doctest/doctest.h>
#include <fstream>
#include <string>

#include "app/scene_choices.h"
#include "app/screens/layout.h"
#include "app/screens/screens.h"
#include "files/json.h"
#include "files/text.h"
#include "scene/mapping.h"
#include "session/history.h"
#include "tests/e2e/run_app.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::scene;
using namespace palpa::session;
using namespace palpa::app;
using namespace palpa::test;

namespace {

constexpr float kMm = 96.0f / 25.4f;  // px per mm of the controls on a screen that nobody measured

// The middle of controls in a window of 1280 x 800 px.
const Eigen::Vector2d kMark(120, 335), kSure4(162, 405), kFinish(176, 446), kMenu(175, 79), kTest(743, 100);

// What a person does with one tool, "mouse" or "pen".
class PersonScript {
  public:
    PersonScript(const std::filesystem::path& file, std::string tool) : out_(file), tool_(std::move(tool)) {
        out_ << "t_s\tkind\tid\tphase\tx_px\ty_px\tpressure\n";
    }
    void wait(double seconds) { t_s_ += seconds; }
    void row(const char* phase, const Eigen::Vector2d& at, double pressure) {
        out_ << t_s_ << '\t' << tool_ << "\t0\t" << phase << '\t' << at.x() << '\t' << at.y() << '\t'
             << (tool_ == "pen" ? pressure : 0.0) << '\n';
    }
    void click(const Eigen::Vector2d& at) {
        row("move", at, 0.0);
        wait(0.3);
        row("down", at, 0.2);
        wait(0.15);
        row("up", at, 0.0);
        wait(0.6);
    }
    // Presses while the tool moves from one place to the other: a mouse harder the longer its button is held.
    void press(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
        row("move", from, 0.0);
        wait(0.3);
        row("down", from, 0.1);
        for (int i = 1; i <= 50; ++i, wait(0.02)) row("move", from, 0.1 + 0.008 * i);
        for (int i = 0; i <= 100; ++i, wait(0.015)) row("move", from + 0.01 * i * (to - from), 0.5);
        row("up", to, 0.0);
        wait(0.4);
    }
    double close() {
        out_.close();
        return t_s_;
    }

  private:
    std::ofstream out_;
    std::string tool_;
    double t_s_ = 0.5;
};

void try_for_the_first_time(const std::string& tool) {
    const TemporaryFolder folder;
    const Scene scene = load_scene(PALPA_SOURCE_DIR "/assets/scenes/default.json");
    const Plan plan = make_plan(scene);
    const PanelArea t = layout_of(1280, 800, kMm, false).tissue_px;
    const View view = make_view(scene.mapping, plan.area,
                                {static_cast<double>(t.width()), static_cast<double>(t.height()),
                                 static_cast<double>(t.x0), static_cast<double>(t.y0)});
    const auto px = [&](const Eigen::Vector2d& p_m) { return px_of_tissue(view, p_m); };
    const Eigen::Vector2d nodule(plan.nodules[0].x_m, plan.nodules[0].y_m);
    const Eigen::Vector2d across(8e-3, 0.0);

    PersonScript script(folder / "script.tsv", tool);
    script.press(px(plain_place_m(plan)), px(plain_place_m(plan)));
    script.press(px(nodule - across), px(nodule + across));
    script.press(px(nodule), px(nodule));
    script.click(kMark);
    script.click(kSure4);
    script.click(kFinish);
    script.click(Eigen::Vector2d(static_cast<double>(t.x0) + 120.0, 125.0));  // start a practice trial
    script.wait(1.0);
    script.press(Eigen::Vector2d(700, 400), Eigen::Vector2d(800, 400));
    script.click(kMark);
    script.click(kFinish);
    script.click(kMenu);
    script.click(kTest);
    script.wait(1.0);
    script.press(Eigen::Vector2d(600, 300), Eigen::Vector2d(700, 500));
    script.click(kFinish);
    const std::string arguments = "--guided --quit-after-s " + std::to_string(script.close() + 6.0) + " --screenshot " +
                                  (folder / "p.png").string();
    REQUIRE(run_app(folder, arguments, [&] { CHECK(play_script(folder) == 0); }) == 0);
    const Json result = read_json(folder / "out.json");
    CHECK(result["overflow"] == "");
    REQUIRE(result["trials"].size() == 3);
    CHECK(result["trials"][0]["mode"] == "practice");
    CHECK(result["trials"][0]["tp"] == 1);
    CHECK(result["trials"][0]["marks"][0]["confidence"] == 4);
    CHECK(result["trials"][1]["mode"] == "practice");
    CHECK(result["trials"][2]["mode"] == "test");
    CHECK(result["trials"][2]["finished"] == true);
    CHECK(result["trials"][2]["clock_s"] < result["trials"][2]["duration_s"]);
    // the guided start is no result; the others were kept without being asked
    std::vector<std::string> problems;
    const std::vector<KeptTrial> kept =
        read_history(history_files(folder / ".local/share/palpa/history", problems), problems);
    CHECK(problems.empty());
    REQUIRE(kept.size() == 2);
    CHECK(kept[0].mode == TrialMode::practice);
    CHECK(kept[1].mode == TrialMode::test);
    CHECK(kept[1].path.size() > 10);
    const bool turned = kept[1].rotate_deg != kept[0].rotate_deg || kept[1].flip != kept[0].flip;
    CHECK(turned);  // nobody is tested on what was just shown
    CHECK(read_json(folder / "config/palpa/settings.json")["guided_done"] == true);
}

}  // namespace

TEST_CASE("first: the guided start, a practice trial and a test by mouse alone") { try_for_the_first_time("mouse"); }

TEST_CASE("first: the guided start, a practice trial and a test by pen alone") { try_for_the_first_time("pen"); }
