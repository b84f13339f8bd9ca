#include "mechanics/voxels.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mechanics/error.h"
#include "mechanics/index.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

constexpr int kEmpty = -1;

void append(int x0, int x1, int material, std::vector<Run>& out) {
    if (material == kEmpty || x0 >= x1) return;
    if (!out.empty() && out.back().x1 == x0 && out.back().material == material) {
        out.back().x1 = x1;
    } else {
        out.push_back({x0, x1, material});
    }
}

int edited(const VoxelEdit& edit, int material) {
    switch (edit.kind) {
        case EditKind::add:
            return edit.material;
        case EditKind::remove:
            return kEmpty;
        case EditKind::permute:
            break;
    }
    const bool taken = material != kEmpty && (!edit.from || material == *edit.from);
    return taken ? edit.material : material;
}

// Goes along the line from one boundary of runs or spans to the next.
std::int64_t edit_line(const VoxelEdit& edit, const std::vector<Span>& spans, const std::vector<Run>& runs,
                       std::vector<Run>& out) {
    out.clear();
    std::int64_t changed = 0;
    int x = 0;
    for (std::size_t r = 0, s = 0; r < runs.size() || s < spans.size();) {
        const bool in_run = r < runs.size() && runs[r].x0 <= x;
        const bool in_span = s < spans.size() && spans[s].x0 <= x;
        int next = kMostVoxelsAlong;
        if (r < runs.size()) next = std::min(next, in_run ? runs[r].x1 : runs[r].x0);
        if (s < spans.size()) next = std::min(next, in_span ? spans[s].x1 : spans[s].x0);
        const int before = in_run ? runs[r].material : kEmpty;
        const int after = in_span ? edited(edit, before) : before;
        if (after != before) changed += next - x;
        append(x, next, after, out);
        x = next;
        if (in_run && x == runs[r].x1) ++r;
        if (in_span && x == spans[s].x1) ++s;
    }
    return changed;
}

void exchange(std::vector<ChangedLine>& record, Voxels& voxels) {
    for (ChangedLine& changed : record) changed.runs.swap(voxels.lines[changed.line]);
}

bool move_last(std::vector<std::vector<ChangedLine>>& from, std::vector<std::vector<ChangedLine>>& to, Voxels& voxels) {
    if (from.empty()) return false;
    exchange(from.back(), voxels);
    to.push_back(std::move(from.back()));
    from.pop_back();
    return true;
}

// Union-find over runs.
int root_of(std::vector<int>& parent, int i) {
    while (parent[at(i)] != i) i = parent[at(i)] = parent[at(parent[at(i)])];
    return i;
}

// Joins the runs of two lines that overlap along x. `a`, `b`: number of the first run of each.
void join_lines(const std::vector<Run>& line_a, int a, const std::vector<Run>& line_b, int b,
                std::vector<int>& parent) {
    for (std::size_t i = 0, j = 0; i < line_a.size() && j < line_b.size();) {
        if (std::max(line_a[i].x0, line_b[j].x0) < std::min(line_a[i].x1, line_b[j].x1)) {
            parent[at(root_of(parent, a + static_cast<int>(i)))] = root_of(parent, b + static_cast<int>(j));
        }
        (line_a[i].x1 < line_b[j].x1 ? i : j)++;
    }
}

}  // namespace

Voxels empty_voxels(const std::array<int, 3>& size, const VoxelFrame& frame) {
    if (!(std::isfinite(frame.pitch_m) && frame.pitch_m > 0.0))
        throw MeshError(text("the voxels' pitch is ", frame.pitch_m, " m, must be > 0"), {});
    for (const int n : size) {
        if (n < 1 || n > kMostVoxelsAlong)
            throw MeshError(text(n, " voxels along an axis, must be 1 to ", kMostVoxelsAlong), {});
    }
    const std::int64_t lines = std::int64_t{size[1]} * size[2];
    if (lines > kMostVoxelLines)
        throw MeshError(text(lines, " lines of voxels, must be at most ", kMostVoxelLines), {});
    Voxels out{size, frame, {}};
    out.lines.resize(static_cast<std::size_t>(lines));
    return out;
}

int material_at(const Voxels& voxels, int x, int y, int z) {
    const bool inside = x >= 0 && y >= 0 && z >= 0 && x < voxels.size[0] && y < voxels.size[1] && z < voxels.size[2];
    if (!inside) return kEmpty;
    const std::vector<Run>& line = voxels.lines[line_of(voxels, y, z)];
    const auto after =
        std::upper_bound(line.begin(), line.end(), x, [](int at_x, const Run& r) { return at_x < r.x1; });
    return after != line.end() && after->x0 <= x ? after->material : kEmpty;
}

std::int64_t apply(const VoxelEdit& edit, Voxels& voxels, EditHistory& history) {
    std::int64_t changed = 0;
    std::vector<ChangedLine> record;
    std::vector<Span> spans;
    std::vector<Run> made;
    const LineRange range = lines_of(edit.region, voxels.frame, voxels.size[1], voxels.size[2]);
    for (int z = range.z0; z < range.z1; ++z) {
        for (int y = range.y0; y < range.y1; ++y) {
            std::vector<Run>& line = voxels.lines[line_of(voxels, y, z)];
            if (line.empty() && edit.kind != EditKind::add) continue;
            spans_of(edit.region, voxels.frame, voxels.size[0], y, z, spans);
            if (spans.empty()) continue;
            const std::int64_t n = edit_line(edit, spans, line, made);
            if (n == 0) continue;
            changed += n;
            record.push_back({line_of(voxels, y, z), std::vector<Run>(made.begin(), made.end())});
            record.back().runs.swap(line);
        }
    }
    history.done.push_back(std::move(record));
    history.undone.clear();
    return changed;
}

bool undo(Voxels& voxels, EditHistory& history) { return move_last(history.done, history.undone, voxels); }
bool redo(Voxels& voxels, EditHistory& history) { return move_last(history.undone, history.done, voxels); }

void set_line(int y, int z, std::vector<Run> runs, Voxels& voxels) {
    const bool inside = y >= 0 && z >= 0 && y < voxels.size[1] && z < voxels.size[2];
    if (!inside) throw MeshError(text("line y ", y, ", z ", z, " is outside the voxels"), {});
    std::vector<Run> merged;
    int from = 0;
    for (const Run& run : runs) {
        if (run.x0 < from || run.x1 <= run.x0 || run.x1 > voxels.size[0] || run.material < 0) {
            throw MeshError(
                text("line y ", y, ", z ", z, ": run ", run.x0, " to ", run.x1, " of material ", run.material,
                     " overlaps the one before, is empty or leaves the line (0 to ", voxels.size[0], ")"),
                {});
        }
        append(run.x0, run.x1, run.material, merged);
        from = run.x1;
    }
    merged.shrink_to_fit();
    voxels.lines[line_of(voxels, y, z)] = std::move(merged);
}

VoxelCounts count(const Voxels& voxels, int n_materials) {
    VoxelCounts out;
    const auto grow = [&](int n) {
        if (static_cast<int>(out.of_material.size()) >= n) return;
        out.of_material.resize(at(n), 0);
        out.centre_m.resize(at(n), {0.0, 0.0, 0.0});
    };
    grow(n_materials);
    out.memory_bytes = sizeof(Voxels) + voxels.lines.capacity() * sizeof(std::vector<Run>);
    const double h = voxels.frame.pitch_m;
    const Point& o = voxels.frame.origin_m;
    for (std::size_t line = 0; line < voxels.lines.size(); ++line) {
        out.memory_bytes += voxels.lines[line].capacity() * sizeof(Run);
        const auto y = static_cast<double>(line % at(voxels.size[1]));
        const auto z = static_cast<double>(line / at(voxels.size[1]));
        for (const Run& run : voxels.lines[line]) {
            grow(run.material + 1);
            const double n = run.x1 - run.x0;
            Point& sum = out.centre_m[at(run.material)];
            sum[0] += n * (o[0] + 0.5 * (run.x0 + run.x1) * h);
            sum[1] += n * (o[1] + (y + 0.5) * h);
            sum[2] += n * (o[2] + (z + 0.5) * h);
            out.of_material[at(run.material)] += run.x1 - run.x0;
            ++out.runs;
        }
    }
    for (std::size_t m = 0; m < out.of_material.size(); ++m) {
        out.voxels += out.of_material[m];
        for (double& c : out.centre_m[m]) c /= std::max(1.0, static_cast<double>(out.of_material[m]));
    }
    return out;
}

int count_bodies(const Voxels& voxels) {
    std::vector<int> first(voxels.lines.size() + 1, 0);
    for (std::size_t i = 0; i < voxels.lines.size(); ++i)
        first[i + 1] = first[i] + static_cast<int>(voxels.lines[i].size());
    std::vector<int> parent(at(first.back()));
    std::iota(parent.begin(), parent.end(), 0);
    for (int z = 0; z < voxels.size[2]; ++z) {
        for (int y = 0; y < voxels.size[1]; ++y) {
            const std::size_t here = line_of(voxels, y, z);
            const std::vector<Run>& line = voxels.lines[here];
            for (std::size_t r = 1; r < line.size(); ++r) {
                if (line[r - 1].x1 != line[r].x0) continue;
                const int run = first[here] + static_cast<int>(r);
                parent[at(root_of(parent, run))] = root_of(parent, run - 1);
            }
            if (y > 0) join_lines(line, first[here], voxels.lines[here - 1], first[here - 1], parent);
            if (z > 0) {
                const std::size_t below = line_of(voxels, y, z - 1);
                join_lines(line, first[here], voxels.lines[below], first[below], parent);
            }
        }
    }
    int bodies = 0;
    for (int i = 0; i < first.back(); ++i) bodies += root_of(parent, i) == i ? 1 : 0;
    return bodies;
}

}  // namespace palpa::mechanics
