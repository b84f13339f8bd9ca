#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

#include "study/simulated_person.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::study;
using namespace palpa::test;

namespace {

struct Outcome {
    std::vector<ScreenPlace> marks;
    std::vector<ScreenPlace> path;
    double mean_N = 0.0;
    double end_s = 0.0;
};

// A surface of 120 x 120 mm that shows `lag_m` within 6 mm of one place.
Outcome palpate(const PersonTraits& traits, double lag_m, ScreenPlace place, std::uint64_t seed) {
    constexpr double kStep_s = 1.0 / 60.0;
    SimulatedPerson person = make_person(traits, 0.12, 0.12, 60.0, seed);
    Outcome out;
    for (int i = 0;; ++i) {
        const Move made = move(kStep_s, person);
        const bool over = std::hypot(made.at.x_m - place.x_m, made.at.y_m - place.y_m) < 6e-3;
        see({over ? lag_m : 0.0, 0.0, false}, kStep_s, person);
        out.path.push_back(made.at);
        out.mean_N += made.force_N;
        if (made.deed == Deed::mark) out.marks.push_back(made.mark);
        if (made.deed != Deed::finish) continue;
        out.mean_N /= i + 1;
        out.end_s = i * kStep_s;
        return out;
    }
}

}  // namespace

TEST_CASE("simulated person: finds what is plain to see, where it is, and marks it once") {
    PersonTraits traits;
    for (const SearchPath path : {SearchPath::strips, SearchPath::spiral}) {
        traits.path = path;
        for (const ScreenPlace place : {ScreenPlace{0.02, 0.03}, {-0.03, 0.01}, {0.0, -0.02}}) {
            const Outcome out = palpate(traits, 1.5e-3, place, 5);
            CAPTURE(place.x_m);
            CAPTURE(static_cast<int>(path));
            REQUIRE(out.marks.size() == 1);
            CHECK(std::hypot(out.marks[0].x_m - place.x_m, out.marks[0].y_m - place.y_m) < 5e-3);
            CHECK(out.end_s == close_to(60.0).epsilon(0.01));
        }
    }
}

TEST_CASE("simulated person: sees nothing where nothing is shown, more where more is shown") {
    int marks_of_nothing = 0, weak = 0, strong = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        Random random(seed);
        const PersonTraits traits = draw_person(1.6, 6.0, random);
        marks_of_nothing += static_cast<int>(palpate(traits, 0.0, {}, seed).marks.size());
        weak += palpate(traits, 0.35e-3, {0.01, 0.02}, seed).marks.empty() ? 0 : 1;
        strong += palpate(traits, 1.0e-3, {0.01, 0.02}, seed).marks.empty() ? 0 : 1;
    }
    CHECK(marks_of_nothing < 12);
    CHECK(strong > weak + 10);
    CHECK(strong > 40);
}

TEST_CASE("simulated person: strips and spirals cover the surface; the force is the aimed one with tremor") {
    PersonTraits traits;
    for (const SearchPath path : {SearchPath::strips, SearchPath::spiral}) {
        traits.path = path;
        const Outcome out = palpate(traits, 0.0, {}, 9);
        std::vector<bool> cells(16 * 16, false);
        for (const ScreenPlace& p : out.path) {
            CHECK(std::abs(p.x_m) < 0.06);
            CHECK(std::abs(p.y_m) < 0.06);
            const auto cell = [](double m) { return static_cast<std::size_t>((m + 0.06) / 0.0075); };
            cells[cell(p.y_m) * 16 + cell(p.x_m)] = true;
        }
        CHECK(std::count(cells.begin(), cells.end(), true) > 150);
        CHECK(out.mean_N == close_to(traits.force_N).epsilon(0.08));
    }
}

TEST_CASE("simulated person: who feels and does not see finds what gives way less, and by touch alone") {
    constexpr double kStep_s = 1.0 / 60.0;
    PersonTraits traits;
    traits.dent_noise = 0.18;
    int found = 0, of_nothing = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        CAPTURE(seed);
        for (const double stiffer : {1.0, 8.0}) {
            SimulatedPerson person = make_person(traits, 0.12, 0.12, 60.0, seed);
            for (bool over = false;;) {
                const Move made = move(kStep_s, person);
                over = std::hypot(made.at.x_m - 0.02, made.at.y_m - 0.03) < 6e-3;
                Sight felt;
                felt.lag_shown = false;
                felt.lag_m = 1.0;  // not shown, so it must not count
                felt.dent_shown = true;
                felt.depth_m = 2e-3 * std::pow(made.force_N, 0.6) / (over ? stiffer : 1.0);
                see(felt, kStep_s, person);
                if (made.deed == Deed::mark) ++(stiffer > 1.0 ? found : of_nothing);
                if (made.deed == Deed::finish) break;
            }
        }
    }
    CHECK(found >= 15);
    CHECK(of_nothing <= 4);
}

TEST_CASE("simulated person: the same seed is the same person, another one is not") {
    const PersonTraits traits;
    const Outcome a = palpate(traits, 1e-3, {0.01, 0.0}, 3);
    const Outcome b = palpate(traits, 1e-3, {0.01, 0.0}, 3);
    const Outcome c = palpate(traits, 1e-3, {0.01, 0.0}, 4);
    REQUIRE(a.path.size() == b.path.size());
    CHECK(a.path.back().x_m == b.path.back().x_m);
    CHECK(a.path[100].x_m != c.path[100].x_m);
}

TEST_CASE("simulated person: answers about softness follow the difference") {
    Random random(1);
    const auto right = [&](double comparison_kPa) {
        int count = 0;
        for (int i = 0; i < 2000; ++i) count += answers_right(1.75, comparison_kPa, 0.2, random) ? 1 : 0;
        return count / 2000.0;
    };
    CHECK(right(1.76) == close_to(0.5).epsilon(0.1));
    CHECK(right(3.75) > 0.98);
    CHECK(right(2.25) > right(1.875));
}
