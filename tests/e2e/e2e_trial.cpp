// Whole trials on a real X server, in one run of the app: by pen, by two fingers, by keyboard alone; and the same trials
// without a window, from what was recorded. Run it under tests/platform/xorg/with-xorg.

#include <algorithm>
#include <doctest/doctest.h>
#include <fstream>
#include <string>

#include "app/screens/layout.h"
#include "files/json.h"
#include "files/text.h"
#include "scene/mapping.h"
#include "tests/e2e/run_app.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::scene;
using namespace palpa::app;
using namespace palpa::test;

namespace {

constexpr float kMm = 96.0f / 25.4f;  // px per mm of the controls on a screen that nobody measured

struct Point {
    double x_px, y_px;
};

// Where the default scene draws a place.
Point place(double x_mm, double y_mm, bool above_finger = false) {
    const PanelArea t = layout_of(1280, 800, kMm, false, above_finger).tissue_px;
    const ScreenArea screen{static_cast<double>(t.width()), static_cast<double>(t.height()), static_cast<double>(t.x0),
                            0.0};
    const View view = make_view({}, {{0.06, 0.06}, {0.12, 0.12}}, screen);
    const Eigen::Vector2d px = px_of_tissue(view, {1e-3 * x_mm, 1e-3 * y_mm});
    return {px.x(), px.y()};
}

// The middle of controls, as the screenshot of this size shows them.
constexpr Point kMenu{58, 27}, kDelayScene{360, 181}, kMark{120, 335}, kSure4{162, 405}, kSure2{72, 405},
    kUndo{62, 446}, kFinish{176, 446}, kAgain{64, 33}, kTest{743, 100};
enum Key {
    kF10 = 76,
    kEnter = 36,
    kSpace = 65,
    kLeft = 100,
    kRight = 102,
    kUp = 98,
    kDown = 104,
    kM = 58,
    kU = 30,
    kF = 41,
    k5 = 14,
    kN = 57,
    kR = 27,
    kEscape = 9,
    kControl = 37,
    kQ = 24
};

class Script {
  public:
    // `above_finger`: the tissue is drawn as the setting of that name does it.
    explicit Script(const std::filesystem::path& file, bool above_finger = false)
        : out_(file), above_finger_(above_finger) {
        out_ << "t_s\tkind\tid\tphase\tx_px\ty_px\tpressure\n";
    }
    void wait(double seconds) { t_s_ += seconds; }
    // Waits until the log's run of this number has begun, and a little for the picture.
    void wait_for_run(const std::filesystem::path& log, int run) {
        out_ << t_s_ << "\twait\t"
             << (log / ("sub-01/beh/sub-01_task-palpation_run-0" + std::to_string(run) + "_events.tsv")).string()
             << '\n';
        wait(1.0);
    }
    void row(const char* kind, int id, const char* phase, Point at, double pressure) {
        out_ << t_s_ << '\t' << kind << '\t' << id << '\t' << phase << '\t' << at.x_px << '\t' << at.y_px << '\t'
             << pressure << '\n';
    }
    void tap(const char* kind, int id, Point at) {
        if (kind[0] == 'p') row(kind, id, "hover", at, 0.0);
        wait(0.05);
        row(kind, id, "down", at, 0.3);
        wait(0.08);
        row(kind, id, "up", at, 0.0);
        wait(0.25);
    }
    // Strokes 6 mm through a place and stays down; `lift` ends it.
    void stroke(const char* kind, int id, double x_mm, double y_mm) {
        if (kind[0] == 'p') row(kind, id, "hover", at(x_mm - 3, y_mm), 0.0);
        wait(0.05);
        row(kind, id, "down", at(x_mm - 3, y_mm), 0.2);
        for (int i = 0; i <= 100; ++i) {
            wait(0.004);
            row(kind, id, "move", at(x_mm - 3 + 0.06 * i, y_mm), 0.76 + 0.0004 * i);  // no hand is constant
        }
        for (int i = 0; i <= 20; ++i) {
            wait(0.004);
            row(kind, id, "move", at(x_mm + 3 - 0.15 * i, y_mm), 0.78);
        }
    }
    void lift(const char* kind, int id, double x_mm, double y_mm) {
        row(kind, id, "up", at(x_mm, y_mm), 0.0);
        wait(0.2);
    }
    void key(int code, double seconds = 0.06) {
        row("key", code, "down", {0, 0}, 0.0);
        wait(seconds);
        row("key", code, "up", {0, 0}, 0.0);
        wait(0.12);
    }
    double close() {  // how long it plays
        out_.close();
        return t_s_;
    }

  private:
    Point at(double x_mm, double y_mm) const { return place(x_mm, y_mm, above_finger_); }

    std::ofstream out_;
    bool above_finger_;
    double t_s_ = 0.0;
};

void by_pen(const std::filesystem::path& log, Script& script) {
    script.tap("pen", 0, kMenu);
    script.wait(0.5);
    script.tap("pen", 0, kDelayScene);
    script.wait_for_run(log, 2);  // the scene is read anew
    script.stroke("pen", 0, 35, 35);
    script.lift("pen", 0, 35, 35);
    script.tap("pen", 0, kMark);
    script.tap("pen", 0, kSure4);
    script.stroke("pen", 0, 90, 90);
    script.lift("pen", 0, 90, 90);
    script.tap("pen", 0, kMark);
    script.tap("pen", 0, kUndo);
    script.tap("pen", 0, kFinish);
    script.wait(1.0);
    script.tap("pen", 0, kAgain);
    script.wait_for_run(log, 3);
    script.row("pen", 0, "hover", place(60, 5), 0.0);
}

// One finger stays on the tissue while another one marks.
void by_two_fingers(Script& script) {
    script.stroke("touch", 0, 85, 45);
    script.tap("touch", 1, kMark);
    script.tap("touch", 1, kSure2);
    script.lift("touch", 0, 85, 45);
    script.stroke("touch", 0, 20, 100);
    script.lift("touch", 0, 20, 100);
    script.tap("touch", 0, kMark);
    script.tap("touch", 0, kFinish);
}

// From the middle of the tissue to nodule A; speed 30 mm/s.
void by_keyboard(const std::filesystem::path& log, Script& script) {
    script.key(kF10);  // the menu: another scene by arrows and Enter
    script.wait(3.0);  // a slow machine needs some frames to show it
    script.key(kUp);   // from the chosen "Silicone phantom, delay" to "Silicone phantom"
    script.wait(1.0);
    script.key(kEnter);
    script.wait_for_run(log, 4);  // the scene is read anew
    script.key(kLeft, 25.0 / 30.0);
    script.key(kDown, 25.0 / 30.0);
    script.key(kSpace, 1.5);
    script.key(kM);
    script.key(k5);
    script.key(kM);
    script.key(kU);
    script.key(kF);
}

}  // namespace

TEST_CASE("app: whole trials by pen, by two fingers and by keyboard alone") {
    const TemporaryFolder folder;
    const auto path = [&](const char* name) { return (folder / name).string(); };
    Script script(folder / "script.tsv");
    by_pen(path("log"), script);
    by_two_fingers(script);
    script.wait(1.0);
    by_keyboard(path("log"), script);
    script.wait(0.5);
    const std::string seconds = std::to_string(script.close() + 60.0);
    const std::string arguments =
        "--test --quit-after-s " + seconds + " --log " + path("log") + " --screenshot " + path("p.png");
    const auto meanwhile = [&] {
        CHECK(play_script(folder) == 0);
        sleep_s(3.0);
        end_program(folder, "TERM");
    };
    REQUIRE(run_app(folder, arguments, meanwhile) == 0);
    const Json result = read_json(folder / "out.json");
    CHECK(result["overflow"] == "");
    CHECK(result["dropped_steps"] == 0);
    REQUIRE(result["trials"].size() == 3);

    const Json& pen = result["trials"][0];
    CHECK(pen["finished"] == true);
    CHECK(pen["tp"] == 1);
    CHECK(pen["fp"] == 0);
    REQUIRE(pen["marks"].size() == 1);
    CHECK(pen["marks"][0]["confidence"] == 4);
    CHECK(pen["marks"][0]["distance_mm"].get<double>() < 1.0);
    CHECK(pen["nodules"][0]["finding"] == "found");
    CHECK(pen["nodules"][2]["finding"] == "not touched");

    const Json& fingers = result["trials"][1];
    CHECK(fingers["tp"] == 1);
    CHECK(fingers["fp"] == 1);
    REQUIRE(fingers["marks"].size() == 2);
    CHECK(fingers["marks"][0]["confidence"] == 2);
    CHECK(fingers["nodules"][1]["finding"] == "found");

    const Json& keys = result["trials"][2];
    CHECK(keys["finished"] == true);
    CHECK(keys["tp"] == 1);
    REQUIRE(keys["marks"].size() == 1);
    CHECK(keys["marks"][0]["confidence"] == 5);

    // run 1 is the trial that choosing a scene ended, run 2 the pen's
    const std::string marks = read_text(folder / "log/sub-01/beh/sub-01_task-palpation_run-02_marks.tsv");
    CHECK(marks.find("\t4\tA\t") != std::string::npos);
    const std::string samples = read_text(folder / "log/sub-01/beh/sub-01_task-palpation_run-03_samples.tsv");
    CHECK(samples.find("finger\tmove") != std::string::npos);
}

TEST_CASE("app: a finger that may not hide the avatar marks what lies above it") {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "config/palpa");
    write_text_whole(folder / "config/palpa/settings.json", R"({"above_finger": true, "test_mode": true})");
    Script script(folder / "script.tsv");
    const Point nodule = place(35, 35, true);
    const auto press = [&](const char* phase, double pressure) {
        script.wait(0.02);
        script.row("touch", 0, phase, {nodule.x_px, nodule.y_px + static_cast<double>(kFingerOffset_mm * kMm)},
                   pressure);
    };
    press("down", 0.3);
    for (int i = 0; i < 20; ++i) press("move", 0.7 + 0.001 * i);
    press("up", 0.0);
    script.wait(0.2);
    script.tap("touch", 0, kMark);
    script.tap("touch", 0, kFinish);
    const std::string arguments =
        "--quit-after-s " + std::to_string(script.close() + 4.0) + " --log " + (folder / "log").string();
    REQUIRE(run_app(folder, arguments, [&] { CHECK(play_script(folder) == 0); }) == 0);
    const Json trial = read_json(folder / "out.json")["trials"][0];
    REQUIRE(trial["marks"].size() == 1);
    CHECK(trial["tp"] == 1);
    CHECK(trial["marks"][0]["distance_mm"].get<double>() < 0.5);
    const Json settings = read_json(folder / "log/sub-01/beh/sub-01_task-palpation_run-01_settings.json");
    CHECK(settings["finger_offset_mm"] == 15.0);
}

TEST_CASE("asked: marks are thrown away only when the person says so, and are in the log then") {
    const TemporaryFolder folder;
    Script script(folder / "script.tsv");
    const auto mark = [&] {
        script.stroke("pen", 0, 35, 35);
        script.lift("pen", 0, 35, 35);
        script.key(kM);
        script.wait(0.3);
    };
    mark();
    script.key(kR);  // asks,
    script.wait(0.3);
    script.key(kEscape);  // and the trial goes on
    script.wait(0.3);
    script.key(k5);
    script.key(kR);
    script.wait(0.3);
    script.key(kEnter);  // run 2
    script.wait(0.6);
    mark();
    script.tap("pen", 0, kMenu);
    script.tap("pen", 0, kTest);
    script.wait(0.3);
    script.key(kEnter);  // run 3, a test
    script.wait(0.6);
    mark();
    script.row("key", kControl, "down", {0, 0}, 0.0);
    script.key(kQ);
    script.row("key", kControl, "up", {0, 0}, 0.0);
    script.wait(0.5);
    script.key(kEnter);
    script.close();
    // it ends by Ctrl+Q, or never
    REQUIRE(run_app(folder, "--practice --log " + (folder / "log").string(),
                    [&] { CHECK(play_script(folder) == 0); }) == 0);
    const auto beh = [&](const std::string& name) { return folder / ("log/sub-01/beh/sub-01_task-palpation_" + name); };
    CHECK(read_text(beh("run-01_marks.tsv")).find("\t5\tA\t") != std::string::npos);
    for (const char* run : {"run-01", "run-02", "run-03"}) {
        CAPTURE(run);
        const std::string marks = read_text(beh(std::string(run) + "_marks.tsv"));
        CHECK(std::count(marks.begin(), marks.end(), '\n') == 2);
        CHECK(read_text(beh(std::string(run) + "_events.tsv")).find("\tinterrupted\t") != std::string::npos);
    }
    CHECK_FALSE(std::filesystem::exists(beh("run-04_events.tsv")));
    // the test is on another layout than the one that practice has shown
    const Json practised = read_json(beh("run-02_settings.json"))["mapping"];
    const Json tested = read_json(beh("run-03_settings.json"))["mapping"];
    CHECK(read_text(beh("run-03_events.tsv")).find("\ttest\t") != std::string::npos);
    CHECK(practised != tested);
}

TEST_CASE("replay: what a pen did in two trials replays without a window to the same log, byte for byte") {
    const TemporaryFolder folder;
    const auto path = [&](const char* name) { return (folder / name).string(); };
    std::filesystem::create_directories(folder / "config/palpa");
    write_text_whole(folder / "config/palpa/settings.json", R"({"above_finger": true})");
    Script script(folder / "script.tsv", true);
    const auto press = [&](double x_mm, double y_mm) {
        script.stroke("pen", 0, x_mm, y_mm);
        script.lift("pen", 0, x_mm, y_mm);
    };
    press(35, 35);
    script.tap("pen", 0, kMark);
    script.tap("pen", 0, kSure4);
    press(90, 90);
    script.tap("pen", 0, kMark);
    press(60, 60);
    script.key(kM);
    script.key(kU);
    script.tap("pen", 0, kFinish);
    script.wait(0.3);
    script.key(kN);  // the tissue is turned; this trial is broken off
    script.wait(1.5);
    press(50, 70);
    script.wait(0.3);
    script.key(kM);
    script.wait(0.3);
    script.key(k5);
    const std::string seconds = std::to_string(script.close() + 5.0);
    REQUIRE(run_app(folder, "--test --quit-after-s " + seconds + " --log " + path("live"),
                    [&] { CHECK(play_script(folder) == 0); }) == 0);
    for (const char* trace : {"t.tsv", "t-2.tsv"}) {
        const std::string replay = std::string(PALPA_PROGRAM " run --headless --replay ") + path(trace) + " --log " +
                                   path("again") + " >/dev/null";
        CHECK(shell(replay) == 0);
    }
    const auto beh = [&](const char* log, const std::string& name) {
        return read_text(folder / (std::string(log) + "/sub-01/beh/sub-01_task-palpation_" + name));
    };
    for (const char* run : {"run-01", "run-02"}) {
        for (const char* file : {"_events.tsv", "_marks.tsv", "_samples.tsv", "_settings.json"}) {
            CAPTURE(run);
            CAPTURE(file);
            CHECK(beh("live", std::string(run) + file) == beh("again", std::string(run) + file));
        }
    }
    const std::string marks = beh("again", "run-01_marks.tsv");
    CHECK(std::count(marks.begin(), marks.end(), '\n') == 3);
    CHECK(marks.find("\t4\tA\t") != std::string::npos);
    CHECK(beh("again", "run-01_events.tsv").find("\tfinish\ttest\t") != std::string::npos);
    CHECK(beh("again", "run-02_events.tsv").find("\tinterrupted\ttest\t") != std::string::npos);
    CHECK(beh("again", "run-02_marks.tsv").find("\t5\t") != std::string::npos);
    const Json first = parse_json(beh("again", "run-01_settings.json"), "run 1");
    CHECK(first["finger_offset_mm"] == 15.0);
    CHECK(first["mapping"] != parse_json(beh("again", "run-02_settings.json"), "run 2")["mapping"]);
}
