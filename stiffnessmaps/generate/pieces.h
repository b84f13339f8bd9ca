#pragma once
// The pieces a generated map is made of, each a small file in NAME.map.lines/: windows (tables of
// mechanics/rolling.h) and lines (forces along x). A file is written aside
// and renamed; it carries a fingerprint of the phantom and the mesh, and a checksum, and is recomputed when
// either is wrong. Same piece, same bytes, whoever computes it.

#include <cstdint>
#include <optional>

#include "mechanics/rolling.h"
#include "stiffnessmaps/phantom.h"

namespace palpa::stiffnessmaps {

struct MapTask {
    Phantom phantom;
    mechanics::RollingModel model;
    mechanics::RollingMesh mesh;
    std::vector<std::vector<int>> groups;  // of nodules
    std::filesystem::path folder;          // of the pieces
    std::uint64_t fingerprint = 0;
};

// Throws InputError naming the phantom's key for what the finite elements cannot do (indenter off the tissue,
// depth through the block, nodules that overlap).
MapTask make_map_task(const std::filesystem::path& phantom_file, const std::filesystem::path& folder,
                      double coarseness);

// Windows: 0 the sides, then one for each group of nodules, the plain layer last.
inline int window_count(const MapTask& task) { return static_cast<int>(task.groups.size()) + 2; }
std::string window_name(int window);
std::string line_name(std::size_t line);

using Numbers = std::vector<double>;
// Nothing if the file is missing, damaged or of another phantom; the last two are told on stderr.
std::optional<Numbers> read_piece(const MapTask& task, const std::string& name);

void compute_window(const MapTask& task, int window);
mechanics::RollingTables read_windows(const MapTask& task);  // all there, or std::runtime_error
// Per cell along x: normal force (N) at each depth, then contact energy (J) at each depth; with friction instead of
// the energy the tangential force (N) along x at each depth, then that along y.
void compute_line(const MapTask& task, const mechanics::RollingTables& tables, std::size_t line);

// Cells that the map is checked at: around the nodules, and spread over the grid, its edges included.
struct Cell {
    std::size_t i = 0;
    std::size_t j = 0;
};
std::vector<Cell> probe_cells(const Phantom& phantom, std::size_t count);
// With friction: slides.
inline bool is_rough(const MapTask& task) { return task.model.friction > 0.0; }
// Forces at each depth over a cell.
std::vector<mechanics::RollingForce> press_cell(const MapTask& task, const mechanics::RollingTables& tables,
                                                const Cell& cell);

}  // namespace palpa::stiffnessmaps
