#include "mechanics/voxel_overlay.h"

#include <algorithm>

#include "mechanics/error.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

void check_runs(const std::vector<PlacedRun>& runs, const Voxels& voxels) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const PlacedRun& here = runs[i];
        const bool inside = here.z >= 0 && here.z < voxels.size[2] && here.y >= 0 && here.y < voxels.size[1] &&
                            here.run.x0 >= 0 && here.run.x0 < here.run.x1 && here.run.x1 <= voxels.size[0] &&
                            here.run.material >= 0;
        if (!inside) {
            throw MeshError(text("run ", i, " (z ", here.z, ", y ", here.y, ", x ", here.run.x0, " to ", here.run.x1,
                                 ") is empty or leaves the voxels"),
                            {});
        }
        if (i == 0) continue;
        const PlacedRun& before = runs[i - 1];
        const bool sorted = before.z != here.z   ? before.z < here.z
                            : before.y != here.y ? before.y < here.y
                                                 : before.run.x1 <= here.run.x0;
        if (!sorted) {
            throw MeshError(text("run ", i, " (z ", here.z, ", y ", here.y, ", x ", here.run.x0, " to ", here.run.x1,
                                 ") overlaps the run before it, or stands before it in the part"),
                            {});
        }
    }
}

// Returns the runs of a line with others over them, not merged.
std::vector<Run> covered(const std::vector<Run>& line, const PlacedRun* from, const PlacedRun* end) {
    std::vector<Run> out;
    const PlacedRun* next = from;
    for (const Run& run : line) {
        int x = run.x0;
        while (next != end && next->run.x1 <= x) ++next;
        for (const PlacedRun* over = next; over != end && over->run.x0 < run.x1; ++over) {
            if (x < over->run.x0) out.push_back({x, over->run.x0, run.material});
            x = std::max(x, over->run.x1);
        }
        if (x < run.x1) out.push_back({x, run.x1, run.material});
    }
    for (; from != end; ++from) out.push_back(from->run);
    std::sort(out.begin(), out.end(), [](const Run& a, const Run& b) { return a.x0 < b.x0; });
    return out;
}

// Voxels whose material is another one.
std::int64_t count_changed(const std::vector<Run>& before, const PlacedRun* from, const PlacedRun* end) {
    std::int64_t changed = 0;
    for (; from != end; ++from) {
        changed += from->run.x1 - from->run.x0;
        for (const Run& run : before) {
            const int same = std::min(run.x1, from->run.x1) - std::max(run.x0, from->run.x0);
            if (same > 0 && run.material == from->run.material) changed -= same;
        }
    }
    return changed;
}

}  // namespace

std::int64_t overlay(const std::vector<PlacedRun>& runs, Voxels& voxels, EditHistory& history) {
    check_runs(runs, voxels);
    std::int64_t changed = 0;
    std::vector<ChangedLine> record;
    for (std::size_t i = 0; i < runs.size();) {
        std::size_t j = i;
        while (j < runs.size() && runs[j].z == runs[i].z && runs[j].y == runs[i].y) ++j;
        const std::size_t line = line_of(voxels, runs[i].y, runs[i].z);
        const PlacedRun *from = runs.data() + i, *end = runs.data() + j;
        if (const std::int64_t n = count_changed(voxels.lines[line], from, end); n > 0) {
            changed += n;
            record.push_back({line, voxels.lines[line]});
            set_line(runs[i].y, runs[i].z, covered(voxels.lines[line], from, end), voxels);
        }
        i = j;
    }
    history.done.push_back(std::move(record));
    history.undone.clear();
    return changed;
}

std::vector<PlacedRun> placed_runs(const Voxels& voxels) {
    std::vector<PlacedRun> out;
    for (int z = 0; z < voxels.size[2]; ++z) {
        for (int y = 0; y < voxels.size[1]; ++y) {
            for (const Run& run : voxels.lines[line_of(voxels, y, z)]) out.push_back({z, y, run});
        }
    }
    return out;
}

}  // namespace palpa::mechanics
