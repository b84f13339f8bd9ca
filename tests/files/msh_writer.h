#pragma once
// Small Gmsh files in each of the four encodings, written from the format's description.

#include <array>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace palpa::test {

struct MshWritten {
    struct Cell {
        int type = 5;
        std::vector<int> groups;  // physical tags
        std::vector<int> nodes;   // positions
    };
    struct Name {
        int dimension;
        int tag;
        std::string name;
    };
    std::vector<std::array<double, 3>> nodes;
    std::vector<Cell> cells;
    std::vector<Name> names;
};

inline int msh_dimension(int type) { return type == 15 ? 0 : type == 1 ? 1 : type <= 3 ? 2 : 3; }
inline int msh_node_number(int position) { return 10 * position + 7; }  // with gaps

class MshBytes {
  public:
    explicit MshBytes(bool binary) : binary_(binary) {}
    void text(const std::string& line) { out += line; }
    template <class T>
    void put(T value) {
        if (binary_) {
            char bytes[sizeof(T)];
            std::memcpy(bytes, &value, sizeof(T));
            out.append(bytes, sizeof(T));
        } else {
            std::string number = std::to_string(value);
            if constexpr (std::is_floating_point_v<T>) {
                char digits[40];
                std::snprintf(digits, sizeof digits, "%.17g", value);
                number = digits;
            }
            out += number + " ";
        }
    }
    void end_row() { out += binary_ ? "" : "\n"; }
    std::string out;

  private:
    bool binary_;
};

inline std::string msh_2(const MshWritten& mesh, bool binary) {
    MshBytes w(binary);
    w.text("$MeshFormat\n2.2 " + std::string(binary ? "1" : "0") + " 8\n");
    if (binary) w.put(std::int32_t{1}), w.text("\n");
    w.text("$EndMeshFormat\n$PhysicalNames\n" + std::to_string(mesh.names.size()) + "\n");
    for (const auto& n : mesh.names)
        w.text(std::to_string(n.dimension) + " " + std::to_string(n.tag) + " \"" + n.name + "\"\n");
    w.text("$EndPhysicalNames\n$Nodes\n" + std::to_string(mesh.nodes.size()) + "\n");
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
        w.put(std::int32_t{msh_node_number(static_cast<int>(i))});
        for (const double x : mesh.nodes[i]) w.put(x);
        w.end_row();
    }
    std::size_t rows = 0;
    for (const auto& cell : mesh.cells) rows += std::max<std::size_t>(cell.groups.size(), 1);
    w.text("\n$EndNodes\n$Elements\n" + std::to_string(rows) + "\n");
    int number = 100;
    for (const auto& cell : mesh.cells) {
        const std::vector<int> groups = cell.groups.empty() ? std::vector<int>{0} : cell.groups;
        for (const int group : groups) {  // one row for each group, as Gmsh writes it
            const std::int32_t head[3] = {cell.type, binary ? 1 : 2, 2};
            if (binary) {
                for (const auto value : head) w.put(value);
                w.put(std::int32_t{number++});
            } else {
                w.put(std::int32_t{number++}), w.put(head[0]), w.put(head[2]);
            }
            w.put(std::int32_t{group}), w.put(std::int32_t{1});
            for (const int node : cell.nodes) w.put(std::int32_t{msh_node_number(node)});
            w.end_row();
        }
    }
    w.text("\n$EndElements\n");
    return w.out;
}

// One entity for each dimension and set of groups.
inline std::string msh_4(const MshWritten& mesh, bool binary) {
    std::array<std::map<std::vector<int>, int>, 4> entities;
    for (const auto& cell : mesh.cells) {
        auto& of = entities[static_cast<std::size_t>(msh_dimension(cell.type))];
        of.try_emplace(cell.groups, static_cast<int>(of.size()) + 1);
    }
    using Size = std::uint64_t;
    MshBytes w(binary);
    w.text("$MeshFormat\n4.1 " + std::string(binary ? "1" : "0") + " 8\n");
    if (binary) w.put(std::int32_t{1}), w.text("\n");
    w.text("$EndMeshFormat\n$PhysicalNames\n" + std::to_string(mesh.names.size()) + "\n");
    for (const auto& n : mesh.names)
        w.text(std::to_string(n.dimension) + " " + std::to_string(n.tag) + " \"" + n.name + "\"\n");
    w.text("$EndPhysicalNames\n$Entities\n");
    for (const auto& of : entities) w.put(Size{of.size()});
    w.end_row();
    for (std::size_t d = 0; d < 4; ++d) {
        for (const auto& [groups, tag] : entities[d]) {
            w.put(std::int32_t{tag});
            for (int k = 0; k < (d == 0 ? 3 : 6); ++k) w.put(0.5 * k);
            w.put(Size{groups.size()});
            for (const int group : groups) w.put(std::int32_t{d == 2 ? -group : group});  // turned round: same group
            if (d > 0) w.put(Size{1}), w.put(std::int32_t{-1});
            w.end_row();
        }
    }
    w.text("\n$EndEntities\n$Nodes\n");
    const Size half = mesh.nodes.size() / 2;
    w.put(Size{2}), w.put(Size{mesh.nodes.size()}), w.put(Size{7}), w.put(Size{10 * mesh.nodes.size()}), w.end_row();
    for (int block = 0; block < 2; ++block) {
        const Size first = block == 0 ? 0 : half;
        const Size last = block == 0 ? half : mesh.nodes.size();
        const int parametric = block;  // the second block carries u v
        w.put(std::int32_t{2}), w.put(std::int32_t{1}), w.put(std::int32_t{parametric}), w.put(Size{last - first}),
            w.end_row();
        for (Size i = first; i < last; ++i) w.put(Size(msh_node_number(static_cast<int>(i)))), w.end_row();
        for (Size i = first; i < last; ++i) {
            for (const double x : mesh.nodes[i]) w.put(x);
            for (int k = 0; k < 2 * parametric; ++k) w.put(0.25);
            w.end_row();
        }
    }
    w.text("\n$EndNodes\n$Elements\n");
    w.put(Size{mesh.cells.size()}), w.put(Size{mesh.cells.size()}), w.put(Size{100}), w.put(Size{999}), w.end_row();
    Size number = 100;
    for (const auto& cell : mesh.cells) {
        const int d = msh_dimension(cell.type);
        w.put(std::int32_t{d}), w.put(std::int32_t{entities[static_cast<std::size_t>(d)].at(cell.groups)});
        w.put(std::int32_t{cell.type}), w.put(Size{1}), w.end_row();
        w.put(Size{number++});
        for (const int node : cell.nodes) w.put(Size(msh_node_number(node)));
        w.end_row();
    }
    w.text("\n$EndElements\n");
    return w.out;
}

inline std::vector<std::string> all_encodings(const MshWritten& mesh) {
    return {msh_2(mesh, false), msh_2(mesh, true), msh_4(mesh, false), msh_4(mesh, true)};
}

// n cubes of 10 mm in a row along x; their lower faces are the group "base", the upper ones "top", the cubes
// "gel", the last cube "hard" as well.
inline MshWritten row_of_cubes(int n) {
    MshWritten mesh;
    for (int k = 0; k < 2; ++k) {
        for (int j = 0; j < 2; ++j) {
            for (int i = 0; i <= n; ++i) mesh.nodes.push_back({10.0 * i, 10.0 * j, 10.0 * k});
        }
    }
    const auto at = [n](int i, int j, int k) { return (k * 2 + j) * (n + 1) + i; };
    mesh.names = {{2, 1, "base"}, {2, 2, "top"}, {3, 3, "gel"}, {3, 4, "hard"}};
    mesh.cells.push_back({15, {}, {0}});
    mesh.cells.push_back({1, {}, {0, 1}});
    for (int i = 0; i < n; ++i) {
        for (int k = 0; k < 2; ++k)
            mesh.cells.push_back({3, {k + 1}, {at(i, 0, k), at(i + 1, 0, k), at(i + 1, 1, k), at(i, 1, k)}});
        mesh.cells.push_back({5,
                              i + 1 == n ? std::vector<int>{3, 4} : std::vector<int>{3},
                              {at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 1, 0), at(i, 1, 0), at(i, 0, 1), at(i + 1, 0, 1),
                               at(i + 1, 1, 1), at(i, 1, 1)}});
    }
    return mesh;
}

}  // namespace palpa::test
