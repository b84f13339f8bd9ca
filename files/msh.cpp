#include "files/msh.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <unordered_map>

#include "files/input_error.h"
#include "files/msh_cursor.h"
#include "files/text.h"

namespace palpa::files {
namespace {

struct Reading {
    MshCursor in;
    bool version_4 = false;
    bool have_format = false;
    bool have_nodes = false;
    bool have_elements = false;
    std::unordered_map<std::uint64_t, int> node_at;                    // number in the file -> position
    std::map<std::pair<int, int>, std::vector<int>> groups_of_entity;  // (dimension, entity) -> physical tags
    std::map<std::pair<int, int>, std::size_t> group_at;               // (dimension, physical tag) -> position
    Msh msh;
};

void read_format(Reading& r) {
    const auto version = r.in.word("a version");
    r.version_4 = version == "4.1";
    if (!r.version_4 && version != "2.2" && version != "2.1" && version != "2") {
        r.in.fail("version " + shown(version), "2.2 or 4.1 (in Gmsh: Mesh.MshFileVersion)");
    }
    const auto kind = r.in.word_integer("0 (ASCII) or 1 (binary)");
    if (kind != 0 && kind != 1) r.in.fail(std::to_string(kind), "0 (ASCII) or 1 (binary)");
    const auto data_size = r.in.word_integer("data size 8");
    if (data_size != 8) r.in.fail("data size " + std::to_string(data_size), "8");
    r.in.rest_of_line();
    r.in.binary = kind == 1;
    if (r.in.binary) {
        const int one = r.in.integer("the number 1 in four bytes");
        if (one != 1) r.in.fail(std::to_string(one), "the number 1 in four bytes (a little-endian file)");
    }
    r.have_format = true;
}

MshGroup& group_of(int dimension, int tag, Reading& r) {
    const auto [it, is_new] = r.group_at.try_emplace({dimension, tag}, r.msh.groups.size());
    if (is_new) r.msh.groups.push_back({dimension, tag, "", {}});
    return r.msh.groups[it->second];
}

void read_names(Reading& r) {
    const auto count = r.in.word_integer("the number of physical names");
    if (count < 0) r.in.fail(std::to_string(count), "a number of physical names");
    for (std::int64_t i = 0; i < count; ++i) {  // each takes a line, so the loop ends with the file
        const auto dimension = r.in.word_integer("a dimension 0 to 3");
        if (dimension < 0 || dimension > 3) r.in.fail(std::to_string(dimension), "a dimension 0 to 3");
        const auto tag = r.in.word_integer("a physical tag");
        if (tag <= 0 || tag > INT32_MAX) r.in.fail(std::to_string(tag), "a physical tag > 0");
        const auto line = r.in.rest_of_line();
        const auto first = line.find('"');
        const auto last = line.rfind('"');
        if (first == last) r.in.fail(shown(line), "a name in quotation marks");
        std::string& name = group_of(static_cast<int>(dimension), static_cast<int>(tag), r).name;
        if (!name.empty()) {
            r.in.fail("a second name for group " + std::to_string(tag) + ", which is called " + shown(name),
                      "one name for each group");
        }
        name = line.substr(first + 1, last - first - 1);
    }
}

// Reads an entity, of which only the physical tags matter here.
void read_entity(int dimension, Reading& r) {
    const int tag = r.in.integer("an entity's tag");
    for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) r.in.real("a coordinate of an entity");
    const auto physical = r.in.size("the number of physical tags");
    r.in.check_count(physical, 2, 4, "physical tags");
    for (std::uint64_t i = 0; i < physical; ++i) {
        const int group = r.in.integer("a physical tag");  // negative: with reversed orientation
        if (group == 0 || group == INT32_MIN) r.in.fail(std::to_string(group), "a physical tag other than 0");
        r.groups_of_entity[{dimension, tag}].push_back(std::abs(group));
    }
    if (dimension == 0) return;
    const auto bounding = r.in.size("the number of bounding entities");
    r.in.check_count(bounding, 2, 4, "bounding entities");
    for (std::uint64_t i = 0; i < bounding; ++i) r.in.integer("a bounding entity's tag");
}

void read_entities(Reading& r) {
    std::array<std::uint64_t, 4> counts{};
    for (auto& count : counts) count = r.in.size("a number of entities");
    for (int dimension = 0; dimension < 4; ++dimension) {
        const auto count = counts[static_cast<std::size_t>(dimension)];
        r.in.check_count(count, 10, 36, "entities");
        for (std::uint64_t i = 0; i < count; ++i) read_entity(dimension, r);
    }
}

void add_node_number(std::uint64_t number, Reading& r) {
    const int position = static_cast<int>(r.node_at.size());
    if (!r.node_at.try_emplace(number, position).second) {
        r.in.fail("node " + std::to_string(number) + " a second time", "each node once");
    }
    r.msh.node_number.push_back(number);
}

void read_coordinates(Reading& r) {
    for (const char* axis : {"a coordinate x", "a coordinate y", "a coordinate z"}) {
        r.msh.nodes.push_back(r.in.real(axis));
    }
}

void read_nodes_2(Reading& r) {
    const auto count = r.in.word_integer("the number of nodes");
    r.in.rest_of_line();
    if (count < 0) r.in.fail(std::to_string(count), "a number of nodes");
    r.in.check_count(static_cast<std::uint64_t>(count), 8, 28, "nodes");
    for (std::int64_t i = 0; i < count; ++i) {
        add_node_number(static_cast<std::uint64_t>(r.in.integer("a node's number")), r);
        read_coordinates(r);
    }
}

void read_nodes_4(Reading& r) {
    const auto blocks = r.in.size("the number of entity blocks");
    const auto total = r.in.size("the number of nodes");
    r.in.size("the least node number");
    r.in.size("the greatest node number");
    r.in.check_count(blocks, 8, 20, "entity blocks");
    r.in.check_count(total, 8, 32, "nodes");
    for (std::uint64_t block = 0; block < blocks; ++block) {
        const int dimension = r.in.integer("an entity's dimension");
        r.in.integer("an entity's tag");
        const int parametric = r.in.integer("parametric 0 or 1");
        if (dimension < 0 || dimension > 3 || parametric < 0 || parametric > 1) {
            r.in.fail(std::to_string(dimension) + " and " + std::to_string(parametric),
                      "a dimension 0 to 3 and parametric 0 or 1");
        }
        const auto count = r.in.size("the number of nodes in the block");
        r.in.check_count(count, 8, 32, "nodes");
        for (std::uint64_t i = 0; i < count; ++i) add_node_number(r.in.size("a node's number"), r);
        for (std::uint64_t i = 0; i < count; ++i) {
            read_coordinates(r);
            for (int k = 0; k < parametric * dimension; ++k) r.in.real("a parametric coordinate");
        }
    }
    if (r.msh.n_nodes() != total) {
        r.in.fail(std::to_string(r.msh.n_nodes()) + " nodes in the blocks", std::to_string(total) + " as announced");
    }
}

struct CellType {
    int corners = 0;
    int kind = -1;  // a MshKind; -1: ignored
    int dimension = 0;
};

CellType type_of(std::int64_t type, const MshCursor& in) {
    switch (type) {
        case 1:
            return {2, -1, 1};
        case 2:
            return {3, static_cast<int>(MshKind::triangle), 2};
        case 3:
            return {4, static_cast<int>(MshKind::quad), 2};
        case 4:
            return {4, static_cast<int>(MshKind::tet), 3};
        case 5:
            return {8, static_cast<int>(MshKind::hex), 3};
        case 15:
            return {1, -1, 0};
        default:
            break;
    }
    const char* name = type == 6                 ? " (prism)"
                       : type == 7               ? " (pyramid)"
                       : type >= 8 && type <= 14 ? " (second order)"
                                                 : "";
    in.fail("an element of type " + std::to_string(type) + name,
            "triangles, quads, tetrahedra or hexahedra of first order (types 2 to 5)");
}

// Reads the nodes of one cell; `next` gives a node's number.
template <class Next>
void add_cell(const CellType& type, std::uint64_t number, const std::vector<int>& groups, Next&& next, Reading& r) {
    if (type.kind < 0) {
        for (int k = 0; k < type.corners; ++k) next();
        return;
    }
    const auto kind = static_cast<std::size_t>(type.kind);
    MshCells& cells = r.msh.cells[kind];
    for (int k = 0; k < type.corners; ++k) {
        const std::uint64_t node = next();
        const auto it = r.node_at.find(node);
        if (it == r.node_at.end()) {
            r.in.fail("element " + std::to_string(number) + " with node " + std::to_string(node),
                      "a node that the file holds");
        }
        cells.nodes.push_back(it->second);
    }
    cells.number.push_back(number);
    for (const int tag : groups) {
        group_of(type.dimension, tag, r).cells[kind].push_back(static_cast<int>(cells.number.size()) - 1);
    }
}

// Reads number, tags and nodes; both encodings have this order once the type and the number of tags are known.
void read_cell_2(const CellType& type, int n_tags, std::uint64_t number, Reading& r) {
    std::vector<int> groups;
    for (int k = 0; k < n_tags; ++k) {
        const int tag = r.in.integer("a tag");
        if (k == 0 && tag > 0) groups.push_back(tag);  // the first is the physical group, 0 = none
    }
    add_cell(
        type, number, groups, [&] { return static_cast<std::uint64_t>(r.in.integer("a node's number")); }, r);
}

int tag_count(Reading& r) {
    const int n_tags = r.in.integer("the number of tags");
    if (n_tags < 0 || n_tags > 1000) r.in.fail(std::to_string(n_tags), "a number of tags");
    return n_tags;
}

void read_elements_2(Reading& r) {
    const auto count = r.in.word_integer("the number of elements");
    r.in.rest_of_line();
    if (count < 0) r.in.fail(std::to_string(count), "a number of elements");
    r.in.check_count(static_cast<std::uint64_t>(count), 7, 8, "elements");
    for (std::int64_t done = 0; done < count;) {
        if (!r.in.binary) {
            const int number = r.in.integer("an element's number");
            const CellType type = type_of(r.in.integer("an element's type"), r.in);
            read_cell_2(type, tag_count(r), static_cast<std::uint64_t>(number), r);
            ++done;
            continue;
        }
        const CellType type = type_of(r.in.integer("an element's type"), r.in);
        const int follow = r.in.integer("the number of elements that follow");
        const int n_tags = tag_count(r);
        if (follow < 1 || follow > count - done) {
            r.in.fail(std::to_string(follow) + " elements", "1 to " + std::to_string(count - done));
        }
        for (int i = 0; i < follow; ++i) {
            const int number = r.in.integer("an element's number");
            read_cell_2(type, n_tags, static_cast<std::uint64_t>(number), r);
        }
        done += follow;
    }
}

void read_elements_4(Reading& r) {
    const auto blocks = r.in.size("the number of entity blocks");
    const auto total = r.in.size("the number of elements");
    r.in.size("the least element number");
    r.in.size("the greatest element number");
    r.in.check_count(blocks, 8, 20, "entity blocks");
    std::uint64_t seen = 0;
    for (std::uint64_t block = 0; block < blocks; ++block) {
        const int dimension = r.in.integer("an entity's dimension");
        const int entity = r.in.integer("an entity's tag");
        const CellType type = type_of(r.in.integer("an element's type"), r.in);
        if (dimension != type.dimension) {
            r.in.fail("cells of dimension " + std::to_string(type.dimension) + " in an entity of dimension " +
                          std::to_string(dimension),
                      "equal dimensions");
        }
        const auto count = r.in.size("the number of elements in the block");
        r.in.check_count(count, 4, 16, "elements");
        const auto groups = r.groups_of_entity.find({dimension, entity});
        const std::vector<int> none;
        for (std::uint64_t i = 0; i < count; ++i) {
            const auto number = r.in.size("an element's number");
            add_cell(
                type, number, groups == r.groups_of_entity.end() ? none : groups->second,
                [&] { return r.in.size("a node's number"); }, r);
        }
        seen += count;
    }
    if (seen != total) {
        r.in.fail(std::to_string(seen) + " elements in the blocks", std::to_string(total) + " as announced");
    }
}

// Keeps only the first of several cells with the same corners.
void merge_repeated(std::size_t kind, Msh& msh) {
    MshCells& cells = msh.cells[kind];
    const auto corners = static_cast<std::size_t>(kMshCorners[kind]);
    const std::size_t n = cells.number.size();
    std::vector<std::array<int, 8>> key(n);
    for (std::size_t i = 0; i < n; ++i) {
        key[i].fill(-1);
        std::copy_n(cells.nodes.begin() + static_cast<std::ptrdiff_t>(corners * i), corners, key[i].begin());
        std::sort(key[i].begin(), key[i].end());
    }
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key[a] < key[b]; });
    std::vector<std::size_t> first(n);
    for (std::size_t i = 0; i < n; ++i) {
        const bool repeats = i > 0 && key[order[i]] == key[order[i - 1]];
        first[order[i]] = repeats ? first[order[i - 1]] : order[i];
    }
    std::vector<int> kept_as(n);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < n; ++i) {
        if (first[i] != i) {
            kept_as[i] = kept_as[first[i]];
            continue;
        }
        for (std::size_t k = 0; k < corners; ++k) cells.nodes[corners * kept + k] = cells.nodes[corners * i + k];
        cells.number[kept] = cells.number[i];
        kept_as[i] = static_cast<int>(kept++);
    }
    cells.nodes.resize(corners * kept);
    cells.number.resize(kept);
    for (MshGroup& group : msh.groups) {
        auto& list = group.cells[kind];
        for (int& cell : list) cell = kept_as[static_cast<std::size_t>(cell)];
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
}

void need(bool there, const char* section, const MshCursor& in) {
    if (!there) in.fail("no $" + std::string(section) + " so far", "it here");
}

void read_section(const std::string& name, Reading& r) {
    if (name == "MeshFormat") return read_format(r);
    need(r.have_format, "MeshFormat", r.in);
    if (name == "PartitionedEntities") r.in.fail("a partitioned mesh", "one that is whole");
    if (name == "PhysicalNames") return read_names(r);
    if (name == "Entities" && r.version_4) return read_entities(r);
    if (name == "Nodes") {
        if (r.have_nodes) r.in.fail("$Nodes a second time", "it once");
        r.have_nodes = true;
        return r.version_4 ? read_nodes_4(r) : read_nodes_2(r);
    }
    if (name == "Elements") {
        need(r.have_nodes, "Nodes", r.in);
        if (r.have_elements) r.in.fail("$Elements a second time", "it once");
        r.have_elements = true;
        return r.version_4 ? read_elements_4(r) : read_elements_2(r);
    }
    r.in.skip_past("$End" + name);
}

}  // namespace

Msh parse_msh(std::string_view bytes, const std::string& file_name) {
    Reading r{MshCursor(bytes, file_name), false, false, false, false, {}, {}, {}, {}};
    while (!r.in.at_end()) {
        const std::string heading(r.in.word("a section"));
        if (heading.size() < 2 || heading.front() != '$') {
            r.in.fail(shown(heading),
                      r.have_format ? "a section such as $Nodes" : "a Gmsh file that begins with $MeshFormat");
        }
        const std::string name = heading.substr(1);
        const bool read_here = name == "MeshFormat" || name == "PhysicalNames" || name == "Nodes" ||
                               name == "Elements" || (name == "Entities" && r.version_4);
        r.in.rest_of_line();
        read_section(name, r);
        if (!read_here) continue;  // skipped with its end
        const auto end = r.in.word("$End" + name);
        if (end != "$End" + name) r.in.fail(shown(end), "$End" + name);
    }
    need(r.have_format, "MeshFormat", r.in);
    need(r.have_nodes, "Nodes", r.in);
    need(r.have_elements, "Elements", r.in);
    for (std::size_t kind = 0; kind < kMshKinds; ++kind) merge_repeated(kind, r.msh);
    return std::move(r.msh);
}

Msh read_msh(const std::filesystem::path& path) { return parse_msh(read_text(path), path.string()); }

}  // namespace palpa::files
