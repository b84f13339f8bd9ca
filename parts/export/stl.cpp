#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "files/text.h"
#include "parts/export/export.h"
#include "parts/export/new_folder.h"

namespace palpa::parts {
namespace {

void put_bits(std::uint32_t bits, std::size_t n_bytes, std::string& out) {
    for (std::size_t byte = 0; byte < n_bytes; ++byte) out.push_back(static_cast<char>(bits >> (8 * byte) & 0xFFU));
}

void put_point(const mechanics::Point& point, double factor, std::string& out) {
    for (const double c : point) put_bits(std::bit_cast<std::uint32_t>(static_cast<float>(factor * c)), 4, out);
}

mechanics::Point normal_of(const mechanics::Point& a, const mechanics::Point& b, const mechanics::Point& c) {
    mechanics::Point u{}, v{};
    for (std::size_t i = 0; i < 3; ++i) {
        u[i] = b[i] - a[i];
        v[i] = c[i] - a[i];
    }
    mechanics::Point n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (double& x : n) x = length > 0.0 ? x / length : 0.0;
    return n;
}

}  // namespace

std::string stl_bytes(const Surface& surface, const std::string& name) {
    std::string out = "Palpa part, mm: " + name;  // never "solid", which would make it text for some programs
    out.resize(80, ' ');
    out.reserve(84 + 50 * surface.triangles.size());
    put_bits(static_cast<std::uint32_t>(surface.triangles.size()), 4, out);
    for (const auto& triangle : surface.triangles) {
        std::array<mechanics::Point, 3> p{};
        for (std::size_t i = 0; i < 3; ++i) p[i] = surface.vertices_m[static_cast<std::size_t>(triangle[i])];
        put_point(normal_of(p[0], p[1], p[2]), 1.0, out);
        for (const mechanics::Point& corner : p) put_point(corner, 1e3, out);
        put_bits(0, 2, out);
    }
    return out;
}

std::vector<std::string> file_names(const Part& part) {
    // some disks take soft and Soft for one name
    const auto lower = [](std::string name) {
        for (char& c : name) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        return name;
    };
    std::vector<std::string> out, taken;
    for (const PartMaterial& material : part.materials) {
        std::string name;
        for (const char c : material.name) {
            const bool stays = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
            name.push_back(stays ? c : '_');
        }
        if (name.empty()) name = "_";
        name.resize(std::min<std::size_t>(name.size(), 100));
        std::string unique = name;
        for (int n = 2; std::find(taken.begin(), taken.end(), lower(unique)) != taken.end(); ++n)
            unique = name + "_" + std::to_string(n);
        out.push_back(unique);
        taken.push_back(lower(unique));
    }
    return out;
}

std::vector<ExportedFile> export_stl(const Part& part, const std::vector<Surface>& surfaces,
                                     const std::filesystem::path& folder) {
    NewFolder made(folder);
    const std::vector<std::string> names = file_names(part);
    std::vector<ExportedFile> out;
    for (const Surface& surface : surfaces) {
        const auto m = static_cast<std::size_t>(surface.material);
        const std::string file = names[m] + ".stl";
        files::write_text_whole(made.path() / file, stl_bytes(surface, part.materials[m].name));
        out.push_back({(folder / file).string(), part.materials[m].name,
                       static_cast<std::int64_t>(surface.triangles.size()), 0, volume_m3(surface)});
    }
    made.keep();
    return out;
}

}  // namespace palpa::parts
