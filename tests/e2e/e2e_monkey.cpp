// Whatever is pressed, drawn and typed, in whatever order: the app goes on, ends when asked, and writes numbers only. A random
// hand of 20 s; scripts/monkey has many, for as long as it is told. Run it under tests/platform/xorg/with-xorg.

#include <doctest/doctest.h>
#include <filesystem>
#include <random>
#include <stdlib.h>
#include <string>
#include <vector>

#include "files/json.h"
#include "files/text.h"
#include "tests/e2e/run_app.h"
#include "tests/e2e/script.h"
#include "tests/error_message.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

class Monkey {
  public:
    Monkey(const std::filesystem::path& file, std::uint64_t seed) : random_(seed), script_(file) {}

    void play(double seconds) {
        while (script_.t_s < seconds) {
            const int kind = below(20);
            if (kind < 8) key();
            if (kind >= 8 && kind < 12) tap();
            if (kind >= 12 && kind < 15) press();
            if (kind >= 15 && kind < 17) touch();
            if (kind >= 17 && kind < 19) mouse();
            if (kind == 19) type();
            script_.t_s += 0.2 * share();
        }
    }

  private:
    int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
    double share() { return std::uniform_real_distribution<double>()(random_); }
    double x_px() { return 1279.0 * share(); }
    double y_px() { return 799.0 * share(); }

    void press_key(int code, double held_s) {
        script_.row("key", code, "down", 0.0, 0.0, 0.0);
        script_.t_s += held_s;
        script_.row("key", code, "up", 0.0, 0.0, 0.0);
        script_.t_s += 0.02;
    }
    // letters and digits, what moves the focus and chooses, F12, page keys and arrows
    void key() {
        static const std::vector<int> others{9,  9,  23, 23,  36,  36,  36,  65,  65, 22, 96,
                                             97, 98, 99, 100, 102, 103, 104, 105, 50, 119};
        const int kind = below(3);
        const int code = kind == 0   ? 24 + below(10)
                         : kind == 1 ? std::vector<int>{38 + below(9), 52 + below(7),
                                                        10 + below(10)}[static_cast<std::size_t>(below(3))]
                                     : others[static_cast<std::size_t>(below(static_cast<int>(others.size())))];
        press_key(code, 0.03 + 0.3 * share() * (below(6) == 0));
    }
    void type() {
        for (int i = below(6); i >= 0; --i) press_key(below(2) == 0 ? 10 + below(10) : 24 + below(10), 0.02);
        press_key(36, 0.02);
    }
    void tap() {
        // the controls' half of the window more often than the rest
        const double x = (below(2) == 0 ? 0.3 : 1.0) * x_px(), y = y_px();
        script_.row("pen", 0, "hover", x, y, 0.0);
        script_.t_s += 0.03;
        script_.row("pen", 0, "down", x, y, 0.3);
        script_.t_s += 0.06;
        script_.row("pen", 0, "up", x, y, 0.0);
        script_.t_s += 0.05;
    }
    void press() {
        double x = x_px(), y = y_px();
        script_.row("pen", 0, "hover", x, y, 0.0);
        script_.row("pen", 0, "down", x, y, 0.05);
        const double dx = 4.0 * (share() - 0.5), dy = 4.0 * (share() - 0.5), most = share();
        for (int i = below(200); i >= 0; --i) {
            script_.t_s += 0.008;
            x = std::clamp(x + dx, 0.0, 1279.0);
            y = std::clamp(y + dy, 0.0, 799.0);
            script_.row("pen", 0, "move", x, y, most * share());
            if (below(60) == 0) key();
        }
        script_.row("pen", 0, "up", x, y, 0.0);
    }
    // one or two fingers, which may be lifted in either order
    void touch() {
        const int fingers = 1 + below(2);
        std::vector<double> x, y;
        for (int id = 0; id < fingers; ++id) {
            x.push_back(x_px());
            y.push_back(y_px());
            script_.row("touch", id, "down", x.back(), y.back(), 0.2);
        }
        for (int i = below(60); i >= 0; --i) {
            script_.t_s += 0.01;
            for (int id = 0; id < fingers; ++id) {
                const auto at = static_cast<std::size_t>(id);
                x[at] = std::clamp(x[at] + 8.0 * (share() - 0.5), 0.0, 1279.0);
                script_.row("touch", id, "move", x[at], y[at], share());
            }
        }
        for (int id = fingers; id-- > 0;)
            script_.row("touch", id, "up", x[static_cast<std::size_t>(id)], y[static_cast<std::size_t>(id)], 0.0);
    }
    void mouse() {
        const double x = x_px(), y = y_px();
        script_.row("mouse", 0, "hover", x, y, 0.0);
        script_.row("mouse", 0, "down", x, y, 0.0);
        for (int i = below(6); i > 0; --i) script_.row("mouse", 0, "wheel", x, y, below(2) == 0 ? 1.0 : -1.0);
        script_.t_s += 0.3 * share();
        script_.row("mouse", 0, "up", x_px(), y_px(), 0.0);
    }

    std::mt19937_64 random_;
    Script script_;
};

// How the app is opened: the menus lead anywhere from there.
std::string opened(std::uint64_t seed, const TemporaryFolder& folder) {
    const std::string log = " --log " + (folder / "log").string();
    static const std::vector<std::string> ways{"run default",
                                               "run linear --test",
                                               "run tactile --simulate",
                                               "run tangible-block --simulate",
                                               "run button",
                                               "run --guided",
                                               "run touchpad",
                                               "run toothbrush --practice",
                                               "run --screen maps",
                                               "run --screen calibrate",
                                               "run tactile-arm",
                                               "run block-soft --simulate",
                                               "run --screen history",
                                               "run --screen scale",
                                               "run block-pins --simulate"};
    static const std::vector<std::string> protocols{"effects", "threshold", "paper", "softer"};
    const std::size_t at = seed % (ways.size() + protocols.size());
    if (at < ways.size()) return ways[at] + " --json" + log;
    return "study run " PALPA_SOURCE_DIR "/assets/protocols/" + protocols[at - ways.size()] + ".json" + log;
}

void check_written(const std::filesystem::path& folder) {
    if (!std::filesystem::exists(folder)) return;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string name = entry.path().extension().string();
        CAPTURE(entry.path().string());
        if (name == ".json") CHECK_NOTHROW(read_json(entry.path()));
        if (name != ".tsv" && name != ".json") continue;
        const std::string text = read_text(entry.path());
        for (const char* wrong : {"\tnan", "\t-nan", "\tinf", "\t-inf"}) CHECK_FALSE(contains(text, wrong));
    }
}

double number_of(const char* variable, double otherwise) {
    const char* text = ::getenv(variable);
    return text != nullptr ? std::stod(text) : otherwise;
}

}  // namespace

TEST_CASE("app: a hand that does anything at random") {
    const auto seed = static_cast<std::uint64_t>(number_of("PALPA_MONKEY_SEED", 0.0));
    const double seconds = number_of("PALPA_MONKEY_S", 20.0);
    CAPTURE(seed);
    const TemporaryFolder folder;
    Monkey(folder / "script.tsv", seed).play(seconds);
    const std::string arguments = opened(seed, folder);
    CAPTURE(arguments);
    const int status = run_program(folder, arguments, folder / "out.json", [&] {
        CHECK(play_script(folder) == 0);
        end_program(folder, "TERM");
    });
    CAPTURE(read_text(folder / "err.txt"));
    CHECK(status == 0);
    check_written(folder / "log");
}
