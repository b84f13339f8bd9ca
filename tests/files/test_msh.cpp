#include <doctest/doctest.h>
#include <random>

#include "files/msh.h"
#include "files/text.h"
#include "tests/error_message.h"
#include "tests/files/msh_writer.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

std::string said(const std::string& bytes) {
    return message_of([&] { parse_msh(bytes, "m.msh"); });
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    const auto at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), with);
}

// One tetrahedron in the layout of the format description (4.1, ASCII), with a section of no interest.
const char* const kTetrahedron =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    "$Comments\nanything $Nodes here\n$EndComments\n"
    "$Entities\n1 0 1 1\n"
    "1 0 0 0 0 \n"
    "1 0 0 0 1 1 1 1 5 0 \n"
    "1 0 0 0 1 1 1 0 1 1 \n"
    "$EndEntities\n"
    "$Nodes\n2 4 1 4\n0 1 0 1\n1\n0 0 0\n3 1 0 3\n2\n3\n4\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n"
    "$Elements\n2 2 1 2\n2 1 2 1\n1 1 3 2 \n3 1 4 1\n2 1 2 3 4 \n$EndElements\n";

}  // namespace

TEST_CASE("msh: 2.2 and 4.1, ASCII and binary, give the same mesh") {
    const MshWritten written = row_of_cubes(3);
    for (const std::string& bytes : all_encodings(written)) {
        CAPTURE(bytes.substr(0, 20));
        const Msh msh = parse_msh(bytes, "m.msh");
        REQUIRE(msh.n_nodes() == written.nodes.size());
        for (std::size_t i = 0; i < msh.nodes.size(); ++i) CHECK(msh.nodes[i] == written.nodes[i / 3][i % 3]);
        REQUIRE(msh.count(MshKind::hex) == 3);
        CHECK(msh.count(MshKind::quad) == 6);
        CHECK(msh.count(MshKind::tet) == 0);
        CHECK(msh.count(MshKind::triangle) == 0);
        std::vector<int> hexes;
        for (const auto& cell : written.cells) {
            if (cell.type == 5) hexes.insert(hexes.end(), cell.nodes.begin(), cell.nodes.end());
        }
        CHECK(msh.of(MshKind::hex).nodes == hexes);
        REQUIRE(msh.groups.size() == 4);
        CHECK(msh.groups[0].name == "base");
        CHECK(msh.groups[0].dimension == 2);
        CHECK(msh.groups[0].cells[1] == std::vector<int>{0, 2, 4});
        CHECK(msh.groups[1].cells[1] == std::vector<int>{1, 3, 5});
        CHECK(msh.groups[2].cells[3] == std::vector<int>{0, 1, 2});
        CHECK(msh.groups[3].name == "hard");  // the last cube is in two groups, and still one cube
        CHECK(msh.groups[3].cells[3] == std::vector<int>{2});
    }
}

TEST_CASE("msh: a tetrahedron, unknown sections passed over, groups without a name") {
    const Msh msh = parse_msh(kTetrahedron, "m.msh");
    CHECK(msh.count(MshKind::tet) == 1);
    CHECK(msh.of(MshKind::tet).nodes == std::vector<int>{0, 1, 2, 3});
    CHECK(msh.of(MshKind::triangle).nodes == std::vector<int>{0, 2, 1});
    CHECK(msh.of(MshKind::tet).number == std::vector<std::uint64_t>{2});
    REQUIRE(msh.groups.size() == 1);
    CHECK(msh.groups[0].tag == 5);
    CHECK(msh.groups[0].name.empty());
    const TemporaryFolder folder;
    write_text_atomically(folder / "t.msh", kTetrahedron);
    CHECK(read_msh(folder / "t.msh").nodes == msh.nodes);
    CHECK(contains(message_of([&] { read_msh(folder / "none.msh"); }), "none.msh: cannot be read"));
}

TEST_CASE("msh: CRLF line ends read like LF") {
    std::string text = msh_2(row_of_cubes(1), false);
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, 1, '\r');
    CHECK(parse_msh(text, "m.msh").count(MshKind::hex) == 1);
}

TEST_CASE("msh: what is refused says line or byte, what was found, what was expected") {
    const std::string two = msh_2(row_of_cubes(1), false);
    const std::string four = msh_4(row_of_cubes(1), false);
    CHECK(contains(said(""), "m.msh: line 1: found no $MeshFormat"));
    CHECK(contains(said("solid cube\n"), "found 'solid', expected a Gmsh file that begins with $MeshFormat"));
    CHECK(contains(said(replaced(two, "2.2", "4.0")), "line 2: found version '4.0', expected 2.2 or 4.1"));
    CHECK(contains(said(replaced(two, "2.2 0 8", "2.2 0 4")), "found data size 4, expected 8"));
    CHECK(contains(said(replaced(two, "2.2 0 8", "2.2 7 8")), "found 7, expected 0 (ASCII) or 1 (binary)"));
    CHECK(contains(said(replaced(two, "\"base\"", "base")), "a name in quotation marks"));
    CHECK(contains(said(replaced(two, "17 10 0 0", "17 10 0,5 0")), "found '0,5', expected a coordinate y"));
    CHECK(contains(said(replaced(two, "17 10 0 0", "17 10 0 inf")), "found inf, expected a finite number"));
    CHECK(contains(said(replaced(two, "17 10 0 0", "7 10 0 0")), "found node 7 a second time"));
    CHECK(contains(said(replaced(two, " 5 2 3 1 7 17", " 5 2 3 1 7 18")),
                   "with node 18, expected a node that the file holds"));
    CHECK(contains(said(replaced(two, " 5 2 3 1 7 17", " 6 2 3 1 7 17")), "type 6 (prism)"));
    CHECK(contains(said(replaced(two, " 5 2 3 1 7 17", " 17 2 3 1 7 17")), "first order"));
    CHECK(contains(said(replaced(two, "$EndNodes", "$EndNode")), "expected $EndNodes"));
    CHECK(contains(said(two.substr(0, two.find("$Elements"))), "found no $Elements so far"));
    CHECK(contains(said(two.substr(0, two.size() - 30)), "found the end of the file"));
    CHECK(contains(said(replaced(four, "$Entities", "$PartitionedEntities")), "a partitioned mesh"));
    CHECK(contains(said(replaced(four, "$Elements\n5 5", "$Elements\n5 6")), "5 elements in the blocks, expected 6"));
    CHECK(contains(said(replaced(four, "$Nodes\n2 8", "$Nodes\n2 9")), "8 nodes in the blocks, expected 9"));
    const std::string swapped =
        replaced(msh_2(row_of_cubes(1), true), std::string("\x01\x00\x00\x00", 4), std::string("\x00\x00\x00\x01", 4));
    CHECK(contains(said(swapped), "little-endian"));
    CHECK(contains(said(swapped), "m.msh: byte "));
}

TEST_CASE("hard case 31: msh with impossible counts allocates nothing for them") {
    const std::string two = msh_2(row_of_cubes(1), false);
    const std::string four = msh_4(row_of_cubes(1), false);
    CHECK(contains(said(replaced(two, "$Nodes\n8", "$Nodes\n999999999999")), "999999999999 nodes announced with"));
    CHECK(contains(said(replaced(two, "$Nodes\n8", "$Nodes\n-8")), "found -8"));
    CHECK(contains(said(replaced(two, "$Nodes\n8", "$Nodes\n99999999999999999999999")), "the number of nodes"));
    CHECK(contains(said(replaced(two, "$Elements\n6", "$Elements\n888888888888")), "888888888888 elements announced"));
    CHECK(contains(said(replaced(four, "$Nodes\n2 8", "$Nodes\n2 18446744073709551615")),
                   "18446744073709551615 nodes announced"));
    CHECK(contains(said(replaced(four, "$Entities\n1", "$Entities\n999999999")), "999999999 entities announced"));
    CHECK(contains(said(replaced(four, "$Elements\n5 5", "$Elements\n500000000000 5")),
                   "500000000000 entity blocks announced"));
}

TEST_CASE("hard case 31: random damage to a msh file ends in a reading or a refusal") {
    constexpr std::uint32_t kSeed = 41;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    for (const std::string& good : all_encodings(row_of_cubes(2))) {
        int refused = 0;
        for (int i = 0; i < 3000; ++i) {
            std::string bytes = i % 2 == 0 ? good : good.substr(0, random() % (good.size() + 1));
            for (int k = 0; k < 3 && !bytes.empty(); ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
            refused += !said(bytes).empty();
        }
        CHECK(refused > 1500);
    }
}

TEST_CASE("msh: nodes keep their numbers, and a group has one name") {
    for (const std::string& bytes : all_encodings(row_of_cubes(1))) {
        const Msh msh = parse_msh(bytes, "m.msh");
        REQUIRE(msh.node_number.size() == msh.n_nodes());
        for (std::size_t i = 0; i < msh.n_nodes(); ++i)
            CHECK(msh.node_number[i] == static_cast<std::uint64_t>(msh_node_number(static_cast<int>(i))));
    }
    MshWritten twice = row_of_cubes(1);
    twice.names.push_back({2, 1, "floor"});
    for (const std::string& bytes : all_encodings(twice))
        CHECK(contains(said(bytes), "found a second name for group 1, which is called 'base'"));
}
