#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "files/npy.h"
#include "files/text.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

NpyArray example() {
    NpyArray array;
    array.shape = {2, 3, 4};
    for (int i = 0; i < 24; ++i) array.values.push_back(i == 5 ? NAN : 0.5f * static_cast<float>(i));
    return array;
}

std::string with_header(const std::string& dictionary, const std::string& data) {
    std::string header = dictionary;
    while ((10 + header.size() + 1) % 64 != 0) header.push_back(' ');
    header.push_back('\n');
    std::string out("\x93NUMPY\x01\x00", 8);
    out.push_back(static_cast<char>(header.size() & 0xff));
    out.push_back(static_cast<char>(header.size() >> 8));
    return out + header + data;
}

}  // namespace

TEST_CASE("npy: what is written reads back, missing values included") {
    const NpyArray back = parse_npy(npy_bytes(example()), "a.npy");
    CHECK(back.shape == example().shape);
    CHECK(std::isnan(back.values[5]));
    CHECK(back.values[23] == 11.5f);
    CHECK(npy_bytes(example()).size() % 64 == 32);  // header padded to 64, 96 bytes of data
}

TEST_CASE("npy: double precision and format version 2 are read") {
    const double values[2] = {1.25, -3.5};
    const std::string data(reinterpret_cast<const char*>(values), sizeof values);
    const auto array = parse_npy(with_header("{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }", data), "a");
    CHECK(array.values == std::vector<float>{1.25f, -3.5f});
    std::string two = with_header("{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }", data);
    two[6] = '\x02';
    two.insert(10, 2, '\0');
    CHECK(parse_npy(two, "a").values == array.values);
}

TEST_CASE("npy: a file is read in parts as its bytes are at once, and written from where the values stand") {
    const TemporaryFolder folder;
    NpyArray large{{3, 70'001}, std::vector<float>(3 * 70'001)};  // no whole number of parts
    for (std::size_t i = 0; i < large.values.size(); ++i) large.values[i] = 0.25f * static_cast<float>(i);
    write_npy(folder / "a.npy", large.shape, large.values);
    CHECK(read_text(folder / "a.npy") == npy_bytes(large));
    CHECK(read_npy(folder / "a.npy").values == large.values);
    const std::vector<double> doubles(large.values.begin(), large.values.end());
    std::string wide = with_header("{'descr': '<f8', 'fortran_order': False, 'shape': (3, 70001), }",
                                   {reinterpret_cast<const char*>(doubles.data()), 8 * doubles.size()});
    wide[6] = '\x02';
    wide.insert(10, 2, '\0');
    write_text_whole(folder / "b.npy", wide);
    CHECK(read_npy(folder / "b.npy").shape == large.shape);
    CHECK(read_npy(folder / "b.npy").values == large.values);
    const std::string good = npy_bytes(example());
    for (std::size_t n = 0; n < good.size(); ++n) {  // cut anywhere: the same words
        write_text_whole(folder / "c.npy", good.substr(0, n));
        const std::string file = (folder / "c.npy").string();
        const std::string said = message_of([&] { read_npy(file); });
        CHECK(said != "");
        CHECK(said == message_of([&] { parse_npy(good.substr(0, n), file); }));
    }
}

TEST_CASE("hard case 31: npy with impossible sizes, other types and cut ends") {
    const auto said = [](const std::string& bytes) { return message_of([&] { parse_npy(bytes, "n.npy"); }); };
    const std::string good = npy_bytes(example());
    CHECK(contains(said(""), "expected an .npy file"));
    CHECK(contains(said("not numpy at all, but long enough"), "no NumPy magic number"));
    CHECK(contains(said(good.substr(0, good.size() - 1)), "found 95 bytes of data, expected 96"));
    CHECK(contains(said(good + "x"), "found 97 bytes"));
    CHECK(contains(said(good.substr(0, 20)), "a header"));
    const auto dictionary = [&](const std::string& shape) {
        return with_header("{'descr': '<f4', 'fortran_order': False, 'shape': " + shape + ", }", "");
    };
    const bool wide = sizeof(std::size_t) > 4;  // else such numbers are refused as they stand
    CHECK(contains(said(dictionary("(1000000000000, 1000000000000)")),
                   wide ? "a size that fits into memory" : "whole numbers"));
    CHECK(contains(said(dictionary("(1000000000000,)")),
                   wide ? "expected 4000000000000 for the shape" : "whole numbers"));
    CHECK(contains(said(dictionary("(-1, 4)")), "whole numbers >= 0"));
    CHECK(contains(said(dictionary("(99999999999999999999999,)")), "whole numbers >= 0"));
    CHECK(contains(said(dictionary("nonsense")), "shape"));
    CHECK(contains(said(with_header("{'descr': '>f4', 'fortran_order': False, 'shape': (1,), }", "abcd")),
                   "descr: found '>f4', expected '<f4' or '<f8' (little-endian float32 or float64)"));
    CHECK(contains(said(with_header("{'descr': '<c16', 'fortran_order': False, 'shape': (1,), }", "abcd")),
                   "descr: found '<c16', expected"));
    CHECK(contains(said(with_header("{'descr': '<f4', 'fortran_order': True, 'shape': (1,), }", "abcd")),
                   "C order, as numpy.ascontiguousarray makes it"));
    CHECK(contains(said(with_header("{'fortran_order': False, 'shape': (1,), }", "abcd")), "descr"));
}

TEST_CASE("hard case 31: random damage to an npy file ends in a reading or a refusal") {
    constexpr std::uint32_t kSeed = 31;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    const std::string good = npy_bytes(example());
    int refused = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string bytes = good.substr(0, random() % (good.size() + 1));
        for (int k = 0; k < 4 && !bytes.empty(); ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
        refused += !message_of([&] { parse_npy(bytes, "n.npy"); }).empty();
    }
    CHECK(refused > 10000);
}

TEST_CASE("npy: whole numbers keep all 32 bits, and floats are refused where they are wanted") {
    const TemporaryFolder folder;
    const std::vector<std::int32_t> values{0, -1, 16'777'217, 2'147'483'647, -2'147'483'647, 5};
    write_npy_integers(folder / "i.npy", {2, 3}, values);
    const NpyIntegers back = read_npy_integers(folder / "i.npy");
    CHECK(back.shape == std::vector<std::size_t>{2, 3});
    CHECK(back.values == values);
    CHECK(parse_npy_integers(read_text(folder / "i.npy"), "i.npy").values == values);
    CHECK(contains(message_of([&] { parse_npy_integers(npy_bytes(example()), "a.npy"); }), "'<i4'"));
    CHECK(contains(message_of([&] { read_npy(folder / "i.npy"); }), "'<f4' or '<f8'"));
    const std::string whole = read_text(folder / "i.npy");
    CHECK(contains(message_of([&] { parse_npy_integers(whole.substr(0, whole.size() - 1), "i.npy"); }),
                   "24 for the shape (2, 3)"));
}
