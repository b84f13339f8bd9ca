#include "files/shortest_decimal.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace palpa::files {
namespace {

__extension__ using Wide = unsigned __int128;

// digits * 10^exponent
struct Decimal {
    std::uint64_t digits;
    int exponent;
};

// 10^n = power * 2^m with the highest of the 128 bits set; exact up to 10^55.
constexpr int kPowers = 32;
constexpr std::array<Wide, kPowers> make_powers() {
    std::array<Wide, kPowers> powers{};
    Wide five = 1;
    for (Wide& power : powers) {
        power = five;
        while (power >> 127 == 0) power <<= 1;
        five *= 5;
    }
    return powers;
}
constexpr std::array<Wide, kPowers> kPowersOfTen = make_powers();

// floor(power * x / 2^128); its last bit is set if anything but 0 was cut off, so that comparisons stay exact.
std::uint64_t scaled(Wide power, std::uint64_t x) {
    const auto low = static_cast<std::uint64_t>(power);
    const auto high = static_cast<std::uint64_t>(power >> 64);
    const Wide sum = Wide(high) * x + ((Wide(low) * x) >> 64);
    return static_cast<std::uint64_t>(sum >> 64) | (static_cast<std::uint64_t>(sum) > 1);
}

// The decimal for c * 2^q, 2^52 <= c < 2^53, not a whole number, 1e-4 <= c * 2^q < 1e15. It may end in zeros.
//
// All is compared in units of a quarter of 10^k, the greatest power of ten that is not wider than the interval of what
// reads back as this double. The interval holds a multiple of 10^k, and at most one of 10^(k+1), which is shorter.
// Source: R. Giulietti, "The Schubfach way to render doubles" (2022), figure 4 and section 9. It is simpler for these
// numbers. All powers of ten are exact. Whether the interval's bounds belong to it does not matter, because they are
// half-way to the neighbours, odd multiples of 2^(q-1), and no multiple of 10^k is one. Nor does it matter that below a
// power of two the neighbour is nearer: the powers from 2^-13 to 2^-1 have at most 10 digits, and are written exactly.
Decimal decimal_of(std::uint64_t c, int q) {
    const int k = (q * 1262611) >> 22;             // floor(log10(2^q))
    const int h = q + ((-k * 1741647) >> 19) + 1;  // 1 to 4; with floor(log2(10^-k))
    const Wide power = kPowersOfTen[static_cast<std::size_t>(-k)];
    const std::uint64_t low = scaled(power, (4 * c - 2) << h);
    const std::uint64_t middle = scaled(power, (4 * c) << h);
    const std::uint64_t high = scaled(power, (4 * c + 2) << h);

    const std::uint64_t below = middle / 4;
    const std::uint64_t tens = below / 10;
    const bool tens_in = low <= 40 * tens;
    const bool next_tens_in = 40 * tens + 40 <= high;
    if (tens_in != next_tens_in) return {tens + next_tens_in, k + 1};
    const bool below_in = low <= 4 * below;
    const bool above_in = 4 * below + 4 <= high;
    if (below_in != above_in) return {below + above_in, k};
    const std::uint64_t half = 4 * below + 2;
    return {below + (middle > half || (middle == half && (below & 1) == 1)), k};
}

// `value` is positive and in the range of write_shortest().
Decimal shortest(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    const std::uint64_t c = (bits & ((std::uint64_t{1} << 52) - 1)) | (std::uint64_t{1} << 52);
    const int q = static_cast<int>(bits >> 52) - 1075;
    const std::uint64_t whole = -q < 53 ? c >> -q : 0;
    if (-q < 53 && whole << -q == c) return {whole, 0};
    return decimal_of(c, q);
}

// The eight digits of `value` < 10^8: pairs of four digits, of two and of one are divided at once, each in its own bits.
void write_eight(std::uint64_t value, char* out) {
    static_assert(std::endian::native == std::endian::little);  // the first digit is in the lowest byte
    const std::uint64_t fours = value / 10000 | (value % 10000) << 32;
    const std::uint64_t hundreds = ((fours * 10486) >> 20) & 0x0000'007f'0000'007f;
    const std::uint64_t twos = hundreds | (fours - 100 * hundreds) << 16;
    const std::uint64_t tens = ((twos * 103) >> 10) & 0x000f'000f'000f'000f;
    const std::uint64_t ones = tens | (twos - 10 * tens) << 8;
    const std::uint64_t text = ones | 0x3030'3030'3030'3030;
    std::memcpy(out, &text, sizeof text);
}

// All digits of a decimal, from [begin] to [end - 1]; the decimal point stands before [point], which may be any place.
constexpr int kDigits = 17;
constexpr std::size_t kCopied = 24;  // at once, since a copy of known length is much cheaper
struct Digits {
    std::array<char, kDigits + kCopied> text;
    int begin = 0;
    int end = kDigits;
    int point = 0;
};

void write_digits(const Decimal& decimal, Digits& out) {
    constexpr std::uint64_t kEight = 100'000'000;
    const std::uint64_t high = decimal.digits / kEight;
    const std::uint64_t low = decimal.digits % kEight;
    out.text[0] = static_cast<char>('0' + high / kEight);
    write_eight(high % kEight, &out.text[1]);
    write_eight(low, &out.text[9]);
    const auto at = [&](int i) { return out.text[static_cast<std::size_t>(i)]; };
    if (low == 0) out.end -= 8;
    while (out.begin < out.end - 1 && at(out.begin) == '0') ++out.begin;
    while (out.end > out.begin + 1 && at(out.end - 1) == '0') --out.end;
    out.point = kDigits + decimal.exponent;
}

}  // namespace

char* write_shortest(double value, char* out) {
    constexpr double kLowest = 1e-4;
    constexpr double kBeyond = 1e15;
    const double size = std::abs(value);
    if (std::signbit(value)) *out++ = '-';
    if (size == 0.0) {
        *out++ = '0';
        return out;
    }
    if (!(size >= kLowest && size < kBeyond)) return nullptr;
    Digits digits;
    write_digits(shortest(size), digits);
    // std::to_chars takes an exponent where that is shorter; with one digit it saves the point too
    const int n = digits.end - digits.begin;
    const int one = n == 1 ? 1 : 0;
    const int exponent = digits.point - digits.end;
    if (exponent < -(n + 3) + one || exponent > 5 - one) return nullptr;

    const char* const from = &digits.text[static_cast<std::size_t>(digits.begin)];
    const int before_point = digits.point - digits.begin;
    if (before_point <= 0) {
        std::memcpy(out, "0.000000", 8);
        std::memcpy(out + 2 - before_point, from, kCopied);
        return out + 2 - before_point + n;
    }
    std::memcpy(out, from, kCopied);
    if (exponent >= 0) {
        std::memcpy(out + n, "00000", 5);
        return out + before_point;
    }
    out[before_point] = '.';
    std::memcpy(out + before_point + 1, from + before_point, kCopied);
    return out + n + 1;
}

}  // namespace palpa::files
