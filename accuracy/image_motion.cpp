#include "accuracy/image_motion.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace palpa::accuracy {
namespace {

constexpr int kBlock_px = 24;  // about half of the indenter in a window of 1280 x 800
constexpr int kStride_px = 8;
constexpr double kSharp_px =
    1.5;  // what is finer than this, steps of thin lines above all, the eye does not tell apart
constexpr double kShading_px = 6.0;   // what is smoother than this is shading, and no feature that could move
constexpr double kUnchanged = 1.0;    // mean square of grey levels, 0 ... 255: less is no change
constexpr double kFeatureless = 0.3;  // mean square slope (grey levels / px) in the direction where it is least
constexpr double kLeft = 0.25;        // share of the change that a match may leave unexplained
constexpr double kHopeful = 0.6;      // the same at whole pixels, before it is refined
constexpr double kWayBack_px = 1.0;   // how far the way back may miss, since it starts at a whole pixel
constexpr double kAlike_px = 0.5;
constexpr int kRefinements = 8;
constexpr double kDamping = 3.0;  // against sums over a block of squares of slopes

struct Match {
    double dx_px = 0.0;
    double dy_px = 0.0;
    double left = 0.0;   // mean square difference there
    double there = 0.0;  // and without any motion
};

// Returns the grey levels without brightness and shading.
cv::Mat features_of(const Pixels& pixels) {
    // OpenCV takes no pointer to const, and does not write here
    const cv::Mat rgb(pixels.height_px, pixels.width_px, CV_8UC3, const_cast<unsigned char*>(pixels.rgb.data()));
    cv::Mat grey;
    cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
    grey.convertTo(grey, CV_32F);
    cv::Mat shading;
    cv::GaussianBlur(grey, shading, cv::Size(), kShading_px);
    cv::GaussianBlur(grey, grey, cv::Size(), kSharp_px);
    return grey - shading;
}

// Returns the mean square slope of the block in the direction where it is least: 0 for a straight edge.
double least_slope(const cv::Mat& picture, const cv::Rect& block) {
    cv::Mat along_x;
    cv::Mat along_y;
    cv::Sobel(picture(block), along_x, CV_32F, 1, 0, 1, 0.5);
    cv::Sobel(picture(block), along_y, CV_32F, 0, 1, 1, 0.5);
    const double area = kBlock_px * kBlock_px;
    const double xx = along_x.dot(along_x) / area;
    const double yy = along_y.dot(along_y) / area;
    const double xy = along_x.dot(along_y) / area;
    return 0.5 * (xx + yy) - std::hypot(0.5 * (xx - yy), xy);
}

double mean_square(const cv::Mat& difference) { return difference.dot(difference) / (kBlock_px * kBlock_px); }

double at(const cv::Mat& score, int x, int y) { return static_cast<double>(score.at<float>(y, x)); }

bool is_valley(const cv::Mat& score, int x, int y) {
    for (int j = std::max(0, y - 1); j <= std::min(score.rows - 1, y + 1); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(score.cols - 1, x + 1); ++i)
            if (at(score, i, j) < at(score, x, y)) return false;
    return true;
}

// The block at `shift_px` from its place, between pixels.
cv::Mat shifted(const cv::Mat& picture, const cv::Rect& block, const cv::Point2d& shift_px) {
    const cv::Point2d middle(block.x + 0.5 * (kBlock_px - 1) + shift_px.x,
                             block.y + 0.5 * (kBlock_px - 1) + shift_px.y);
    cv::Mat out;
    cv::getRectSubPix(picture, block.size(), cv::Point2f(middle), out);
    return out;
}

// Refines a match to a fraction of a pixel by Gauss-Newton on the squared difference (Lucas & Kanade, IJCAI 1981), with a
// little damping where the block has no features in some direction.
void refine(const cv::Mat& from, const cv::Rect& block, const cv::Mat& to, Match& match) {
    const cv::Mat still = from(block);
    cv::Point2d shift_px(match.dx_px, match.dy_px);
    for (int i = 0; i < kRefinements; ++i) {
        const cv::Mat difference = still - shifted(to, block, shift_px);
        const cv::Point2d right(0.5, 0.0);
        const cv::Point2d down(0.0, 0.5);
        const cv::Mat along_x = shifted(to, block, shift_px + right) - shifted(to, block, shift_px - right);
        const cv::Mat along_y = shifted(to, block, shift_px + down) - shifted(to, block, shift_px - down);
        const double xx = along_x.dot(along_x) + kDamping;
        const double yy = along_y.dot(along_y) + kDamping;
        const double xy = along_x.dot(along_y);
        const double x = along_x.dot(difference);
        const double y = along_y.dot(difference);
        const double determinant = xx * yy - xy * xy;
        shift_px += cv::Point2d((yy * x - xy * y) / determinant, (xx * y - xy * x) / determinant);
    }
    const bool near = std::hypot(shift_px.x - match.dx_px, shift_px.y - match.dy_px) < kWayBack_px;
    if (!near) return;  // it slid away along an edge
    const cv::Mat difference = still - shifted(to, block, shift_px);
    match.dx_px = shift_px.x;
    match.dy_px = shift_px.y;
    match.left = mean_square(difference);
}

// Returns where the search for a block of `from` in `to` may end, the nearest first: the valleys of the difference, and the
// place where the block was.
std::vector<Match> candidates(const cv::Mat& from, const cv::Rect& block, const cv::Mat& to, double longest_px) {
    const int reach_px = static_cast<int>(std::ceil(longest_px));
    cv::Rect around(block.x - reach_px, block.y - reach_px, kBlock_px + 2 * reach_px, kBlock_px + 2 * reach_px);
    around &= cv::Rect(0, 0, to.cols, to.rows);
    cv::Mat score;
    cv::matchTemplate(to(around), from(block), score, cv::TM_SQDIFF);
    score *= 1.0 / (kBlock_px * kBlock_px);
    const int x0 = block.x - around.x;
    const int y0 = block.y - around.y;
    const double there = at(score, x0, y0);
    std::vector<Match> out{{0.0, 0.0, there, there}};
    for (int y = 0; y < score.rows; ++y) {
        for (int x = 0; x < score.cols; ++x) {
            if (std::hypot(x - x0, y - y0) > longest_px) continue;
            if (at(score, x, y) < kHopeful * there && is_valley(score, x, y))
                out.push_back({static_cast<double>(x - x0), static_cast<double>(y - y0), at(score, x, y), there});
        }
    }
    std::sort(out.begin(), out.end(), [](const Match& a, const Match& b) {
        return std::hypot(a.dx_px, a.dy_px) < std::hypot(b.dx_px, b.dy_px);
    });
    return out;
}

// Returns the nearest match that explains the change.
std::optional<Match> match(const cv::Mat& from, const cv::Rect& block, const cv::Mat& to, double longest_px) {
    for (Match& candidate : candidates(from, block, to, longest_px)) {
        refine(from, block, to, candidate);
        if (candidate.left <= kLeft * candidate.there) return candidate;
    }
    return std::nullopt;
}

// Returns the part of the picture whose features are not disturbed by its edge.
cv::Rect middle_of(const cv::Mat& picture) {
    const int margin_px = static_cast<int>(3.0 * kShading_px);
    return {margin_px, margin_px, picture.cols - 2 * margin_px, picture.rows - 2 * margin_px};
}

std::optional<BlockMotion> motion_of(const cv::Mat& before, const cv::Mat& after, const cv::Rect& block,
                                     double longest_px) {
    const std::optional<Match> way = match(before, block, after, longest_px);
    if (!way) return std::nullopt;
    cv::Rect there = block;
    there.x += static_cast<int>(std::lround(way->dx_px));
    there.y += static_cast<int>(std::lround(way->dy_px));
    if ((there & middle_of(after)) != there) return std::nullopt;
    // what looked like this before already has not moved here
    if (there != block && mean_square(before(block) - before(there)) < kLeft * way->there) return std::nullopt;
    const std::optional<Match> back = match(after, there, before, longest_px);
    if (!back || std::hypot(there.x + back->dx_px - block.x, there.y + back->dy_px - block.y) > kWayBack_px)
        return std::nullopt;
    return BlockMotion{block.x + 0.5 * kBlock_px, block.y + 0.5 * kBlock_px, way->dx_px, way->dy_px};
}

// Returns whether at least two of the neighbouring blocks moved alike.
bool is_confirmed(const BlockMotion& motion, const std::vector<BlockMotion>& moved) {
    const auto alike = std::count_if(moved.begin(), moved.end(), [&](const BlockMotion& other) {
        const bool beside =
            std::max(std::abs(other.x_px - motion.x_px), std::abs(other.y_px - motion.y_px)) < 1.5 * kStride_px;
        return beside && std::hypot(other.dx_px - motion.dx_px, other.dy_px - motion.dy_px) < kAlike_px;
    });
    return alike >= 3;  // with the block itself
}

}  // namespace

double BlockMotion::length_px() const { return std::hypot(dx_px, dy_px); }

BlockMotion greatest_motion(const Pixels& before, const Pixels& after, double longest_px) {
    longest_px = std::min(longest_px, kReach_px);
    assert(before.width_px == after.width_px && before.height_px == after.height_px);
    const cv::Mat from = features_of(before);
    const cv::Mat to = features_of(after);
    const cv::Mat change = to - from;
    std::vector<BlockMotion> moved;
    const cv::Rect middle = middle_of(from);
    for (int y = middle.y; y + kBlock_px <= middle.br().y; y += kStride_px) {
        for (int x = middle.x; x + kBlock_px <= middle.br().x; x += kStride_px) {
            const cv::Rect block(x, y, kBlock_px, kBlock_px);
            if (mean_square(change(block)) < kUnchanged) continue;
            if (least_slope(from, block) < kFeatureless) continue;
            if (const auto motion = motion_of(from, to, block, longest_px)) moved.push_back(*motion);
        }
    }
    BlockMotion greatest;
    for (const BlockMotion& motion : moved) {
        if (motion.length_px() > greatest.length_px() && is_confirmed(motion, moved)) greatest = motion;
    }
    return greatest;
}

}  // namespace palpa::accuracy
