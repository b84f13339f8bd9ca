#pragma once
// Gmsh meshes: .msh 2.2 and 4.1, ASCII and binary (little-endian), cells of first order.
// Source: Gmsh reference manual, "MSH file format" and "Legacy formats".
//
// The reader reads nodes, triangles, quads, tetrahedra, hexahedra and physical groups, and ignores points and lines. It
// refuses other cells (pyramids, prisms, second order), partitioned meshes, version 4.0 and big-endian files.

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpa::files {

enum class MshKind { triangle, quad, tet, hex };
inline constexpr std::size_t kMshKinds = 4;
inline constexpr std::array<int, kMshKinds> kMshCorners{3, 4, 4, 8};

struct MshCells {
    std::vector<int> nodes;             // indices into Msh::nodes; as many as corners for each cell
    std::vector<std::uint64_t> number;  // of each cell in the file, for messages
};

// A physical group: the indices of its cells by kind. A cell may be in several groups; the name is empty if the file
// has none.
struct MshGroup {
    int dimension = 0;
    int tag = 0;
    std::string name;
    std::array<std::vector<int>, kMshKinds> cells;
};

// Plain arrays. Corners are in Gmsh's order, which is VTK's. Lengths are in the file's own unit.
struct Msh {
    std::vector<double> nodes;               // 3 * n_nodes: x y z of each
    std::vector<std::uint64_t> node_number;  // of each node in the file, for messages
    std::array<MshCells, kMshKinds> cells;
    std::vector<MshGroup> groups;

    std::size_t n_nodes() const { return nodes.size() / 3; }
    const MshCells& of(MshKind kind) const { return cells[static_cast<std::size_t>(kind)]; }
    std::size_t count(MshKind kind) const { return of(kind).number.size(); }
};

// Read a mesh. Throw InputError naming the line (ASCII) or byte (binary), what was found and what was expected. Counts
// in headers are compared with the size of the file before memory is allocated. A cell that the file holds several
// times (version 2.2 repeats a cell for each of its groups) is kept once.
Msh read_msh(const std::filesystem::path& path);
Msh parse_msh(std::string_view bytes, const std::string& file_name);

}  // namespace palpa::files
