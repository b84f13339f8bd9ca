// SHA-256 for browsers, which lack OpenSSL.

#include "files/sha256.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace palpa::files {
namespace {

using Words8 = std::array<std::uint32_t, 8>;
using Words64 = std::array<std::uint32_t, 64>;

// FIPS 180-4, sections 4.2.2 and 5.3.3: the first 32 bits of the fractions of the cube and square roots of the first
// primes. A root in long double is accurate to 64 bits, so 32 bits of its fraction are exact.
struct Constants {
    Words64 round{};
    Words8 start{};
    Constants() {
        std::size_t found = 0;
        for (std::uint32_t n = 2; found < round.size(); ++n) {
            bool prime = true;
            for (std::uint32_t d = 2; d * d <= n; ++d) prime = prime && n % d != 0;
            if (!prime) continue;
            round[found] = fraction_bits(std::cbrt(static_cast<long double>(n)));
            if (found < start.size()) start[found] = fraction_bits(std::sqrt(static_cast<long double>(n)));
            ++found;
        }
    }
    static std::uint32_t fraction_bits(long double x) {
        return static_cast<std::uint32_t>((x - std::floor(x)) * 4294967296.0L);
    }
};

void add_block(const Constants& constants, std::string_view block, Words8& hash) {
    Words64 w{};
    for (std::size_t i = 0; i < 64; ++i) {
        w[i / 4] = w[i / 4] << 8 | static_cast<unsigned char>(block[i]);
    }
    for (std::size_t i = 16; i < 64; ++i) {
        const std::uint32_t s0 = std::rotr(w[i - 15], 7) ^ std::rotr(w[i - 15], 18) ^ (w[i - 15] >> 3);
        const std::uint32_t s1 = std::rotr(w[i - 2], 17) ^ std::rotr(w[i - 2], 19) ^ (w[i - 2] >> 10);
        w[i] = w[i - 16] + s0 + w[i - 7] + s1;
    }
    auto [a, b, c, d, e, f, g, h] = hash;
    for (std::size_t i = 0; i < 64; ++i) {
        const std::uint32_t s1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
        const std::uint32_t t1 = h + s1 + ((e & f) ^ (~e & g)) + constants.round[i] + w[i];
        const std::uint32_t s0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
        const std::uint32_t t2 = s0 + ((a & b) ^ (a & c) ^ (b & c));
        h = g;
        g = f;
        f = e;
        e = d + t1;
        d = c;
        c = b;
        b = a;
        a = t1 + t2;
    }
    const Words8 sum{a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < 8; ++i) hash[i] += sum[i];
}

}  // namespace

std::string sha256_hex(std::string_view bytes) {
    static const Constants constants;
    Words8 hash = constants.start;
    const std::uint64_t bits = 8 * static_cast<std::uint64_t>(bytes.size());
    for (; bytes.size() >= 64; bytes.remove_prefix(64)) add_block(constants, bytes, hash);
    std::string last(bytes);
    last.push_back('\x80');
    while (last.size() % 64 != 56) last.push_back('\0');
    for (int shift = 56; shift >= 0; shift -= 8) last.push_back(static_cast<char>(bits >> shift & 0xff));
    for (std::string_view rest = last; !rest.empty(); rest.remove_prefix(64)) add_block(constants, rest, hash);
    std::string hex;
    for (const std::uint32_t word : hash) {
        for (int shift = 28; shift >= 0; shift -= 4) hex.push_back("0123456789abcdef"[word >> shift & 0xf]);
    }
    return hex;
}

}  // namespace palpa::files
