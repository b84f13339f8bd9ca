// The map browser on a real X server: a map chosen by mouse, depth by pen, kind and depth by keys, places pinned, and out
// again; what stands on the screen is watched all the while. Run it under tests/platform/xorg/with-xorg.

#include <algorithm>
#include <atomic>
#include <doctest/doctest.h>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "files/json.h"
#include "files/text.h"
#include "stiffnessmaps/map_file.h"
#include "tests/e2e/run_app.h"

// last: its macros are words of the others
#include <X11/Xlib.h>
#include <X11/Xutil.h>

using namespace palpa;
using namespace palpa::files;
using namespace palpa::stiffnessmaps;
using namespace palpa::test;

namespace {

struct Point {
    double x_px, y_px;
};
// The middle of controls, as the screenshot of a window of 1280 x 800 px shows them.
constexpr Point kMirrored{120, 299}, kSilicone{120, 339}, kShallower{26, 229}, kBack{85, 27}, kOnMatrix{560, 400};
enum Key { kB = 56, kEsc = 9, k1 = 10, k4 = 13, kI = 31, kO = 32, kPageDown = 105 };

class Script {
  public:
    explicit Script(const std::filesystem::path& file) : out_(file) {
        out_ << "t_s\tkind\tid\tphase\tx_px\ty_px\tpressure\n";
    }
    void wait(double seconds) { t_s_ += seconds; }
    void row(const char* kind, const char* phase, Point at, double pressure, int id = 0) {
        out_ << t_s_ << '\t' << kind << '\t' << id << '\t' << phase << '\t' << at.x_px << '\t' << at.y_px << '\t'
             << pressure << '\n';
    }
    void tap(const char* kind, Point at) {
        row(kind, kind[0] == 'm' ? "move" : "hover", at, 0.0);
        wait(0.2);
        row(kind, "down", at, 0.3);
        wait(0.15);
        row(kind, "up", at, 0.0);
        wait(kSettle_s);
    }
    void key(int code) {
        row("key", "down", {0, 0}, 0.0, code);
        wait(0.1);
        row("key", "up", {0, 0}, 0.0, code);
        wait(kSettle_s);
    }
    double close() {
        out_.close();
        return t_s_;
    }

  private:
    static constexpr double kSettle_s = 1.8;  // long beside what the watcher needs, also on a busy machine
    std::ofstream out_;
    double t_s_ = 0.5;
};

constexpr unsigned long kColours = 0xffffff;  // of 32 bits; what the fourth byte holds no display shows

// What stood for a while in a part of the screen, one after the other; a hash of the pixels.
class Watcher {
  public:
    Watcher(int x, int y, int width, int height)
        : thread_([=, this] {
              Display* display = ::XOpenDisplay(nullptr);
              std::size_t last = 0;
              int same = 0;
              while (display != nullptr && !over_) {
                  XImage* image = ::XGetImage(display, DefaultRootWindow(display), x, y, static_cast<unsigned>(width),
                                              static_cast<unsigned>(height), kColours, ZPixmap);
                  if (image == nullptr) break;
                  const std::string_view pixels(
                      image->data, static_cast<std::size_t>(image->bytes_per_line) * static_cast<std::size_t>(height));
                  const std::size_t now = std::hash<std::string_view>{}(pixels);
                  XDestroyImage(image);
                  same = now == last ? same + 1 : 0;
                  last = now;
                  if (same == 2 && (stood.empty() || stood.back() != now)) stood.push_back(now);
                  sleep_s(0.05);
              }
              if (display != nullptr) ::XCloseDisplay(display);
          }) {}
    ~Watcher() { stop(); }
    Watcher(const Watcher&) = delete;
    Watcher& operator=(const Watcher&) = delete;
    void stop() {
        over_ = true;
        if (thread_.joinable()) thread_.join();
    }
    std::vector<std::size_t> stood;

  private:
    std::atomic<bool> over_ = false;
    std::thread thread_;
};

// A second map in the person's own folder: the shipped one, mirrored.
void add_map(const TemporaryFolder& folder) {
    Map map = read_map(PALPA_SOURCE_DIR "/assets/maps/silicone.map");
    for (auto* forces : {&map.normal_N, &map.tangential_x_N, &map.tangential_y_N}) {
        for (std::size_t row = 0; row < forces->size(); row += map.n_x) {
            const auto from = forces->begin() + static_cast<std::ptrdiff_t>(row);
            std::reverse(from, from + static_cast<std::ptrdiff_t>(map.n_x));
        }
    }
    map.name = "mirrored";
    map.nodules.clear();
    const auto maps = folder / ".local/share/palpa/maps";
    std::filesystem::create_directories(maps);
    write_map(map, maps / "mirrored.map");
}

}  // namespace

TEST_CASE("maps: the browser by mouse, pen and keys draws what was asked for, and is left again") {
    const TemporaryFolder folder;
    add_map(folder);
    Script script(folder / "script.tsv");
    script.key(kB);                  // from the trial (a) to the shipped map's stiffness (b)
    script.key(k1);                  // its normal force, as deep as it goes (c)
    script.tap("mouse", kMirrored);  // the other one's (d)
    script.tap("pen", kShallower);   // one depth less (e)
    script.key(kPageDown);           // back (d)
    script.key(k4);                  // stiffness (f)
    script.key(k1);                  // back (d)
    script.tap("pen", kOnMatrix);    // a place pinned (g)
    script.row("pen", "hover", kBack, 0.0);
    script.wait(0.5);
    script.key(kI);                // a point moved by keys (h)
    script.key(kO);                // and pinned (i)
    script.tap("pen", kSilicone);  // the shipped one without pins (c)
    script.tap("pen", kBack);      // the trial (a)
    script.key(kB);                // opened anew (b)
    script.key(kEsc);              // the trial (a)
    const double played_s = script.close();
    const std::string arguments = "--practice --width-px 1280 --height-px 800 --quit-after-s " +
                                  std::to_string(played_s + 12.0) + " --screenshot " + (folder / "p.png").string();
    std::vector<std::size_t> stood;
    const int status = run_app(folder, arguments, [&] {
        Watcher watcher(262, 160, 420, 580);  // within the matrix, below what explains the button that the pen is over
        sleep_s(1.0);
        CHECK(play_script(folder) == 0);
        sleep_s(3.0);
        watcher.stop();
        stood = watcher.stood;
    });
    CAPTURE(read_text(folder / "err.txt"));
    REQUIRE(status == 0);
    CHECK(std::filesystem::exists(folder / "p.png"));
    std::string order;  // a letter for each picture, in the order they came up
    std::vector<std::size_t> pictures;
    for (const std::size_t picture : stood) {
        const auto known = std::find(pictures.begin(), pictures.end(), picture);
        order += static_cast<char>('a' + (known - pictures.begin()));
        if (known == pictures.end()) pictures.push_back(picture);
    }
    CAPTURE(order);
    CHECK(order == "abcdedfdghicaba");
}
