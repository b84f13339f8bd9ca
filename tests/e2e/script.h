#pragma once
// What a person does in the app, as the rows that tests/platform/xorg/xorg_pen plays.

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace palpa::test {

// Keycodes of X.
inline constexpr int kEscape = 9, k1 = 10, kT = 28, kEnter = 36, kF = 41, kG = 42, kZ = 52, kF12 = 96;

struct Script {
    std::ofstream out;
    double t_s = 0.0;
    explicit Script(const std::filesystem::path& file) : out(file) {
        out << "t_s\tkind\tid\tphase\tx_px\ty_px\tpressure\n";
    }
    void row(const char* kind, int id, const char* phase, double x, double y, double pressure) {
        out << t_s << '\t' << kind << '\t' << id << '\t' << phase << '\t' << x << '\t' << y << '\t' << pressure << '\n';
    }
    // Holds up all that follows until `file` is there.
    void wait(const std::filesystem::path& file) { out << t_s << "\twait\t" << file.string() << '\n'; }
    void key(int code) {
        row("key", code, "down", 0.0, 0.0, 0.0);
        t_s += 0.1;
        row("key", code, "up", 0.0, 0.0, 0.0);
        t_s += 0.5;
    }
    // A press in the middle of the tissue, rising within a second.
    void press(double seconds) {
        const double x = 0.5 * (64.0 * 96.0 / 25.4 + 1280.0), y = 400.0;
        row("pen", 0, "hover", x, y, 0.0);
        t_s += 0.1;
        row("pen", 0, "down", x, y, 0.05);
        for (double after_s = 0.0; after_s < seconds; after_s += 0.01) {
            t_s += 0.01;
            row("pen", 0, "move", x + 0.01 * after_s, y, std::min(0.6, 0.05 + 0.6 * after_s));
        }
        row("pen", 0, "up", x, y, 0.0);
        t_s += 0.2;
    }
};

}  // namespace palpa::test
