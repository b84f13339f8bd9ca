#include "parts/beam_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "files/text.h"
#include "mechanics/error.h"
#include "mechanics/voxel_load.h"
#include "parts/beam_doubts.h"
#include "parts/cell_model.h"

namespace palpa::parts {
namespace {

using namespace mechanics;

// Where the beam begins and ends: at its clamp and under the load.
struct BeamSpan {
    double low_m = 0.0;
    double high_m = 0.0;
    bool clamped_low = true;
    std::string why_not;
};

double middle(const std::array<double, 2>& stretch) { return 0.5 * (stretch[0] + stretch[1]); }

// The part's stretch of the axis over which the load is spread.
std::array<double, 2> loaded_m(const Part& part, const PartLoad& load, std::size_t axis, const FilledBox& box) {
    const double h = part.voxels.frame.pitch_m;
    const double low_m = box.low[axis] * h, high_m = box.high[axis] * h;
    if (!load.face) {
        const double radius_m = 0.5 * load.patch_m, at_m = load.at_m[axis];
        return {std::max(low_m, at_m - radius_m), std::min(high_m, at_m + radius_m)};
    }
    if (axis_of(*load.face) != static_cast<int>(axis)) return {low_m, high_m};
    return is_max(*load.face) ? std::array{high_m, high_m} : std::array{low_m, low_m};
}

}  // namespace

double load_place_m(const Part& part, const PartLoad& load) {
    return middle(loaded_m(part, load, static_cast<std::size_t>(*part.axis), filled_box(part.voxels)));
}

namespace {

BeamSpan beam_span(const Part& part, const PartLoad& load, const std::optional<double>& place_m) {
    if (!part.axis) return {0, 0, true, "the part names no axis"};
    if (largest_axis(load.direction) == *part.axis) {
        const bool straight = std::abs(load.direction[static_cast<std::size_t>(*part.axis)]) > 1.0 - 1e-6;
        return {0, 0, true,
                straight ? "the load is along the axis" : "the load is no less along the axis than across it"};
    }
    const BeamSpan unclamped{0, 0, true, "the part is not clamped by one side square to its axis, or one box"};
    if (part.supports.size() != 1 || part.supports[0].axes != 7) return unclamped;
    const PartSupport& support = part.supports[0];
    const auto axis = static_cast<std::size_t>(*part.axis);
    const FilledBox box = filled_box(part.voxels);
    const double h = part.voxels.frame.pitch_m;
    const double load_m = place_m ? *place_m : load_place_m(part, load);
    double low_m = box.low[axis] * h, high_m = box.high[axis] * h;  // of the clamp
    if (support.face) {
        if (axis_of(*support.face) != *part.axis) return unclamped;
        if (is_max(*support.face)) {
            low_m = high_m;
        } else {
            high_m = low_m;
        }
    } else {
        const auto* held = std::get_if<BoxRegion>(&support.region.shape);
        if (held == nullptr) return unclamped;
        low_m = std::max(low_m, held->min_m[axis]);
        high_m = std::min(high_m, held->max_m[axis]);
    }
    if (load_m > high_m + h) return {high_m, load_m, true, ""};
    if (load_m < low_m - h) return {load_m, low_m, false, ""};
    return {0, 0, true, "the load is at the clamp"};
}

std::string doubt_of(const Part& part, const PartLoad& load, int bends, double length_m) {
    const auto axis = static_cast<std::size_t>(*part.axis);
    const auto third = static_cast<std::size_t>(3 - *part.axis - bends);
    const double oblique = std::abs(load.direction[third] / load.direction[static_cast<std::size_t>(bends)]);
    if (oblique > kMostOblique) {
        return "the load is oblique across the section: its part along " + std::string(1, "xyz"[third]) + ", " +
               files::short_number(100.0 * oblique) + " % of that along " + std::string(1, "xyz"[bends]) +
               ", is left out";
    }
    const std::array<double, 2> loaded = loaded_m(part, load, axis, filled_box(part.voxels));
    const double spread = 0.5 * (loaded[1] - loaded[0]) / length_m;
    if (spread <= kMostSpread) return "";
    return "the load is spread along the beam over " + files::short_number(2e3 * spread * length_m) +
           " mm and taken as one force " + files::short_number(1e3 * length_m) + " mm from the clamp";
}

}  // namespace

PartBeam beam_of(const Part& part, const PartLoad& load, const std::optional<double>& place_m) {
    const BeamSpan span = beam_span(part, load, place_m);
    PartBeam out;
    out.why_not = span.why_not;
    if (!out.why_not.empty()) return out;
    const int bends = largest_axis(load.direction);
    try {
        out.pieces = beam_pieces(part.voxels, elastic_of(part), *part.axis, bends, span.low_m, span.high_m);
    } catch (const MeshError& error) {
        out.why_not = error.what();
        return out;
    }
    out.clamped_low = span.clamped_low;
    out.length_m = span.high_m - span.low_m;
    for (const BeamPiece& piece : out.pieces) out.height_m = std::max(out.height_m, piece.height_m);
    out.across = std::abs(load.direction[static_cast<std::size_t>(bends)]);
    if (!place_m) out.doubt = doubt_of(part, load, bends, out.length_m);
    if (!place_m && out.doubt.empty())
        out.doubt = section_doubt(part, load, {*part.axis, bends, span.low_m, span.high_m});
    return out;
}

std::string axial_doubt(const Part& part, const PartLoad& load) {
    if (!part.axis) return "";
    const auto axis = static_cast<std::size_t>(*part.axis);
    const double along = load.direction[axis];
    if (along == 0.0) return "";
    const double across = std::sqrt(std::max(0.0, 1.0 - along * along));
    bool clamped_low = true;
    double buckling_N = std::numeric_limits<double>::infinity();
    for (const std::size_t bends : {(axis + 1) % 3, (axis + 2) % 3}) {
        PartLoad sideways = load;
        sideways.direction = {};
        sideways.direction[bends] = 1.0;
        const BeamSpan span = beam_span(part, sideways, {});
        if (!span.why_not.empty()) return "";
        clamped_low = span.clamped_low;
        std::vector<BeamPiece> pieces;
        try {
            pieces = beam_pieces(part.voxels, elastic_of(part), *part.axis, static_cast<int>(bends), span.low_m,
                                 span.high_m);
        } catch (const MeshError&) {
            return "";
        }
        buckling_N = std::min(buckling_N, euler_load_N(pieces, clamped_low));
    }
    const bool presses = (along > 0.0) != clamped_low;
    const double share = std::abs(along) * load.force_N / buckling_N;
    const std::string at = "the force along the axis is " + files::short_number(100.0 * share) + " % of the " +
                           files::short_number(buckling_N) + " N at which the part buckles";
    if (presses && share > kMostColumn) return at;
    if (across < kStraight || share <= kMostAxial) return "";
    return at + (presses ? ", and bends it further" : ", and pulls it straight") +
           ", which small displacements leave out";
}

double paper_spring_N_per_m(const PartBeam& beam) {
    double gamma = 0.0, theta = 0.0;  // per newton
    for (std::size_t i = 0; i < beam.pieces.size(); ++i) {
        const BeamPiece& piece = beam.pieces[beam.clamped_low ? i : beam.pieces.size() - 1 - i];
        const double l_m = piece.to_m - piece.from_m;
        gamma += beam.length_m * l_m * l_m / (2.0 * piece.section.bending_N_m2);
        theta += gamma * l_m / beam.length_m;
    }
    return 1.0 / theta;
}

}  // namespace palpa::parts
