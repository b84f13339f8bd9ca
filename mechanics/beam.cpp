#include "mechanics/beam.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "mechanics/error.h"
#include "mechanics/index.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

// Voxels of each material in each row of each slice, as whole numbers, so that equal sections are equal.
struct SliceCounts {
    std::size_t slices = 0, rows = 0, materials = 0;
    std::vector<int> n;  // slices + 1: one more takes the ends of runs
    int& at_place(int slice, int row, int material) {
        return n[at(material) + materials * (at(row) + rows * at(slice))];
    }
    std::span<const int> slice(std::size_t s) const {
        return std::span<const int>(n).subspan(s * rows * materials, rows * materials);
    }
};

void add_run(const Run& run, const std::array<int, 3>& start, int axis, int row_axis, SliceCounts& out) {
    if (axis == 0) {  // differences along the axis, summed up later
        out.at_place(run.x0, start[at(row_axis)], run.material) += 1;
        out.at_place(run.x1, start[at(row_axis)], run.material) -= 1;
    } else if (row_axis == 0) {
        for (int x = run.x0; x < run.x1; ++x) out.at_place(start[at(axis)], x, run.material) += 1;
    } else {
        out.at_place(start[at(axis)], start[at(row_axis)], run.material) += run.x1 - run.x0;
    }
}

SliceCounts count_slices(const Voxels& voxels, std::size_t n_materials, int axis, int row_axis) {
    SliceCounts out{at(voxels.size[at(axis)]), at(voxels.size[at(row_axis)]), n_materials, {}};
    out.n.assign((out.slices + 1) * out.rows * out.materials, 0);
    for (int z = 0; z < voxels.size[2]; ++z) {
        for (int y = 0; y < voxels.size[1]; ++y) {
            for (const Run& run : voxels.lines[line_of(voxels, y, z)]) {
                if (run.material >= static_cast<int>(n_materials))
                    throw MaterialError(text("material ", run.material, " of ", n_materials), {run.material});
                add_run(run, {0, y, z}, axis, row_axis, out);
            }
        }
    }
    const std::size_t stride = out.rows * out.materials;
    for (std::size_t i = stride; axis == 0 && i < out.n.size(); ++i) out.n[i] += out.n[i - stride];
    return out;
}

std::vector<SectionRow> rows_of(std::span<const int> counts, std::span<const Material> materials, double origin_m,
                                double h) {
    std::vector<SectionRow> rows;
    for (std::size_t row = 0; row * materials.size() < counts.size(); ++row) {
        SectionRow layer{origin_m + static_cast<double>(row) * h, origin_m + static_cast<double>(row + 1) * h, 0.0,
                         0.0};
        for (std::size_t m = 0; m < materials.size(); ++m) {
            const double width_m = counts[row * materials.size() + m] * h;
            layer.axial_N_per_m += materials[m].young_Pa * width_m;
            layer.shear_N_per_m += mu_Pa(materials[m]) * width_m;
        }
        if (layer.axial_N_per_m > 0.0) rows.push_back(layer);
    }
    return rows;
}

// int Q^2 / (G b) dz over a row in which Q falls from `above` at its top: Q(z) = above + E b int_z^top (z' - z_n) dz'.
// Q^2 has degree 4, for which three Gauss points are exact.
double shear_energy(const SectionRow& row, double neutral_m, double above) {
    constexpr std::array<double, 3> kWeight{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    const double t = row.high_m - row.low_m, top = row.high_m - neutral_m;
    double sum = 0.0;
    for (std::size_t g = 0; g < 3; ++g) {
        const double down_m = t * (0.5 + 0.5 * (static_cast<double>(g) - 1.0) * std::sqrt(0.6));
        const double Q = above + row.axial_N_per_m * down_m * (top - 0.5 * down_m);
        sum += kWeight[g] * t * Q * Q / row.shear_N_per_m;
    }
    return sum;
}

}  // namespace

Section section_of(std::span<const SectionRow> rows) {
    Section out;
    double first_moment = 0.0;
    for (const SectionRow& row : rows) {
        const double EA = row.axial_N_per_m * (row.high_m - row.low_m);
        out.axial_N += EA;
        first_moment += EA * 0.5 * (row.low_m + row.high_m);
    }
    if (!(out.axial_N > 0.0)) return {};
    out.neutral_m = first_moment / out.axial_N;
    double energy = 0.0, Q = 0.0;
    for (std::size_t i = rows.size(); i-- > 0;) {
        const SectionRow& row = rows[i];
        const double t = row.high_m - row.low_m, arm = 0.5 * (row.low_m + row.high_m) - out.neutral_m;
        out.bending_N_m2 += row.axial_N_per_m * t * (t * t / 12.0 + arm * arm);
        energy += shear_energy(row, out.neutral_m, Q);
        Q += row.axial_N_per_m * t * arm;
    }
    out.shear_N = out.bending_N_m2 * out.bending_N_m2 / energy;
    return out;
}

std::vector<BeamPiece> beam_pieces(const Voxels& voxels, std::span<const Material> materials, int axis, int force_axis,
                                   double from_m, double to_m) {
    check_materials(materials);
    if (axis == force_axis) throw MeshError("a beam's load must be square to its axis", {});
    const double h = voxels.frame.pitch_m, origin_m = voxels.frame.origin_m[at(axis)];
    const double last_m = origin_m + h * voxels.size[at(axis)];
    if (!(from_m < to_m && from_m >= origin_m - 1e-9 * h && to_m <= last_m + 1e-9 * h))
        throw MeshError(text("a beam from ", from_m, " to ", to_m, " m, in voxels from ", origin_m, " to ", last_m),
                        {});
    const SliceCounts counts = count_slices(voxels, materials.size(), axis, force_axis);
    const auto first = static_cast<std::size_t>(std::max(0.0, std::floor((from_m - origin_m) / h + 1e-9)));
    const auto end = std::min(counts.slices, static_cast<std::size_t>(std::ceil((to_m - origin_m) / h - 1e-9)));
    std::vector<BeamPiece> out;
    for (std::size_t s = first; s < end; ++s) {
        const double low_m = std::max(from_m, origin_m + static_cast<double>(s) * h);
        const double high_m = std::min(to_m, origin_m + static_cast<double>(s + 1) * h);
        const std::span<const int> slice = counts.slice(s), before = s > first ? counts.slice(s - 1) : slice;
        if (s > first && std::equal(slice.begin(), slice.end(), before.begin(), before.end())) {
            out.back().to_m = high_m;
            continue;
        }
        const auto rows = rows_of(slice, materials, voxels.frame.origin_m[at(force_axis)], h);
        if (rows.empty())
            throw MeshError(text("the part has a gap at ", 0.5 * (low_m + high_m), " m along its axis"), {});
        out.push_back({low_m, high_m, section_of(rows), rows.back().high_m - rows.front().low_m});
    }
    return out;
}

BeamTip beam_tip(std::span<const BeamPiece> pieces, bool clamped_low, bool with_shear) {
    BeamTip out;
    if (pieces.empty()) return out;
    for (const BeamPiece& piece : pieces) {
        // distances from the tip, the larger one first
        const double a = clamped_low ? pieces.back().to_m - piece.from_m : piece.to_m - pieces.front().from_m;
        const double b = clamped_low ? pieces.back().to_m - piece.to_m : piece.from_m - pieces.front().from_m;
        out.m_per_N += (a - b) * (a * a + a * b + b * b) / (3.0 * piece.section.bending_N_m2);
        out.rad_per_N += (a - b) * (a + b) / (2.0 * piece.section.bending_N_m2);
        if (with_shear) out.m_per_N += (a - b) / piece.section.shear_N;
    }
    return out;
}

double euler_load_N(std::span<const BeamPiece> pieces, bool clamped_low) {
    assert(!pieces.empty());
    // y = A cos(phase), whose phase grows by k l along a piece; the column has buckled where it reaches pi/2
    const auto buckles = [&](double force_N) {
        double phase = 0.0, slope_over_y = 0.0;  // -y'/y, which goes on from piece to piece
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const BeamPiece& piece = pieces[clamped_low ? i : pieces.size() - 1 - i];
            const double k = std::sqrt(force_N / piece.section.bending_N_m2);
            phase = std::atan(slope_over_y / k) + k * (piece.to_m - piece.from_m);
            if (phase >= 0.5 * std::numbers::pi) return true;
            slope_over_y = k * std::tan(phase);
        }
        return false;
    };
    const auto bending = [](const BeamPiece& a, const BeamPiece& b) {
        return a.section.bending_N_m2 < b.section.bending_N_m2;
    };
    const auto [softest, stiffest] = std::minmax_element(pieces.begin(), pieces.end(), bending);
    const double length_m = pieces.back().to_m - pieces.front().from_m;
    const double uniform = std::numbers::pi * std::numbers::pi / (4.0 * length_m * length_m);
    double low_N = uniform * softest->section.bending_N_m2, high_N = uniform * stiffest->section.bending_N_m2;
    for (int i = 0; i < 100 && high_N > low_N * (1.0 + 1e-12); ++i) {
        const double middle_N = 0.5 * (low_N + high_N);
        (buckles(middle_N) ? high_N : low_N) = middle_N;
    }
    return 0.5 * (low_N + high_N);
}

double beam_deflection_m_per_N(std::span<const BeamPiece> pieces, bool clamped_low, const BeamPlaces& places,
                               bool with_shear) {
    if (pieces.empty()) return 0.0;
    const auto from_clamp = [&](double p_m) {
        return clamped_low ? p_m - pieces.front().from_m : pieces.back().to_m - p_m;
    };
    const double a = from_clamp(places.load_m), x = from_clamp(places.at_m), end = std::min(a, x);
    double sum = 0.0;
    for (const BeamPiece& piece : pieces) {
        const double s0 = std::max(0.0, from_clamp(clamped_low ? piece.from_m : piece.to_m));
        const double s1 = std::min(end, from_clamp(clamped_low ? piece.to_m : piece.from_m));
        if (!(s1 > s0)) continue;
        const double middle = 0.5 * (s0 + s1);
        const auto product = [&](double s) { return (a - s) * (x - s); };
        sum += (s1 - s0) * (product(s0) + 4.0 * product(middle) + product(s1)) / (6.0 * piece.section.bending_N_m2);
        if (with_shear) sum += (s1 - s0) / piece.section.shear_N;
    }
    return sum;
}

}  // namespace palpa::mechanics
