#pragma once
// STL files: triangles without a unit, as text or binary.
// Source: Marshall Burns, Automated Fabrication (1993), section 6.5.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mechanics/triangle_solid.h"

namespace palpa::parts {

// Returns the triangles, in metres; their normals are not read, since the order of the corners says the same. unit_m: what
// the file's 1 is. A file of 84 + 50 n bytes, n being its count, is binary, whatever its first letters are. Throws
// InputError, which names the line or the triangle: for a file that ends too early, for words that are not STL's, for
// numbers that are not finite, for no triangles and too many, and for a file that begins with "solid", holds bytes that are no
// text, and is not of a binary file's size.
std::vector<mechanics::Triangle> parse_stl(std::string_view bytes, const std::string& file_name, double unit_m);

// Makes a solid of triangles. Throws InputError for a surface that is not closed, with the share of lines on which the three
// axes disagree, and for one that is inside out. Where all lines agree, edges of triangles without a partner are let pass:
// cracks narrower than 1/256 of the body.
mechanics::TriangleSolid solid_of(std::vector<mechanics::Triangle> triangles, const std::string& file_name);

// Reads a file, moves it by offset_m, and makes it a solid.
mechanics::TriangleSolid read_stl(const std::filesystem::path& path, double unit_m,
                                  const std::array<double, 3>& offset_m);

}  // namespace palpa::parts
