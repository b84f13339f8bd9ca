#include <cmath>
#include <doctest/doctest.h>

#include "files/mat.h"
#include "files/text.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

TEST_CASE("mat: three-dimensional arrays and rows come back with every value at its place") {
    const TemporaryFolder folder;
    MatArray array{"normal_N", {2, 3, 4}, {}};
    for (int i = 0; i < 24; ++i) array.values.push_back(0.1f * static_cast<float>(i));
    array.values[7] = std::nanf("");
    write_mat({array, {"x_mm", {1, 3}, {1.0f, 2.5f, 4.0f}}}, folder / "m.mat");
    const MatArray read = read_mat("normal_N", folder / "m.mat");
    CHECK(read.shape == array.shape);
    for (std::size_t i = 0; i < 24; ++i)
        CHECK((i == 7 ? std::isnan(read.values[i]) : read.values[i] == array.values[i]));
    CHECK(read_mat("x_mm", folder / "m.mat").values == std::vector<float>{1.0f, 2.5f, 4.0f});
    CHECK(
        contains(message_of([&] { read_mat("other", folder / "m.mat"); }), "other: found no array of single numbers"));
    write_text_atomically(folder / "text.mat", "no matrix");
    CHECK(contains(message_of([&] { read_mat("x_mm", folder / "text.mat"); }), "no MATLAB file"));
    CHECK_THROWS_AS(write_mat({array}, folder / "no/such/m.mat"), std::runtime_error);
}
