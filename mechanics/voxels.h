#pragma once
// Parts as voxels: sorted, merged runs of one material per (y, z) line, and edits of them that can be undone.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mechanics/voxel_region.h"

namespace palpa::mechanics {

// Voxels x0 <= x < x1 of a line, all of one material (its position in the part's list, >= 0).
struct Run {
    int x0 = 0;
    int x1 = 0;
    int material = 0;
    bool operator==(const Run&) const = default;
};

// Line (y, z) stands at y + size[1] * z. Its runs are sorted and disjoint, and neighbours of one material are merged, so
// that equal parts have equal runs.
struct Voxels {
    std::array<int, 3> size{0, 0, 0};  // x, y, z
    VoxelFrame frame;
    std::vector<std::vector<Run>> lines;
};

// The most voxels along one axis, and the most lines of a part (some 1 GB of line heads at 24 bytes each is refused).
inline constexpr int kMostVoxelsAlong = 32768;
inline constexpr std::int64_t kMostVoxelLines = std::int64_t{1} << 24;

// Returns voxels that are all empty. Throws MeshError for a pitch that is not > 0 and for sizes below 1 or above the
// limits.
Voxels empty_voxels(const std::array<int, 3>& size, const VoxelFrame& frame);

inline std::size_t line_of(const Voxels& voxels, int y, int z) {
    return static_cast<std::size_t>(y) + static_cast<std::size_t>(voxels.size[1]) * static_cast<std::size_t>(z);
}

// Returns the material of a voxel, or -1 if it is empty or outside.
int material_at(const Voxels& voxels, int x, int y, int z);

// add      gives all voxels of the region the material
// remove   empties them
// permute  gives the material to those that are filled; with `from`, to those of that material only. Volumes stay as
//          they are, and the mass changes by V (rho2 - rho1).
enum class EditKind { add, remove, permute };
struct VoxelEdit {
    EditKind kind = EditKind::add;
    Region region;
    int material = 0;
    std::optional<int> from;
};

// What edits replaced: the runs of every line that they changed. An undo exchanges them with those that are there, so
// that the same record serves its redo.
struct ChangedLine {
    std::size_t line = 0;
    std::vector<Run> runs;
};
struct EditHistory {
    std::vector<std::vector<ChangedLine>> done;
    std::vector<std::vector<ChangedLine>> undone;  // the last one is redone first
};

// Applies an edit, notes what it replaced and forgets what was undone. Only the lines that the region can reach are
// looked at. Returns how many voxels changed.
std::int64_t apply(const VoxelEdit& edit, Voxels& voxels, EditHistory& history);

// Take the last edit back, or make it again. Return false if there is none.
bool undo(Voxels& voxels, EditHistory& history);
bool redo(Voxels& voxels, EditHistory& history);

// Replaces the runs of one line; `runs` must be sorted and disjoint. Throws MeshError, naming the line, if they overlap,
// are empty or leave the line.
void set_line(int y, int z, std::vector<Run> runs, Voxels& voxels);

struct VoxelCounts {
    std::vector<std::int64_t> of_material;        // voxels, by position in the list of materials
    std::vector<std::array<double, 3>> centre_m;  // centroid of each material; 0 if it has no voxels
    std::int64_t voxels = 0;
    std::int64_t runs = 0;
    std::size_t memory_bytes = 0;  // of lines and runs, without histories
};
// Counts up to the largest material that is used, at least n_materials entries.
VoxelCounts count(const Voxels& voxels, int n_materials);

// Returns how many bodies there are; voxels that share a face belong to one body.
int count_bodies(const Voxels& voxels);

}  // namespace palpa::mechanics
