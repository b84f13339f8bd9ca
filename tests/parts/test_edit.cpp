#include <doctest/doctest.h>
#include <filesystem>
#include <random>

#include "files/text.h"
#include "parts/edit.h"
#include "parts/info.h"
#include "parts/runs_file.h"
#include "tests/error_message.h"
#include "tests/parts/small_part.h"
#include "tests/parts/solids.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::parts;
using namespace palpa::test;

namespace {

Json ball_edit(double x_mm, const char* kind, const char* material = nullptr) {
    Json out{{kind, {{"sphere", {{"centre_mm", {x_mm, 1, 2}}, {"radius_mm", 0.9}}}}}};
    if (material != nullptr) out["material"] = material;
    return out;
}

std::string hash_of(const EditedPart& edited) { return info_of(edited.part).runs_sha256; }

}  // namespace

TEST_CASE("edit: appended operations are those of a part file with them; undo and redo keep JSON and voxels in step") {
    EditedPart edited = edited_part(small_part(), "p.json");
    std::vector<std::string> hashes{hash_of(edited)};
    CHECK(edit(ball_edit(2, "permute", "soft"), edited) > 0);
    hashes.push_back(hash_of(edited));
    CHECK(edit(Json::parse(R"({"sculpt": {"points_mm": [[4, 1, 2]], "radius_mm": 0.8}})"), edited) > 0);
    hashes.push_back(hash_of(edited));
    CHECK(edited.json["shape"].size() == 4);
    CHECK(info_of(parsed(edited.json)).runs_sha256 == hashes[2]);

    CHECK(undo_edit(edited));
    CHECK(hash_of(edited) == hashes[1]);
    CHECK(undo_edit(edited));
    CHECK(hash_of(edited) == hashes[0]);
    CHECK(redo_edit(edited));
    CHECK(hash_of(edited) == hashes[1]);
    CHECK(info_of(parsed(edited.json)).runs_sha256 == hashes[1]);
    CHECK(edit(ball_edit(8, "remove"), edited) > 0);
    CHECK_FALSE(redo_edit(edited));
}

TEST_CASE("edit: the first operation stays") {
    EditedPart edited = edited_part(small_part(), "p.json");
    CHECK(undo_edit(edited));
    CHECK_FALSE(undo_edit(edited));
    CHECK(edited.json["shape"].size() == 1);
    CHECK(redo_edit(edited));
}

TEST_CASE("edit: what is refused leaves the part and its redo as they were") {
    EditedPart edited = edited_part(small_part(), "p.json");
    edit(ball_edit(2, "permute", "soft"), edited);
    const std::string later = hash_of(edited);
    undo_edit(edited);
    const std::string before = hash_of(edited);
    const auto refused = [&](const char* operation) {
        return message_of([&] { edit(Json::parse(operation), edited); });
    };
    CHECK(test::contains(refused(R"({"remove": {"all": true}})"), "nothing left"));
    CHECK(test::contains(refused(R"({"remove": {"box": {"min_mm": [4, 0, 0], "max_mm": [6, 2, 2]}}})"), "2 bodies"));
    CHECK(test::contains(refused(R"({"remove": {"sphere": {"centre_mm": [40, 0, 0], "radius_mm": 2}}})"),
                         "shape[2].remove: found a volume outside"));
    CHECK(test::contains(refused(R"({"permute": {"all": true}, "material": "gel"})"), "hard, soft"));
    CHECK(test::contains(refused(R"({"smooth": 1})"), "smooth"));
    CHECK(test::contains(refused("3"), "shape[2]"));
    CHECK(hash_of(edited) == before);
    CHECK(edited.json["shape"].size() == 2);
    REQUIRE(redo_edit(edited));
    CHECK(hash_of(edited) == later);
}

TEST_CASE("edit: a saved part is the same part, from another folder too") {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "solids");
    std::filesystem::create_directory(folder / "saved");
    write_text_atomically(folder / "solids/box.stl", binary_stl(box_triangles({0, 0, 0}, {6, 2, 2})));
    write_runs(parsed(small_part()).voxels, folder / "solids/runs.npy");
    Json json = small_part();
    json["shape"] = Json::array({{{"runs", "solids/runs.npy"}}});
    write_text_atomically(folder / "a.json", json_text(json));
    EditedPart edited = open_part(folder / "a.json");
    const Json stl{{"stl", {{"file", "solids/box.stl"}, {"unit", "mm"}}}};
    edit({{"permute", {{"both", {stl, {{"all", true}}}}}}, {"material", "soft"}}, edited);
    save_part(edited, folder / "saved/b.json");
    const EditedPart again = open_part(folder / "saved/b.json");
    CHECK(hash_of(again) == hash_of(edited));
    CHECK(again.json["shape"][0]["runs"] == "../solids/runs.npy");
    save_part(again, folder / "c.json");
    CHECK(open_part(folder / "c.json").json["shape"] == edited.json["shape"]);
}

TEST_CASE("edit: random edits, undone to the first, give the first part") {
    constexpr unsigned kSeed = 17;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> place(0.0, 10.0);
    EditedPart edited = edited_part(small_part(), "p.json");
    const std::string first = hash_of(edited);
    int done = 0;
    for (int i = 0; i < 60; ++i) {
        const auto kind = random() % 3;
        const Json operation = kind == 0   ? ball_edit(place(random), "permute", "soft")
                               : kind == 1 ? ball_edit(place(random), "add", "hard")
                                           : ball_edit(place(random), "remove");
        done += message_of([&] { edit(operation, edited); }).empty() ? 1 : 0;
    }
    CHECK(done > 30);
    CHECK(info_of(parsed(edited.json)).runs_sha256 == hash_of(edited));
    for (int i = 0; i < done; ++i) CHECK(undo_edit(edited));
    CHECK(hash_of(edited) == first);
}
