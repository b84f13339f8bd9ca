#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>
#include <signal.h>
#include <unistd.h>

#include "files/text.h"
#include "stiffnessmaps/import/apart.h"
#include "stiffnessmaps/import/arrays.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/stiffnessmaps/array_writers.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::stiffnessmaps;
using namespace palpa::test;

namespace {

// 2 x 3 x 4, every number another.
const std::vector<std::size_t> kShape{2, 3, 4};

template <class Value>
std::vector<Value> counted(std::size_t n, double step = 1.0) {
    std::vector<Value> out;
    for (std::size_t i = 0; i < n; ++i) out.push_back(static_cast<Value>(step * static_cast<double>(i)));
    return out;
}

void check_counted(const NpyArray& array, const std::vector<std::size_t>& shape, double step = 1.0) {
    CHECK(array.shape == shape);
    for (std::size_t i = 0; i < array.values.size(); ++i)
        REQUIRE(array.values[i] == close_to(step * static_cast<double>(i)));
}

std::string refusal_of_array(const std::filesystem::path& path, const std::string& dataset = "") {
    return message_of([&] { read_array(path, dataset); });
}

// The file with some bytes replaced.
void patch(const std::filesystem::path& path, const std::string& from, const std::string& to) {
    std::string bytes = read_text(path);
    const auto at = bytes.find(from);
    REQUIRE(at != std::string::npos);
    bytes.replace(at, from.size(), to);
    write_text_whole(path, bytes);
}

}  // namespace

TEST_CASE("arrays: the same numbers come out of every kind of file") {
    const TemporaryFolder folder;
    write_text_whole(folder / "a.npy", npy_bytes({kShape, counted<float>(24, 0.5)}));
    check_counted(read_array(folder / "a.npy", ""), kShape, 0.5);

    write_mat(folder / "a.mat", "F", kShape, counted<double>(24, 0.5));
    check_counted(read_array(folder / "a.mat", ""), kShape, 0.5);
    write_mat(folder / "packed.mat", "F", kShape, counted<double>(24, 0.5), true);
    check_counted(read_array(folder / "packed.mat", ""), kShape, 0.5);
    write_mat(folder / "new.mat", "F", kShape, counted<double>(24, 0.5), false, "7.3");
    CHECK(array_kind(folder / "new.mat") == ArrayKind::hdf5);
    check_counted(read_array(folder / "new.mat", ""), kShape, 0.5);

    write_hdf5(folder / "a.h5", "force", kShape, counted<float>(24, 0.5));
    check_counted(read_array(folder / "a.h5", ""), kShape, 0.5);
    write_hdf5(folder / "packed.h5", "force", kShape, counted<float>(24, 0.5), 2);
    check_counted(read_array(folder / "packed.h5", ""), kShape, 0.5);

    write_tiff(folder / "a.tif", 4, 3, counted<std::uint16_t>(24, 2000.0));
    check_counted(read_array(folder / "a.tif", ""), kShape, 2000.0);
    write_tiff(folder / "tiled.tif", 4, 3, counted<std::uint16_t>(12, 2000.0), 16);
    check_counted(read_array(folder / "tiled.tif", ""), {3, 4}, 2000.0);
    write_png(folder / "a.png", 4, 3, counted<std::uint16_t>(12, 5000.0));
    check_counted(read_array(folder / "a.png", ""), {3, 4}, 5000.0);
    write_png(folder / "eight.png", 4, 3, counted<std::uint16_t>(12, 20.0), 8);
    check_counted(read_array(folder / "eight.png", ""), {3, 4}, 20.0);

    for (const char* text : {"0,1,2,3\n4,5,6,7\n8,9,10,11\n", "\xef\xbb\xbf 0 1  2 3\r\n4 5 6 7 \r\n\r\n8 9 10 11",
                             "0\t1\t2\t3\n4\t5\t6\t7\n8\t9\t10\t11\n", "0; 1; 2; 3\n4;5;6;7\n8;9;10;11\n"}) {
        write_text_whole(folder / "a.txt", text);
        check_counted(read_array(folder / "a.txt", ""), {3, 4});
    }
    write_text_whole(folder / "gaps.csv", "1,,nan\n4,n/a,6\n");
    const NpyArray gaps = read_array(folder / "gaps.csv", "");
    CHECK(std::isnan(gaps.values[1]));
    CHECK(std::isnan(gaps.values[4]));
}

TEST_CASE("arrays: of several in one file one must be named") {
    const TemporaryFolder folder;
    write_mat(folder / "a.mat", "normal", {2, 3}, counted<double>(6));
    write_mat(folder / "a.mat", "shear", {2, 3}, counted<double>(6, 2.0));
    write_hdf5(folder / "a.h5", "normal", {2, 3}, counted<float>(6));
    write_hdf5(folder / "a.h5", "shear", {2, 3}, counted<float>(6, 2.0));
    for (const char* name : {"a.mat", "a.h5"}) {
        CAPTURE(name);
        CHECK(contains(refusal_of_array(folder / name),
                       "the arrays 'normal' (2, 3) 'shear' (2, 3), expected one of them named by --dataset"));
        check_counted(read_array(folder / name, "shear"), {2, 3}, 2.0);
        CHECK(contains(refusal_of_array(folder / name, "other"), "expected an array 'other'"));
    }
}

TEST_CASE("arrays: 10^12 cells in a header are refused before anything is allocated") {
    const TemporaryFolder folder;
    write_text_whole(folder / "a.npy", npy_bytes({{2, 3}, counted<float>(6)}));
    patch(folder / "a.npy", "(2, 3), }        ", "(1000000,1000000)");
    CHECK(contains(refusal_of_array(folder / "a.npy"), "for the shape (1000000, 1000000)"));

    // uncompressed: the dimensions stand in the file as two int32
    write_mat(folder / "a.mat", "F", {7, 11}, counted<double>(77));
    patch(folder / "a.mat", std::string("\7\0\0\0\13\0\0\0", 8), std::string("\x40\x42\x0f\0\x40\x42\x0f\0", 8));
    CHECK(
        contains(refusal_of_array(folder / "a.mat"), "found (1000000, 1000000), expected at most 20 million numbers"));
    write_mat(folder / "b.mat", "F", {7, 11}, counted<double>(77));
    patch(folder / "b.mat", std::string("\7\0\0\0\13\0\0\0", 8), std::string("\x00\x08\0\0\x00\x08\0\0", 8));
    CHECK(contains(refusal_of_array(folder / "b.mat"), "found (2048, 2048), expected numbers that fit into its"));

    write_hdf5(folder / "a.h5", "F", {1000000, 1000000}, {}, 100);
    CHECK(contains(refusal_of_array(folder / "a.h5"), "found (1000000, 1000000), expected at most 20 million numbers"));
    write_hdf5(folder / "b.h5", "F", {3000, 3000}, {}, 100);
    CHECK(contains(refusal_of_array(folder / "b.h5"), "found (3000, 3000), expected numbers that fit into its"));

    write_png(folder / "a.png", 4, 3, counted<std::uint16_t>(12));
    patch(folder / "a.png", std::string("\0\0\0\4\0\0\0\3", 8), std::string("\0\x0f\x42\x40\0\x0f\x42\x40", 8));
    CHECK(
        contains(refusal_of_array(folder / "a.png"), "found (1000000, 1000000), expected at most 20 million numbers"));
    write_tiff(folder / "a.tif", 1234, 3, counted<std::uint16_t>(3702), 0, COMPRESSION_NONE);
    patch(folder / "a.tif", std::string("\0\1\3\0\1\0\0\0\xd2\4\0\0", 12),
          std::string("\0\1\4\0\1\0\0\0\x40\x42\x0f\0", 12));
    CHECK(contains(refusal_of_array(folder / "a.tif"), "found (3, 1000000), expected numbers that fit into its"));
    patch(folder / "a.tif", std::string("\1\1\3\0\1\0\0\0\3\0\0\0", 12),
          std::string("\1\1\4\0\1\0\0\0\x40\x42\x0f\0", 12));
    CHECK(
        contains(refusal_of_array(folder / "a.tif"), "found (1000000, 1000000), expected at most 20 million numbers"));
}

TEST_CASE("arrays: cut files are refused by name") {
    const TemporaryFolder folder;
    std::mt19937 random(3);
    std::vector<float> noise(4000);
    for (float& v : noise) v = static_cast<float>(random() % 60000);
    const std::vector<double> doubles(noise.begin(), noise.end());
    const std::vector<std::uint16_t> counts(noise.begin(), noise.end());
    write_text_whole(folder / "a.npy", npy_bytes({{40, 100}, noise}));
    write_mat(folder / "a.mat", "F", {40, 100}, doubles);
    write_mat(folder / "packed.mat", "F", {40, 100}, doubles, true);
    write_hdf5(folder / "a.h5", "F", {40, 100}, noise);
    write_hdf5(folder / "packed.h5", "F", {40, 100}, noise, 20);
    write_png(folder / "a.png", 100, 40, counts);
    write_tiff(folder / "a.tif", 100, 40, counts);
    for (const std::string name : {"a.npy", "a.mat", "packed.mat", "a.h5", "packed.h5", "a.png", "a.tif"}) {
        CAPTURE(name);
        CHECK(refusal_of_array(folder / name) == "");
        const std::string bytes = read_text(folder / name);
        for (const double share : {0.02, 0.3, 0.6, 0.95}) {
            CAPTURE(share);
            write_text_whole(folder / name,
                             bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size()))));
            const std::string message = refusal_of_array(folder / name);
            CAPTURE(message);
            CHECK(contains(message, name));
            CHECK(contains(message, "expected"));
        }
    }
}

TEST_CASE("arrays: what is no array is refused") {
    const TemporaryFolder folder;
    const auto said_of = [&](const std::string& bytes) {
        write_text_whole(folder / "a", bytes);
        return refusal_of_array(folder / "a");
    };
    CHECK(contains(said_of(""), "another kind of file"));
    CHECK(contains(said_of("x,y\n1,2\n"), "another kind of file"));
    CHECK(contains(said_of("1,2\n3\n"), "line 2: found 1 numbers, expected 2"));
    CHECK(contains(said_of("1,2\n3,four\n"), "line 2, number 2: found 'four'"));
    CHECK(contains(said_of("MATLAB 5.0 MAT-file, and then nothing"), "expected"));
    CHECK(contains(said_of("\x89HDF\r\n\x1a\n"), "expected"));
    CHECK(contains(refusal_of_array(folder.path()), "a folder"));
    CHECK(contains(refusal_of_array(folder / "none"), "cannot be read"));
    write_png(folder / "rgb.png", 4, 3, counted<std::uint16_t>(12), 8, PNG_COLOR_TYPE_RGB);
    CHECK(contains(refusal_of_array(folder / "rgb.png"), "grey values of 8 or 16 bits"));
    write_mat(folder / "scalar.mat", "a", {1, 1}, {3.0});
    CHECK(contains(refusal_of_array(folder / "scalar.mat"), "no array of real numbers"));
}

TEST_CASE("arrays: files with bytes changed at random never end in anything but numbers or a message") {
    const TemporaryFolder folder;
    const unsigned seed = 20261121;
    MESSAGE("seed ", seed);
    std::mt19937 random(seed);
    write_mat(folder / "a.mat", "F", {20, 30}, counted<double>(600), true);
    write_mat(folder / "b.mat", "F", {20, 30}, counted<double>(600));
    write_hdf5(folder / "a.h5", "F", {20, 30}, counted<float>(600), 10);
    write_tiff(folder / "a.tif", 30, 20, counted<std::uint16_t>(600));
    write_png(folder / "a.png", 30, 20, counted<std::uint16_t>(600));
    for (const char* name : {"a.mat", "b.mat", "a.h5", "a.tif", "a.png"}) {
        const std::string bytes = read_text(folder / name);
        for (int round = 0; round < 40; ++round) {
            std::string changed = bytes;
            for (unsigned k = 0; k < 1 + random() % 8; ++k)
                changed[16 + random() % (changed.size() - 16)] = static_cast<char>(random());
            write_text_whole(folder / name, changed);
            CAPTURE(name);
            CAPTURE(round);
            try {
                const NpyArray array = read_array(folder / name, "");
                CHECK(array.values.size() <= 20'000'000);
            } catch (const InputError& error) {
                CHECK(contains(error.what(), name));
            }
        }
    }
}

TEST_CASE("apart: a library that crashes, or never ends its work, is a message about the file") {
    const auto said_by = [](const std::function<NpyArray()>& read) {
        return message_of([&] { read_apart("x.h5", "the library", read); });
    };
    CHECK(said_by([]() -> NpyArray { return {{1, 2}, {3.0f, 4.0f}}; }) == "");
    CHECK(said_by([]() -> NpyArray { throw InputError("x.h5: found a, expected b"); }) == "x.h5: found a, expected b");
    CHECK(contains(said_by([]() -> NpyArray {
                       ::raise(SIGSEGV);
                       return {};
                   }),
                   "x.h5: found what the library cannot read without failing"));
    CHECK(contains(said_by([]() -> NpyArray { ::_exit(3); }), "cannot read without failing"));
    CHECK(contains(said_by([]() -> NpyArray {
                       ::raise(SIGXCPU);
                       return {};
                   }),
                   "over a minute of work for the library"));
}
