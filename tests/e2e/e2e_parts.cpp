// The screen of parts on a real X server: a button pressed with the pen, and a part cut, changed and taken back by it. Run it
// under tests/platform/xorg/with-xorg.

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <fstream>
#include <string>

#include "files/json.h"
#include "tests/e2e/run_app.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

// Codes of keys on the X server.
enum Key { kTwo = 11, kThree = 12, kOne = 10, kY = 29, kU = 30, kControl = 37, kJ = 44 };

class PenScript {
  public:
    explicit PenScript(const std::filesystem::path& file) : out_(file) {
        out_ << "t_s\tkind\tid\tphase\tx_px\ty_px\tpressure\n";
    }
    void wait(double seconds) { t_s_ += seconds; }
    void row(const char* phase, double x_px, double y_px, double pressure) {
        out_ << t_s_ << "\tpen\t0\t" << phase << '\t' << x_px << '\t' << y_px << '\t' << pressure << '\n';
        t_s_ += 0.02;
    }
    // Goes from one place to another with a pressure that rises to its greatest half way.
    void stroke(double x0, double x1, double y_px, double pressure) {
        row("hover", x0, y_px, 0.0);
        constexpr int kSteps = 40;
        for (int i = 0; i <= kSteps; ++i) {
            const double share = static_cast<double>(i) / kSteps;
            const double now = pressure * (1.0 - std::abs(2.0 * share - 1.0));
            row(i == 0 ? "down" : "move", x0 + share * (x1 - x0), y_px, std::max(0.02, now));
        }
        row("up", x1, y_px, 0.0);
        wait(1.5);
    }
    // Faster than frames may come: the pen is down at one place, then at another.
    void fast_stroke(double x0, double x1, double y_px) {
        row("hover", x0, y_px, 0.0);
        row("down", x0, y_px, 0.4);
        row("move", x1, y_px, 0.4);
        wait(0.5);
        row("up", x1, y_px, 0.0);
        wait(1.5);
    }
    void key(int code) {
        for (const char* phase : {"down", "up"}) key_row(code, phase);
        wait(1.5);
    }
    void key_with_control(int code) {
        key_row(kControl, "down");
        for (const char* phase : {"down", "up"}) key_row(code, phase);
        key_row(kControl, "up");
        wait(1.5);
    }
    double close() {
        out_.close();
        return t_s_;
    }

  private:
    void key_row(int code, const char* phase) {
        out_ << t_s_ << "\tkey\t" << code << '\t' << phase << "\t0\t0\t0\n";
        t_s_ += 0.1;
    }

    std::ofstream out_;
    double t_s_ = 0.5;
};

std::string arguments_for(const std::filesystem::path& scene, double played_s, const TemporaryFolder& folder) {
    return scene.string() + " --width-px 1280 --height-px 800 --quit-after-s " + std::to_string(played_s + 12.0) +
           " --screenshot " + (folder / "p.png").string() + " --log " + (folder / "log").string();
}

// A bar of 60 x 6 x 20 mm that beams answer for, and a scene of it.
std::filesystem::path bar_scene(const TemporaryFolder& folder) {
    std::ofstream(folder / "bar.json") << R"({"name": "bar", "voxel_mm": 0.5, "size_mm": [60, 6, 20],
      "materials": {"hard": {"young_Pa": 8.3e9, "poisson": 0.28, "density_kg_per_m3": 1200, "colour": "#4477aa"},
                    "soft": {"young_Pa": 2e9, "poisson": 0.394, "density_kg_per_m3": 1020, "colour": "#ee6677"}},
      "shape": [{"add": {"box": {"min_mm": [0, 0, 5], "max_mm": [60, 6, 15]}}, "material": "hard"}],
      "supports": [{"face": "xmin", "fix": "xyz"}],
      "loads": {"tip": {"at_mm": [57, 3, 15], "patch_mm": 4, "direction": "-z", "force_N": 2}}, "axis": "x"})";
    std::ofstream(folder / "scene.json")
        << R"({"name": "bar", "tissue": {"part": {"designs": ["bar.json"], "method": "timoshenko"}}})";
    return folder / "scene.json";
}

}  // namespace

TEST_CASE("parts: a button pressed three times by the pen goes on three times") {
    const TemporaryFolder folder;
    PenScript script(folder / "script.tsv");
    for (int i = 0; i < 3; ++i) script.stroke(755, 765, 375, 0.85);
    const double played_s = script.close();
    const std::filesystem::path scene = PALPA_SOURCE_DIR "/assets/scenes/button.json";
    const int status = run_app(folder, arguments_for(scene, played_s, folder), [&] {
        CHECK(play_script(folder) == 0);
        sleep_s(1.0);
    });
    CAPTURE(read_text(folder / "err.txt"));
    REQUIRE(status == 0);
    const Json json = parse_json(read_text(folder / "out.json"), "out.json");
    CHECK(json["switch_events"] == 3);
    CHECK(json["max_depth_mm"].get<double>() > 1.0);
}

TEST_CASE("changed: the pen cuts a part and gives it another material; changes are undone and done again") {
    const TemporaryFolder folder;
    PenScript script(folder / "script.tsv");
    script.key(kTwo);
    script.fast_stroke(700, 800, 400);
    script.key(kThree);
    script.stroke(840, 850, 400, 0.4);
    script.stroke(860, 880, 400, 0.4);
    script.key(kU);
    script.key_with_control(kY);  // again
    script.key(kU);               // were it not there again, this would take back the one before
    script.key(kJ);
    script.key(kOne);
    script.stroke(1095, 1105, 400, 0.6);
    const double played_s = script.close();
    const int status = run_app(folder, arguments_for(bar_scene(folder), played_s, folder), [&] {
        CHECK(play_script(folder) == 0);
        sleep_s(1.0);
    });
    CAPTURE(read_text(folder / "err.txt"));
    REQUIRE(status == 0);
    const Json out = parse_json(read_text(folder / "out.json"), "out.json");
    CHECK(out["problems"].empty());
    CHECK(out["max_depth_mm"].get<double>() > 0.0);
    const Json part = parse_json(read_text(folder / ".local/share/palpa/parts/bar-edited.json"), "bar-edited.json");
    REQUIRE(part["shape"].size() == 3);  // the bar, a cut, an exchange; the second exchange was undone
    REQUIRE(part["shape"][1].contains("remove"));
    const Json& channel = part["shape"][1]["remove"]["any"];  // without gaps
    REQUIRE(channel.size() > 10);
    for (std::size_t i = 1; i < channel.size(); ++i) {
        const auto x_mm = [&](std::size_t k) { return channel[k]["cylinder"]["from_mm"][0].get<double>(); };
        CHECK(std::abs(x_mm(i) - x_mm(i - 1)) < 1.0);  // the radius
    }
    CHECK(part["shape"][2].contains("permute"));
    // what was there before stays as it was
    CHECK(parse_json(read_text(folder / "bar.json"), "bar.json")["shape"].size() == 1);
}
