#include <doctest/doctest.h>
#include <random>

#include "files/text.h"
#include "parts/info.h"
#include "parts/runs_file.h"
#include "tests/error_message.h"
#include "tests/parts/small_part.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::mechanics;
using namespace palpa::parts;
using namespace palpa::test;

namespace {

// What a file of such rows says of voxels of 10 x 4 x 3 with two materials.
std::string refusal(const std::vector<std::int32_t>& values, std::vector<std::size_t> shape = {}) {
    if (shape.empty()) shape = {values.size() / 5, 5};
    const Voxels voxels = empty_voxels({10, 4, 3}, {});
    return message_of([&] { runs_of({shape, values}, "r.npy", voxels, 2); });
}

}  // namespace

TEST_CASE("runs: what is written makes the same part again") {
    const TemporaryFolder folder;
    const Part part = parsed(small_part());
    write_runs(part.voxels, folder / "runs.npy");
    Json json = small_part();
    json["shape"] = Json::array({{{"runs", "runs.npy"}}});
    write_text_atomically(folder / "p.json", json_text(json));
    CHECK(info_of(read_part(folder / "p.json")).runs_sha256 == info_of(part).runs_sha256);
}

TEST_CASE("runs: random rows, in any order, lie over what is there as single voxels do; undo brings it back") {
    constexpr unsigned kSeed = 5;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    Voxels voxels = empty_voxels({24, 5, 4}, {});
    EditHistory history;
    std::vector<int> plain(24 * 5 * 4, -1);
    for (int round = 0; round < 60; ++round) {
        CAPTURE(round);
        std::vector<std::int32_t> rows;
        std::int64_t changed = 0;
        for (int z = 3; z >= 0; --z) {
            for (int y = 0; y < 5; ++y) {
                int x = static_cast<int>(random() % 9);
                while (x < 20 && random() % 3 != 0) {
                    const int end = std::min<int>(24, x + 1 + static_cast<int>(random() % 6));
                    const int material = static_cast<int>(random() % 2);
                    rows.insert(rows.end(), {z, y, x, end, material});
                    for (int i = x; i < end; ++i) {
                        int& voxel = plain[static_cast<std::size_t>(i + 24 * (y + 5 * z))];
                        changed += voxel != material ? 1 : 0;
                        voxel = material;
                    }
                    x = end + static_cast<int>(random() % 4);
                }
            }
        }
        if (rows.empty()) continue;
        const auto before = voxels.lines;
        CHECK(overlay(runs_of({{rows.size() / 5, 5}, rows}, "r.npy", voxels, 2), voxels, history) == changed);
        int wrong = 0;
        for (int i = 0; i < 24 * 5 * 4; ++i)
            wrong += material_at(voxels, i % 24, i / 24 % 5, i / 120) == plain[static_cast<std::size_t>(i)] ? 0 : 1;
        CHECK(wrong == 0);
        const auto after = voxels.lines;
        CHECK(undo(voxels, history));
        CHECK(voxels.lines == before);
        CHECK(redo(voxels, history));
        CHECK(voxels.lines == after);
    }
}

TEST_CASE("bad input: runs that overlap, leave the voxels, are empty or of a material that is not there") {
    CHECK(refusal({0, 0, 0, 5, 0, 0, 0, 5, 9, 0, 2, 3, 9, 10, 1}).empty());
    CHECK(test::contains(refusal({1, 1, 4, 9, 0, 1, 1, 0, 5, 0}),
                         "row 0: found 1 1 4 9 0, expected runs that do not overlap"));
    CHECK(test::contains(refusal({0, 0, 0, 11, 0}), "row 0"));
    CHECK(test::contains(refusal({0, 0, 3, 3, 0}), "x0 < x1"));
    CHECK(test::contains(refusal({0, 0, 0, 1, 0, 3, 0, 0, 1, 0}), "row 1"));
    CHECK(test::contains(refusal({0, 0, 0, 1, 2}), "material 2"));
    CHECK(test::contains(refusal({0, 0, 0, 1, -1}), "0 to 1"));
    CHECK(test::contains(refusal({0, 0, 0, 1}, {1, 4}), "(n, 5)"));
    CHECK(test::contains(refusal({}, {0, 5}), "(n, 5)"));
}
