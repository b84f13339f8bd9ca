#include <algorithm>
#include <doctest/doctest.h>
#include <sstream>
#include <vector>

#include "desk/qr.h"

using namespace palpa;
using namespace palpa::desk;

namespace {

// Modules of the picture, true = light.
std::vector<std::vector<bool>> modules_of(const std::string& picture) {
    std::vector<std::vector<bool>> out;
    std::istringstream lines(picture);
    for (std::string line; std::getline(lines, line);) {
        std::vector<bool> upper, lower;
        for (std::size_t i = 0; i < line.size();) {
            const bool blank = line[i] == ' ';
            const std::string block = blank ? " " : line.substr(i, 3);
            upper.push_back(block == "\u2588" || block == "\u2580");
            lower.push_back(block == "\u2588" || block == "\u2584");
            i += block.size();
        }
        out.push_back(upper);
        out.push_back(lower);
    }
    return out;
}

}  // namespace

TEST_CASE("qr: a square with three finders in a quiet zone") {
    const auto rows = modules_of(qr_text("https://192.168.1.7:8443/#code=123456", false));
    REQUIRE(!rows.empty());
    const std::size_t width = rows.front().size();
    CHECK((width - 8 - 17) % 4 == 0);  // 17 + 4 n modules and four on each side
    CHECK(rows.size() == width + 1);   // two in a line
    for (const auto& row : rows) REQUIRE(row.size() == width);
    for (std::size_t i = 0; i < width; ++i) {
        for (std::size_t k = 0; k < 4; ++k) {
            CHECK(rows[k][i]);
            CHECK(rows[i][k]);
            CHECK(rows[width - 1 - k][i]);
            CHECK(rows[i][width - 1 - k]);
        }
    }
    const auto finder = [&](std::size_t x, std::size_t y) {
        for (std::size_t i = 0; i < 7; ++i) {
            for (std::size_t k = 0; k < 7; ++k) {
                const std::size_t ring = std::min({i, k, 6 - i, 6 - k});
                if (rows[y + i][x + k] != (ring == 1)) return false;
            }
        }
        return true;
    };
    CHECK(finder(4, 4));
    CHECK(finder(width - 11, 4));
    CHECK(finder(4, width - 11));
    CHECK_FALSE(finder(width - 11, width - 11));
    CHECK_THROWS_AS(qr_text(std::string(5000, 'x'), false), std::runtime_error);
}
