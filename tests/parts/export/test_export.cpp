#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <doctest/doctest.h>
#include <png.h>
#include <thread>

#include "files/text.h"
#include "mechanics/voxel_load.h"
#include "parts/edit.h"
#include "parts/export/export.h"
#include "parts/stl_file.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/parts/small_part.h"
#include "tests/shell.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::mechanics;
using namespace palpa::parts;
using namespace palpa::test;

namespace {

// A beam of two materials with a groove, and a soft bead in it that touches itself along edges.
Part grooved_part() {
    Json json = small_part();
    json["materials"]["very soft"] = {
        {"shore_A", 40}, {"poisson", 0.49}, {"density_kg_per_m3", 1100}, {"colour", "#ccbb44"}};
    json["shape"].push_back({{"sculpt", {{"points_mm", {{2, 1, 2}, {8, 1, 2}}}, {"radius_mm", 0.7}}}});
    json["shape"].push_back(
        {{"add", {{"box", {{"min_mm", {2, 0.5, 1.5}}, {"max_mm", {2.5, 1, 2}}}}}}, {"material", "very soft"}});
    json["shape"].push_back(
        {{"add", {{"box", {{"min_mm", {2.5, 1, 1.5}}, {"max_mm", {3, 1.5, 2}}}}}}, {"material", "very soft"}});
    return parsed(json);
}

double voxels_mm3(const Part& part, std::size_t material) {
    const double pitch_mm = 1e3 * part.voxels.frame.pitch_m;
    return static_cast<double>(count(part.voxels, 3).of_material.at(material)) * std::pow(pitch_mm, 3);
}

std::size_t material_named(const Part& part, const std::string& name) {
    std::size_t m = 0;
    while (part.materials.at(m).name != name) ++m;
    return m;
}

std::int64_t white_pixels(const std::filesystem::path& file, std::array<int, 2>& size) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_file(&image, file.c_str()) != 0);
    image.format = PNG_FORMAT_GRAY;
    std::vector<png_byte> pixels(PNG_IMAGE_SIZE(image));
    REQUIRE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr) != 0);
    size = {static_cast<int>(image.width), static_cast<int>(image.height)};
    return std::count(pixels.begin(), pixels.end(), png_byte{255});
}

// What admesh says in a line of its table: "Total disconnected facets : 0 0" and the like, the first number.
int admesh_number(const std::string& table, const std::string& line) {
    const auto at = table.find(line);
    REQUIRE_MESSAGE(at != std::string::npos, table);
    return std::atoi(table.c_str() + table.find(':', at) + 1);
}

}  // namespace

TEST_CASE("export: admesh finds no open edge in any STL, and their volumes are the voxels'") {
    const TemporaryFolder folder;
    const Part part = grooved_part();
    const auto written = export_stl(part, surfaces_of(part.voxels), folder / "out");
    REQUIRE(written.size() == 3);
    for (const ExportedFile& file : written) {
        CAPTURE(file.file);
        const double mm3 = voxels_mm3(part, material_named(part, file.material));
        CHECK(1e9 * file.volume_m3 == close_to(mm3).epsilon(1e-9));
        const Called called = shell("admesh --no-check=0 " + file.file + " || admesh " + file.file);
        CAPTURE(called.out);
        CHECK(called.status == 0);
        CHECK(admesh_number(called.out, "Total disconnected facets") == 0);
        CHECK(admesh_number(called.out, "Degenerate facets") == 0);
        CHECK(admesh_number(called.out, "Backwards edges") == 0);
        const auto triangles = parse_stl(read_text(file.file), file.file, 1e-3);
        CHECK(static_cast<std::int64_t>(triangles.size()) == file.triangles);
        CHECK(1e9 * check_solid(make_solid(triangles)).volume_m3 == close_to(mm3).epsilon(1e-5));
    }
    CHECK(std::filesystem::exists(folder / "out/very_soft.stl"));
    CHECK_FALSE(std::filesystem::exists(folder / "out.partial"));
}

TEST_CASE(
    "export: a 3MF is one build item of a component per material; each edge is used twice, volumes are the voxels'") {
    const TemporaryFolder folder;
    const Part part = grooved_part();
    const auto written = export_three_mf(part, surfaces_of(part.voxels), folder / "a.3mf");
    REQUIRE(written.size() == 3);
    write_text_atomically(folder / "read.py", R"(
import sys, zipfile, xml.etree.ElementTree as tree
from collections import Counter
core = '{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}'
root = tree.fromstring(zipfile.ZipFile(sys.argv[1]).read('3D/3dmodel.model'))
print('unit', root.get('unit'))
print('items', len(root.findall(core + 'build/' + core + 'item')))
kinds = []
for o in root.iter(core + 'object'):
    mesh = o.find(core + 'mesh')
    kinds.append('mesh' if mesh is not None else 'components')
    if mesh is None:
        print('components', len(o.findall('.//' + core + 'component')), o.get('name'))
        continue
    v = [[float(p.get(c)) for c in 'xyz'] for p in mesh.iter(core + 'vertex')]
    t = [[int(f.get(c)) for c in ('v1', 'v2', 'v3')] for f in mesh.iter(core + 'triangle')]
    uses = Counter((f[i], f[(i + 1) % 3]) for f in t for i in range(3))
    bad = sum(1 for (a, b), n in uses.items() if n != 1 or uses[(b, a)] != 1)
    volume = sum(v[a][0] * (v[b][1] * v[c][2] - v[b][2] * v[c][1]) - v[a][1] * (v[b][0] * v[c][2] - v[b][2] * v[c][0])
                 + v[a][2] * (v[b][0] * v[c][1] - v[b][1] * v[c][0]) for a, b, c in t) / 6
    print('mesh', len(t), bad, repr(volume), o.get('name'))
print('order', ' '.join(kinds))
print('colours', ' '.join(b.get('displaycolor') for b in root.iter(core + 'base')))
)");
    const Called called = shell("python3 " + (folder / "read.py").string() + " " + (folder / "a.3mf").string());
    REQUIRE_MESSAGE(called.status == 0, called.err);
    CAPTURE(called.out);
    CHECK(test::contains(called.out, "unit millimeter\nitems 1\n"));
    CHECK(test::contains(called.out, "components 3 small\n"));
    CHECK(test::contains(called.out, "order mesh mesh mesh components\n"));
    CHECK(test::contains(called.out, "colours #C0C0C0FF #EE6677FF #CCBB44FF\n"));
    for (const ExportedFile& file : written) {
        CAPTURE(file.material);
        const auto at = called.out.find("mesh " + std::to_string(file.triangles) + " 0 ");
        REQUIRE(at != std::string::npos);
        const auto number = called.out.find(" 0 ", at) + 3;
        CHECK(std::atof(called.out.c_str() + number) ==
              close_to(voxels_mm3(part, material_named(part, file.material))).epsilon(1e-5));
    }
}

TEST_CASE("export: two exports are the same bytes, also in another second and after undo and redo") {
    EditedPart edited = edited_part(small_part(), "p.json");
    const auto bytes = [&] { return three_mf_bytes(edited.part, surfaces_of(edited.part.voxels, true)); };
    const std::string first = bytes();
    std::this_thread::sleep_for(std::chrono::milliseconds(2100));  // archives count time in steps of 2 s
    CHECK(bytes() == first);
    undo_edit(edited);
    CHECK(bytes() != first);
    redo_edit(edited);
    CHECK(bytes() == first);
}

TEST_CASE("export: slices have as many white pixels as there are voxels, and say their pitch") {
    const TemporaryFolder folder;
    const Part part = grooved_part();
    const auto written = export_slices(part, {5e-4, 5e-4, 5e-4}, folder / "slices");
    REQUIRE(written.size() == 3 * 4);
    std::array<std::int64_t, 3> pixels{};
    for (const ExportedFile& file : written) {
        CAPTURE(file.file);
        std::array<int, 2> size{};
        CHECK(white_pixels(file.file, size) == file.pixels);
        CHECK(size == std::array{20, 4});
        pixels[material_named(part, file.material)] += file.pixels;
    }
    const VoxelCounts counts = count(part.voxels, 3);
    for (std::size_t m = 0; m < 3; ++m) CHECK(pixels[m] == counts.of_material[m]);
    const Json json = read_json(folder / "slices/slices.json");
    CHECK(json["layers"] == 4);
    CHECK(json["pixels"] == Json{20, 4});

    // finer, with other pitches: the same volume, since all divide the voxel
    const auto fine = export_slices(part, {5e-5, 1e-4, 2.5e-4}, folder / "fine");
    double mm3 = 0.0;
    for (const ExportedFile& file : fine) mm3 += 1e9 * file.volume_m3;
    CHECK(mm3 == close_to(voxels_mm3(part, 0) + voxels_mm3(part, 1) + voxels_mm3(part, 2)).epsilon(1e-9));
    CHECK(fine.size() == 3 * 8);
}

TEST_CASE("export: the first row of a slice is the highest y, the first layer the lowest z") {
    const TemporaryFolder folder;
    Json json = small_part();
    json["shape"] =
        Json::parse(R"([{"add": {"box": {"min_mm": [0, 0, 0], "max_mm": [10, 0.5, 0.5]}}, "material": "hard"},
        {"add": {"box": {"min_mm": [0, 0, 0], "max_mm": [0.5, 2, 2]}}, "material": "hard"}])");
    const Part part = parsed(json);
    export_slices(part, {5e-4, 5e-4, 5e-4}, folder / "s");
    std::array<int, 2> size{};
    CHECK(white_pixels(folder / "s/hard-00000.png", size) == 20 + 3);
    CHECK(white_pixels(folder / "s/hard-00003.png", size) == 4);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_file(&image, (folder / "s/hard-00000.png").c_str()) != 0);
    image.format = PNG_FORMAT_GRAY;
    std::vector<png_byte> gray(PNG_IMAGE_SIZE(image));
    REQUIRE(png_image_finish_read(&image, nullptr, gray.data(), 0, nullptr) != 0);
    CHECK(gray[19] == 0);             // top right
    CHECK(gray[20 * 3 + 19] == 255);  // bottom right

    // the middle of the third layer is above the part, which is 2 mm high
    export_slices(part, {5e-4, 5e-4, 8.5e-4}, folder / "coarse");
    CHECK(white_pixels(folder / "coarse/hard-00001.png", size) > 0);
    CHECK(white_pixels(folder / "coarse/hard-00002.png", size) == 0);
    CHECK(test::contains(message_of([&] {
                             export_slices(part, {5e-4, 5e-4, 5e-3}, folder / "thick");
                         }),
                         "pixels that all miss"));
}

TEST_CASE("bad input: slices too fine, folders that are not empty; nothing is left behind") {
    const TemporaryFolder folder;
    const Part part = grooved_part();
    const auto refused = [&](double x_m, double z_m) {
        return message_of([&] { export_slices(part, {x_m, 1e-4, z_m}, folder / "s"); });
    };
    CHECK(test::contains(refused(1e-7, 1e-4), "pixels along an axis"));
    CHECK(test::contains(refused(1e-4, 3.3e-8), "images, expected at most 100000"));
    CHECK_FALSE(std::filesystem::exists(folder / "s"));
    std::filesystem::create_directory(folder / "full");
    write_text_atomically(folder / "full/a.txt", "a");
    const auto surfaces = surfaces_of(part.voxels);
    CHECK(test::contains(message_of([&] { export_stl(part, surfaces, folder / "full"); }), "a new or an empty folder"));
    CHECK_THROWS_AS(export_stl(part, surfaces, "/proc/nothing/here"), std::runtime_error);
    CHECK_THROWS_AS(export_three_mf(part, surfaces, folder / "no/such/a.3mf"), std::runtime_error);
}

TEST_CASE("export: names of files are plain, and each material has its own") {
    Part part = grooved_part();
    part.materials[0].name = "Shore A/60";
    part.materials[1].name = "Shore A 60";
    part.materials[2].name = "";
    CHECK(file_names(part) == std::vector<std::string>{"Shore_A_60", "Shore_A_60_2", "_"});
    part.materials[1].name = "shore a 60";  // some disks take both for one name
    CHECK(file_names(part)[1] == "shore_a_60_2");
}
