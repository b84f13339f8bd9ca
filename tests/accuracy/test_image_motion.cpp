#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>
#include <vector>

#include "accuracy/image_motion.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::accuracy;

namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

struct Blob {
    double x, y, height;
};

// Smooth blobs at random places, so that nothing repeats; 48 ... 208.
double pattern(double x, double y) {
    static const std::vector<Blob> blobs = [] {
        std::mt19937 random(20261122);
        std::uniform_real_distribution<double> place(-80.0, 400.0);
        std::uniform_real_distribution<double> height(-60.0, 60.0);
        std::vector<Blob> out(900);
        for (Blob& blob : out) blob = {place(random), place(random), height(random)};
        return out;
    }();
    double grey = 128.0;
    for (const Blob& blob : blobs) {
        const double r2 = (x - blob.x) * (x - blob.x) + (y - blob.y) * (y - blob.y);
        if (r2 < 256.0) grey += blob.height * std::exp(-r2 / 32.0);
    }
    return std::clamp(grey, 48.0, 208.0);
}

// Draws value(x, y), 0 ... 255, as grey.
template <class Value>
Pixels picture(const Value& value) {
    Pixels out{kWidth, kHeight, {}};
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const auto grey = static_cast<unsigned char>(std::lround(value(x, y)));
            out.rgb.insert(out.rgb.end(), 3, grey);
        }
    }
    return out;
}

// A shaded disc of 25 px with a bright spot, on a faint pattern.
Pixels disc_at(double cx, double cy) {
    return picture([=](int x, int y) {
        const double r = std::hypot(x - cx, y - cy);
        const double background = 190.0 + 0.1 * (pattern(x, y) - 128.0);
        const double spot = std::exp(-(std::pow(x - cx + 8.0, 2.0) + std::pow(y - cy + 8.0, 2.0)) / 18.0);
        const double disc = 60.0 + 1.5 * std::sqrt(std::max(0.0, 625.0 - r * r)) + 100.0 * spot;
        const double inside = std::clamp(25.5 - r, 0.0, 1.0);
        return background + inside * (disc - background);
    });
}

}  // namespace

TEST_CASE("image motion: a shifted pattern moves by the shift, to a tenth of a pixel") {
    const Pixels before = picture([](int x, int y) { return pattern(x, y); });
    struct Row {
        double dx, dy;
    };
    for (const Row& row : {Row{1, 0}, {0, -2}, {3.4, -1.7}, {-12.25, 7.5}, {31.6, 20.3}, {-1.5, 0.5}}) {
        CAPTURE(row.dx);
        CAPTURE(row.dy);
        const Pixels after = picture([&](int x, int y) { return pattern(x - row.dx, y - row.dy); });
        const BlockMotion motion = greatest_motion(before, after);
        CHECK(std::abs(motion.dx_px - row.dx) < 0.1);
        CHECK(std::abs(motion.dy_px - row.dy) < 0.1);
    }
}

TEST_CASE("image motion: nothing is taken to have moved farther than it can have") {
    const Pixels before = picture([](int x, int y) { return pattern(x, y); });
    const Pixels after = picture([](int x, int y) { return pattern(x - 31.6, y - 20.3); });
    CHECK(greatest_motion(before, after).length_px() == close_to(std::hypot(31.6, 20.3)).epsilon(0.01));
    CHECK(greatest_motion(before, after, 38.0).length_px() > 37.0);
    CHECK(greatest_motion(before, after, 36.0).length_px() < 36.1);
}

TEST_CASE("image motion: what moves over a resting background is found") {
    for (const double shift_px : {2.5, 10.0, 17.3, 48.0}) {
        CAPTURE(shift_px);
        const BlockMotion motion = greatest_motion(disc_at(130, 120), disc_at(130 + shift_px, 120));
        CHECK(std::abs(motion.dx_px - shift_px) < 0.5);
        CHECK(std::abs(motion.dy_px) < 0.5);
        CHECK(std::hypot(motion.x_px - 130, motion.y_px - 120) < 25.0 + 17.0);  // the block touches the disc
    }
}

TEST_CASE("image motion: a net that is pulled is not taken for its next mesh") {
    // lines 50 px apart, pulled to the right by up to 12 px around the middle
    const auto net = [](double pull_px) {
        return picture([=](int x, int y) {
            const double r2 = std::pow(x - 160.0, 2.0) + std::pow(y - 120.0, 2.0);
            const double from_x = x - pull_px * std::exp(-r2 / (2.0 * 80.0 * 80.0));
            const auto line = [](double at) { return std::exp(-std::pow(std::remainder(at, 50.0), 2.0) / 2.0); };
            return 180.0 - 60.0 * std::max(line(from_x), line(y));
        });
    };
    const BlockMotion motion = greatest_motion(net(0.0), net(12.0));
    CHECK(motion.dx_px > 8.0);
    CHECK(motion.dx_px < 13.0);
    CHECK(std::abs(motion.dy_px) < 1.0);
}

TEST_CASE("image motion: equal pictures, noise and a change of brightness are no motion") {
    const Pixels still = picture([](int x, int y) { return pattern(x, y); });
    CHECK(greatest_motion(still, still).length_px() == 0.0);
    const Pixels brighter = picture([](int x, int y) { return 20.0 + pattern(x, y); });
    CHECK(greatest_motion(still, brighter).length_px() == 0.0);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> noise(-6.0, 6.0);
    const Pixels noisy = picture([&](int x, int y) { return pattern(x, y) + noise(random); });
    CHECK(greatest_motion(still, noisy).length_px() < 0.1);
}

TEST_CASE("image motion: a pattern that repeats cannot feign a long way") {
    const auto dots = [](double x, double y) { return 128.0 + 50.0 * std::sin(0.4 * x) + 50.0 * std::sin(0.4 * y); };
    const Pixels before = picture([&](int x, int y) { return dots(x, y); });
    const Pixels after = picture([&](int x, int y) { return dots(x - 3.0, y); });
    const BlockMotion motion = greatest_motion(before, after);
    CHECK(std::abs(motion.dx_px - 3.0) < 0.1);
    CHECK(std::abs(motion.dy_px) < 0.1);
    // along a straight edge nothing can be seen to move
    const Pixels stripes = picture([&](int x, int) { return 128.0 + 60.0 * std::sin(0.4 * x); });
    CHECK(greatest_motion(stripes, stripes).length_px() == 0.0);
}
