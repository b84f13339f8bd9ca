#include "parts/beam_doubts.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "files/text.h"
#include "parts/cell_model.h"

namespace palpa::parts {
namespace {

using namespace mechanics;

// One slice of voxels across the axis. `across` counts along the direction that is neither the axis nor that of the load.
struct Cut {
    int across = 0;
    int along = 0;              // voxels along the load
    std::vector<int> material;  // -1: empty; across runs fastest
    int at(int i, int k) const {
        const bool inside = i >= 0 && k >= 0 && i < across && k < along;
        return inside ? material[static_cast<std::size_t>(i + across * k)] : -1;
    }
};

// Goes through the slices of a beam in order. `cursor`: for each line along x, the first run that ends beyond the slice;
// used by beams along x alone.
struct Cutter {
    const Voxels& voxels;
    BeamPlace place;
    std::vector<std::size_t> cursor;
};

void cut_along_x(int s, Cutter& cutter, Cut& out) {
    const bool y_across = cutter.place.bends == 2;
    for (int z = 0; z < cutter.voxels.size[2]; ++z) {
        for (int y = 0; y < cutter.voxels.size[1]; ++y) {
            const std::size_t line = line_of(cutter.voxels, y, z);
            const std::vector<Run>& runs = cutter.voxels.lines[line];
            std::size_t& run = cutter.cursor[line];
            while (run < runs.size() && runs[run].x1 <= s) ++run;
            const bool filled = run < runs.size() && runs[run].x0 <= s;
            const int i = y_across ? y : z, k = y_across ? z : y;
            out.material[static_cast<std::size_t>(i + out.across * k)] = filled ? runs[run].material : -1;
        }
    }
}

void cut_across_x(int s, const Cutter& cutter, Cut& out) {
    std::fill(out.material.begin(), out.material.end(), -1);
    const BeamPlace& place = cutter.place;
    const int others = cutter.voxels.size[static_cast<std::size_t>(3 - place.axis)];  // y and z add up to 3
    for (int other = 0; other < others; ++other) {
        const std::size_t line = place.axis == 1 ? line_of(cutter.voxels, s, other) : line_of(cutter.voxels, other, s);
        for (const Run& run : cutter.voxels.lines[line]) {
            for (int x = run.x0; x < run.x1; ++x) {
                const int i = place.bends == 0 ? other : x, k = place.bends == 0 ? x : other;
                out.material[static_cast<std::size_t>(i + out.across * k)] = run.material;
            }
        }
    }
}

void cut_at(int s, Cutter& cutter, Cut& out) {
    if (cutter.place.axis == 0)
        cut_along_x(s, cutter, out);
    else
        cut_across_x(s, cutter, out);
}

// Whether all filled voxels hang together by their sides.
bool in_one_piece(const Cut& slice) {
    std::vector<char> reached(slice.material.size(), 0);
    std::vector<std::array<int, 2>> next;
    const auto reach = [&](int i, int k) {
        if (slice.at(i, k) < 0) return;
        char& flag = reached[static_cast<std::size_t>(i + slice.across * k)];
        if (flag == 0) next.push_back({i, k});
        flag = 1;
    };
    const auto first = std::find_if(slice.material.begin(), slice.material.end(), [](int m) { return m >= 0; });
    if (first == slice.material.end()) return true;
    const auto place = static_cast<int>(first - slice.material.begin());
    reach(place % slice.across, place / slice.across);
    while (!next.empty()) {
        const auto [i, k] = next.back();
        next.pop_back();
        reach(i - 1, k);
        reach(i + 1, k);
        reach(i, k - 1);
        reach(i, k + 1);
    }
    const auto filled = std::count_if(slice.material.begin(), slice.material.end(), [](int m) { return m >= 0; });
    return std::count(reached.begin(), reached.end(), 1) == filled;
}

struct Moments {
    double weight = 0.0;  // sum of E
    double middle = 0.0;  // across, voxels
    double middle_along = 0.0;
    double turned = 0.0;    // Iyz / sqrt(Iyy Izz)
    int low = 0, high = 0;  // across, of what is filled
    double poisson = 0.0;   // the largest
    bool twists = false;    // open, and not symmetric about the plane of the load through its middle
};

// Of what is filled: the share, by E, that has not the same material in its mirror image across.
double unlike_its_image(const Cut& slice, const std::vector<Material>& materials, const Moments& m) {
    double unlike = 0.0;
    for (int k = 0; k < slice.along; ++k) {
        for (int i = 0; i < slice.across; ++i) {
            const int material = slice.at(i, k);
            if (material < 0) continue;
            const int image = static_cast<int>(std::floor(2.0 * m.middle - (i + 0.5)));
            if (slice.at(image, k) != material) unlike += materials[static_cast<std::size_t>(material)].young_Pa;
        }
    }
    return unlike / m.weight;
}

Moments moments_of(const Cut& slice, const std::vector<Material>& materials) {
    Moments out;
    out.low = slice.across;
    double sum_k = 0.0, sum_ii = 0.0, sum_kk = 0.0, sum_ik = 0.0, filled = 0.0;
    int low_k = slice.along, high_k = 0;
    for (int k = 0; k < slice.along; ++k) {
        for (int i = 0; i < slice.across; ++i) {
            const int material = slice.at(i, k);
            if (material < 0) continue;
            const double E = materials[static_cast<std::size_t>(material)].young_Pa;
            out.weight += E;
            out.middle += E * (i + 0.5);
            sum_k += E * k;
            sum_ii += E * i * i;
            sum_kk += E * k * k;
            sum_ik += E * i * k;
            out.low = std::min(out.low, i);
            out.high = std::max(out.high, i + 1);
            low_k = std::min(low_k, k);
            high_k = std::max(high_k, k + 1);
            ++filled;
            out.poisson = std::max(out.poisson, materials[static_cast<std::size_t>(material)].poisson);
        }
    }
    if (!(out.weight > 0.0)) return out;
    const double i_mean = out.middle / out.weight - 0.5, k_mean = sum_k / out.weight;
    const double ii = sum_ii / out.weight - i_mean * i_mean + 1.0 / 12.0;  // a voxel's own too
    const double kk = sum_kk / out.weight - k_mean * k_mean + 1.0 / 12.0;
    out.middle /= out.weight;
    out.middle_along = k_mean;
    const bool open = filled < kOpen * (out.high - out.low) * (high_k - low_k);
    out.twists = open && unlike_its_image(slice, materials, out) > kMostUnlike;
    out.turned = std::abs(sum_ik / out.weight - i_mean * k_mean) / std::sqrt(ii * kk);
    return out;
}

// What the slices of a beam have in common.
struct Sections {
    int count = 0, split = 0, turned = 0, twists = 0;
    double split_at_m = 0.0;
    double strays = 0.0;  // how far the middle goes to and fro, of all; voxels
    double most_turned = 0.0;
    double middle = 0.0;   // across, of all; voxels
    double width = 0.0;    // mean; voxels
    double poisson = 0.0;  // the largest
};

Sections sections_of(const Part& part, const BeamPlace& place) {
    const std::vector<Material> materials = elastic_of(part);
    const double h = part.voxels.frame.pitch_m;
    const double origin_m = part.voxels.frame.origin_m[static_cast<std::size_t>(place.axis)];
    const int slices = part.voxels.size[static_cast<std::size_t>(place.axis)];
    const int first = std::clamp(static_cast<int>(std::floor((place.low_m - origin_m) / h + 0.5)), 0, slices);
    const int end = std::clamp(static_cast<int>(std::floor((place.high_m - origin_m) / h + 0.5)), first, slices);
    Cutter cutter{part.voxels, place, {}};
    if (place.axis == 0) cutter.cursor.assign(part.voxels.lines.size(), 0);
    const auto third = static_cast<std::size_t>(3 - place.axis - place.bends);
    Cut cut{part.voxels.size[third], part.voxels.size[static_cast<std::size_t>(place.bends)], {}};
    cut.material.resize(static_cast<std::size_t>(cut.across) * static_cast<std::size_t>(cut.along));
    Sections out;
    Cut before;
    Moments m, last;
    bool whole = true;
    for (int s = first; s < end; ++s) {
        cut_at(s, cutter, cut);
        if (cut.material != before.material) {  // most slices are as the one before
            m = moments_of(cut, materials);
            whole = in_one_piece(cut);
            before = cut;
        }
        if (!(m.weight > 0.0)) continue;
        if (out.count > 0) out.strays += std::hypot(m.middle - last.middle, m.middle_along - last.middle_along);
        last = m;
        ++out.count;
        out.middle += m.middle;
        out.width += m.high - m.low;
        out.most_turned = std::max(out.most_turned, m.turned);
        out.poisson = std::max(out.poisson, m.poisson);
        if (m.turned > kMostTurned) ++out.turned;
        if (m.twists) ++out.twists;
        if (whole) continue;
        if (out.split++ == 0) out.split_at_m = origin_m + (s + 0.5) * h;
    }
    out.middle /= std::max(1, out.count);
    out.width /= std::max(1, out.count);
    return out;
}

}  // namespace

std::string section_doubt(const Part& part, const PartLoad& load, const BeamPlace& place) {
    const Sections sections = sections_of(part, place);
    const double h = part.voxels.frame.pitch_m, length_m = place.high_m - place.low_m;
    const auto mm = [](double m) { return files::short_number(1e3 * m) + " mm"; };
    if (sections.split > kMostOdd * sections.count)
        return "its section is in pieces that do not touch, from " + mm(sections.split_at_m) +
               " along the axis: they bend one by one";
    if (sections.turned > kMostOdd * sections.count)
        return "its section is turned against the plane of the load (Iyz is " +
               files::short_number(100.0 * sections.most_turned) + " % of sqrt(Iyy Izz)): it gives way sideways too";
    if (sections.strays > kMostStray * sections.count)
        return "the middle of its sections strays by " + mm(h * sections.strays) + " in all over " + mm(length_m) +
               ": it is no straight beam";
    if (sections.twists > kMostOdd * sections.count)
        return "its section is open, and not symmetric about the plane of the load: it twists too";
    const auto third = static_cast<std::size_t>(3 - place.axis - place.bends);
    const double beside_m = std::abs(load.at_m[third] - part.voxels.frame.origin_m[third] - h * sections.middle);
    if (!load.face && beside_m > 0.5 * h * sections.width)
        return "the load is " + mm(beside_m) + " beside the axis and twists it";
    if (h * sections.width > kPlate * length_m && sections.poisson > 0.2)
        return "it is " + mm(h * sections.width) + " wide and " + mm(length_m) + " long: a plate, up to " +
               files::short_number(100.0 / (1.0 - sections.poisson * sections.poisson) - 100.0) + " % stiffer";
    return "";
}

}  // namespace palpa::parts
