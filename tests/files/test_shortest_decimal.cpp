#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <doctest/doctest.h>
#include <limits>
#include <random>
#include <string>

#include "files/shortest_decimal.h"

using namespace palpa::files;

namespace {

std::string standard(double value) {
    std::array<char, 64> text;
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

// Equal to the standard's text, or left to it.
bool agrees(double value) {
    std::array<char, kShortestDecimal> text;
    char* const end = write_shortest(value, text.data());
    if (end == nullptr) {
        const double size = std::abs(value);
        return !(size < 1e15) || standard(value).find('e') != std::string::npos;
    }
    return std::string(text.data(), end) == standard(value);
}

double from_bits(std::uint64_t bits) {
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

std::uint64_t bits_of(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

}  // namespace

TEST_CASE("shortest decimal: any double between 1e-6 and 1e16, as std::to_chars writes it") {
    std::mt19937_64 random(1);
    int wrong = 0;
    for (int i = 0; i < 300000; ++i) {
        const std::uint64_t exponent = 1023 - 20 + random() % 74;
        const double value = from_bits((random() & 0x800f'ffff'ffff'ffff) | exponent << 52);
        wrong += !agrees(value);
    }
    CHECK(wrong == 0);
}

TEST_CASE("shortest decimal: short decimals and their neighbours") {
    std::mt19937_64 random(2);
    int wrong = 0;
    for (int i = 0; i < 100000; ++i) {
        const auto digits = static_cast<double>(random() % static_cast<std::uint64_t>(std::pow(10.0, 1 + i % 17)));
        const double value = digits / std::pow(10.0, static_cast<double>(random() % 18));
        for (const double near : {value, std::nextafter(value, 0.0), std::nextafter(value, 1e300)})
            wrong += !agrees(near);
    }
    for (int i = 0; i < 100000; ++i) {
        for (const double unit : {1.0, 1e5, 1e-3, 1e-6, -0.25}) wrong += !agrees(i * unit);
    }
    CHECK(wrong == 0);
}

TEST_CASE("shortest decimal: around powers of two, where the neighbours below are nearer") {
    int wrong = 0;
    for (int exponent = -20; exponent < 54; ++exponent) {
        const std::uint64_t power = bits_of(std::ldexp(1.0, exponent));
        for (std::uint64_t step = 0; step < 1000; ++step)
            wrong += !agrees(from_bits(power + step)) + !agrees(from_bits(power - step));
    }
    CHECK(wrong == 0);
}

TEST_CASE("shortest decimal: zeros, and what it leaves to others") {
    std::array<char, kShortestDecimal> text;
    CHECK(std::string(text.data(), write_shortest(0.0, text.data())) == "0");
    CHECK(std::string(text.data(), write_shortest(-0.0, text.data())) == "-0");
    CHECK(std::string(text.data(), write_shortest(-1.5, text.data())) == "-1.5");
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const double value : {1e-4, 1e5, 1e15, 1e300, 1e-300, 5e-324, kInfinity, -kInfinity, std::nan("")})
        CHECK(write_shortest(value, text.data()) == nullptr);
}
