#include <doctest/doctest.h>

#include "figures/colour_maps.h"

using namespace palpa::figures;

TEST_CASE("colour maps: the stops themselves, the middle between two, and the ends beyond 0 and 1") {
    const auto same = [](Colour a, Colour b) { return a.r == b.r && a.g == b.g && a.b == b.b; };
    CHECK(same(colour_at(kViridis, 0.0f), {68, 1, 84}));
    CHECK(same(colour_at(kViridis, 1.0f), {253, 231, 37}));
    CHECK(same(colour_at(kViridis, 7.0f), {253, 231, 37}));
    CHECK(same(colour_at(kApart, -1.0f), {33, 102, 172}));
    CHECK(same(colour_at(kApart, 0.5f), {247, 247, 247}));
    CHECK(same(colour_at(kApart, 0.125f), {90, 150, 197}));  // halves are rounded up
}

TEST_CASE("colour maps: gnuplot gets the same stops") {
    CHECK(gnuplot_palette(kApart) == "defined (0 '#2166ac', 1 '#92c5de', 2 '#f7f7f7', 3 '#f4a582', 4 '#b2182b')");
    CHECK(gnuplot_palette(kViridis).find("9 '#fde725')") != std::string::npos);
}
