#pragma once
// Writes VTK's XML file of an unstructured grid (.vtu), which ParaView, VisIt and meshio read. Source: "VTK XML file
// formats", docs.vtk.org. Arrays are inline base64, uncompressed, float64 with 64-bit lengths: no digit is lost.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace palpa::files {

struct VtuField {
    std::string name;
    int components = 1;          // 6: a symmetric tensor xx yy zz xy yz xz, as VTK orders it
    std::vector<double> values;  // component fastest
};

struct VtuGrid {
    std::vector<double> points;  // 3 * n_points: x y z of each
    int corners = 8;             // of each cell: 8 for hexahedra, 4 for tetrahedra
    std::vector<int> cells;      // `corners` point indices of each cell, in VTK's order
    std::vector<VtuField> on_points;
    std::vector<VtuField> in_cells;
};

// Returns the content of the file. A field whose size does not fit the grid is a bug (assert).
std::string vtu_text(const VtuGrid& grid);

// Writes the file whole or not at all. Throws std::runtime_error with the system's reason.
void write_vtu(const std::filesystem::path& path, const VtuGrid& grid);

}  // namespace palpa::files
