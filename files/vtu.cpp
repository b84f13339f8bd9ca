#include "files/vtu.h"

#include <bit>
#include <cassert>
#include <cstdint>
#include <cstring>

#include "files/text.h"

namespace palpa::files {
namespace {

static_assert(std::endian::native == std::endian::little, "the file says LittleEndian");

constexpr std::uint8_t kTetrahedron = 10;  // VTK's numbers of cell types
constexpr std::uint8_t kHexahedron = 12;

void append_base64(std::string_view bytes, std::string& out) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto byte = [&](std::size_t k) -> unsigned {
            return i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u;
        };
        const unsigned three = byte(0) << 16 | byte(1) << 8 | byte(2);
        out.push_back(kDigits[three >> 18]);
        out.push_back(kDigits[three >> 12 & 63]);
        out.push_back(i + 1 < bytes.size() ? kDigits[three >> 6 & 63] : '=');
        out.push_back(i + 2 < bytes.size() ? kDigits[three & 63] : '=');
    }
}

template <class Value>
void append_array(const char* type, const std::string& name, int components, const std::vector<Value>& values,
                  std::string& out) {
    out += "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
           std::to_string(components) + "\"";
    constexpr const char* kTensor[] = {"xx", "yy", "zz", "xy", "yz", "xz"};
    constexpr const char* kVector[] = {"x", "y", "z"};
    for (int k = 0; components > 1 && k < components; ++k) {
        out += " ComponentName" + std::to_string(k) + "=\"" + (components == 6 ? kTensor[k] : kVector[k]) + "\"";
    }
    out += " format=\"binary\">\n";
    const std::uint64_t length = values.size() * sizeof(Value);
    std::string bytes(sizeof length + length, '\0');
    std::memcpy(bytes.data(), &length, sizeof length);
    if (length > 0) std::memcpy(bytes.data() + sizeof length, values.data(), length);
    append_base64(bytes, out);
    out += "\n</DataArray>\n";
}

void append_fields(const char* element, const std::vector<VtuField>& fields, [[maybe_unused]] std::size_t count,
                   std::string& out) {
    out += "<" + std::string(element) + ">\n";
    for (const VtuField& field : fields) {
        assert(field.components == 1 || field.components == 3 || field.components == 6);
        assert(field.values.size() == count * static_cast<std::size_t>(field.components));
        append_array("Float64", field.name, field.components, field.values, out);
    }
    out += "</" + std::string(element) + ">\n";
}

}  // namespace

std::string vtu_text(const VtuGrid& grid) {
    const auto corners = static_cast<std::size_t>(grid.corners);
    const std::size_t n_points = grid.points.size() / 3;
    const std::size_t n_cells = grid.cells.size() / corners;
    assert(corners == 8 || corners == 4);
    assert(grid.points.size() == 3 * n_points && grid.cells.size() == corners * n_cells);

    std::vector<std::int64_t> ends(n_cells);
    for (std::size_t i = 0; i < n_cells; ++i) ends[i] = static_cast<std::int64_t>(corners * (i + 1));
    const std::vector<std::uint8_t> types(n_cells, corners == 8 ? kHexahedron : kTetrahedron);
    const std::vector<std::int64_t> connectivity(grid.cells.begin(), grid.cells.end());

    std::string out =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\">\n"
        "<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
        std::to_string(n_points) + "\" NumberOfCells=\"" + std::to_string(n_cells) + "\">\n";
    append_fields("PointData", grid.on_points, n_points, out);
    append_fields("CellData", grid.in_cells, n_cells, out);
    out += "<Points>\n";
    append_array("Float64", "Points", 3, grid.points, out);
    out += "</Points>\n<Cells>\n";
    append_array("Int64", "connectivity", 1, connectivity, out);
    append_array("Int64", "offsets", 1, ends, out);
    append_array("UInt8", "types", 1, types, out);
    out += "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
    return out;
}

void write_vtu(const std::filesystem::path& path, const VtuGrid& grid) { write_text_atomically(path, vtu_text(grid)); }

}  // namespace palpa::files
