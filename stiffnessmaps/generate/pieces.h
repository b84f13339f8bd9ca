#pragma once
// The pieces of a generated map, each a small file in NAME.map.lines/: windows (tables of mechanics/rolling.h) and
// lines (forces along x). A file is written under another name and renamed. It carries a fingerprint of the phantom and
// the mesh, and a checksum, and is computed again if either is wrong. A piece has the same bytes whichever process
// computes it.

#include <cstdint>
#include <optional>

#include "mechanics/rolling.h"
#include "stiffnessmaps/phantom.h"

namespace palpa::stiffnessmaps {

struct MapTask {
    Phantom phantom;
    mechanics::RollingModel model;
    mechanics::RollingMesh mesh;
    std::vector<std::vector<int>> groups;  // nodules near each other, as indices; one window each
    std::filesystem::path folder;          // of the pieces
    std::uint64_t fingerprint = 0;         // of model, mesh, depths and grid
};

// Throws InputError naming the phantom's key where the indenter is off the tissue or goes through the block.
void check_phantom(const Phantom& phantom, const std::filesystem::path& file);

// Throws InputError as check_phantom does, and for nodules that overlap and what costs too much (check_cost).
MapTask make_map_task(const std::filesystem::path& phantom_file, const std::filesystem::path& folder,
                      double coarseness);

// Windows: 0 for the sides, then one for each group of nodules, and the plain layer last.
inline int window_count(const MapTask& task) { return static_cast<int>(task.groups.size()) + 2; }
std::string window_name(int window);
std::string line_name(std::size_t line);

using Numbers = std::vector<double>;
// Returns nothing if the file is missing, damaged or of another phantom or mesh; the last two are reported on stderr.
std::optional<Numbers> read_piece(const MapTask& task, const std::string& name);

void compute_window(const MapTask& task, int window);
mechanics::RollingTables read_windows(const MapTask& task);  // throws std::runtime_error if one is missing
// Writes one line along x. It holds, for each cell, the normal force (N) at each depth, then the contact energy (J) at
// each depth; with friction, instead of the energy, the tangential force (N) along x at each depth, then that along y.
void compute_line(const MapTask& task, const mechanics::RollingTables& tables, std::size_t line);

// A cell at which the map is checked. The cells lie around the nodules, and are spread over the grid with its edges.
struct Cell {
    std::size_t i = 0;
    std::size_t j = 0;
};
// At most so many, each once: a small grid has fewer.
std::vector<Cell> probe_cells(const Phantom& phantom, std::size_t count);
// True if the tool slides with friction.
inline bool is_rough(const MapTask& task) { return task.model.friction > 0.0; }
// Returns the forces at each depth over a cell.
std::vector<mechanics::RollingForce> press_cell(const MapTask& task, const mechanics::RollingTables& tables,
                                                const Cell& cell);

}  // namespace palpa::stiffnessmaps
