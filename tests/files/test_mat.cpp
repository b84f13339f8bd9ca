#include <cmath>
#include <csignal>
#include <doctest/doctest.h>
#include <filesystem>
#include <sys/resource.h>

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

TEST_CASE("mat: a file that the disk cannot hold is an error, and is not left there in part") {
    const TemporaryFolder folder;
    const MatArray array{"normal_N", {100, 1000}, std::vector<float>(100000, 1.0f)};
    rlimit before{};
    ::getrlimit(RLIMIT_FSIZE, &before);
    rlimit small = before;
    small.rlim_cur = 100000;  // bytes
    const auto ignored = std::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &small);
    CHECK_THROWS_WITH_AS(write_mat({array}, folder / "m.mat"), doctest::Contains("m.mat: cannot be written"),
                         std::runtime_error);
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, ignored);
    CHECK(std::filesystem::is_empty(folder.path()));
}
