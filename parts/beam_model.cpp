#include "parts/beam_model.h"

#include <algorithm>
#include <cmath>

#include "mechanics/error.h"
#include "mechanics/voxel_load.h"
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

double place_of_load_m(const Part& part, const PartLoad& load, std::size_t axis, const FilledBox& box) {
    const double h = part.voxels.frame.pitch_m;
    if (!load.face) return load.at_m[axis];
    if (axis_of(*load.face) != static_cast<int>(axis)) return 0.5 * (box.low[axis] + box.high[axis]) * h;
    return (is_max(*load.face) ? box.high[axis] : box.low[axis]) * h;
}

BeamSpan beam_span(const Part& part, const PartLoad& load, const std::optional<double>& load_place_m) {
    if (!part.axis) return {0, 0, true, "the part names no axis"};
    if (largest_axis(load.direction) == *part.axis) return {0, 0, true, "the load is along the axis"};
    const BeamSpan unclamped{0, 0, true, "the part is not clamped by one side square to its axis, or one box"};
    if (part.supports.size() != 1 || part.supports[0].axes != 7) return unclamped;
    const PartSupport& support = part.supports[0];
    const auto axis = static_cast<std::size_t>(*part.axis);
    const FilledBox box = filled_box(part.voxels);
    const double h = part.voxels.frame.pitch_m;
    const double load_m = load_place_m ? *load_place_m : place_of_load_m(part, load, axis, box);
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

}  // namespace

PartBeam beam_of(const Part& part, const PartLoad& load, const std::optional<double>& load_place_m) {
    const BeamSpan span = beam_span(part, load, load_place_m);
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
    return out;
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
