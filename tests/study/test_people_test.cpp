#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <vector>

#include "files/distributions.h"
#include "files/table.h"
#include "study/binomial_draw.h"
#include "study/people_test.h"
#include "study/random.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/study/python.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

People people_with(const std::vector<std::pair<int, int>>& counts) {
    People out;
    for (const auto& [k, n] : counts) {
        if (n < 0) {
            out.emplace_back();
        } else {
            out.emplace_back(Contribution{k, n});
        }
    }
    return out;
}

constexpr std::pair<int, int> kAbsent{0, -1};

}  // namespace

TEST_CASE("people test: the paired t test and the permutation of signs by hand") {
    const People a = people_with({{3, 3}, {2, 3}, {2, 3}, {1, 3}}), b = people_with({{1, 3}, {2, 3}, {1, 3}, {0, 3}});
    const PeopleTest test = compare_people(a, b, Average::people, {});
    CHECK(test.design == Design::within);
    CHECK(test.people_a == 4);
    CHECK(test.df == 3.0);
    CHECK(test.difference == close_to(1.0 / 3.0));
    // differences 2/3, 0, 1/3, 1/3: mean 1/3, sum of squares about it 2/9
    const double error = std::sqrt(2.0 / 9.0 / 3.0 / 4.0);
    CHECK(test.t == close_to(1.0 / 3.0 / error));
    CHECK(test.ci.low == close_to(1.0 / 3.0 - 3.182446305284263 * error));
    CHECK(test.p == close_to(files::student_p(test.t, 3.0)));
    CHECK(test.p_permutation == close_to(2.0 / 8.0));
    CHECK(test.status.empty());
    // with as much to count for everybody the ratio's test is the same; its error is the jackknife's, so is its t
    const PeopleTest pooled = compare_people(a, b, Average::pooled, {});
    CHECK(pooled.t == close_to(test.t));
    CHECK(pooled.p_permutation == close_to(test.p_permutation));
    CHECK(compare_people(b, a, Average::people, {}).t == close_to(-test.t));
}

TEST_CASE("people test: other people under each condition are compared by Welch's t") {
    const People a = people_with({{3, 3}, {2, 3}, {3, 3}, kAbsent, kAbsent});
    const People b = people_with({kAbsent, kAbsent, kAbsent, {0, 3}, {1, 3}});
    const PeopleTest test = compare_people(a, b, Average::people, {});
    CHECK(test.design == Design::between);
    CHECK(test.people_a == 3);
    CHECK(test.people_b == 2);
    const double v_a = 2.0 / 27.0 / 2.0 / 3.0, v_b = 1.0 / 18.0 / 2.0;  // shares 1, 2/3, 1 and 0, 1/3
    CHECK(test.t == close_to((8.0 / 9.0 - 1.0 / 6.0) / std::sqrt(v_a + v_b)));
    CHECK(test.df == close_to((v_a + v_b) * (v_a + v_b) / (v_a * v_a / 2.0 + v_b * v_b)));
    CHECK(test.p_permutation == close_to(1.0 / 10.0));
}

TEST_CASE("people test: who took part once only is left out and counted; marks of nobody count as none") {
    const People a = people_with({{1, 2}, {2, 2}, {1, 1}, {0, 0}}), b = people_with({{0, 2}, {1, 3}, kAbsent, {1, 1}});
    const PeopleTest shares = compare_people(a, b, Average::people, {});
    CHECK(shares.people_a == 2);
    CHECK(shares.left_out == 2);
    const PeopleTest pooled = compare_people(a, b, Average::pooled, {});
    CHECK(pooled.people_a == 3);
    CHECK(pooled.left_out == 1);
    CHECK(pooled.difference == close_to(3.0 / 4.0 - 2.0 / 6.0));
}

TEST_CASE("people test: without variance, or with one person, it says that it cannot be computed, and why") {
    const People right = people_with({{1, 1}, {1, 1}}), wrong = people_with({{0, 1}, {0, 1}});
    const PeopleTest chance = compare_with_chance(right, 0.5, {});
    CHECK(std::isnan(chance.p));
    CHECK(std::isnan(chance.ci.low));
    CHECK(chance.p_permutation == close_to(0.5));
    CHECK(chance.status == "cannot be computed, because the shares of all 2 people are the same: no variance");
    const PeopleTest pair = compare_people(right, wrong, Average::people, {});
    CHECK(std::isnan(pair.p));
    CHECK(pair.difference == close_to(1.0));
    CHECK(contains(pair.status, "the differences of all 2 people are the same"));
    const PeopleTest one = compare_people(people_with({{1, 3}}), people_with({{2, 3}}), Average::people, {});
    CHECK(std::isnan(one.difference));
    CHECK(contains(one.status, "only one person"));
    const People thirds = people_with({{1, 3}, {1, 3}, {2, 6}});  // equal but for rounding
    CHECK_FALSE(compare_with_chance(thirds, 0.5, {}).status.empty());
}

TEST_CASE("people test: the interaction of a mixed design is Welch's t of the differences") {
    const People a1 = people_with({{3, 3}, {2, 3}, {3, 3}}), b1 = people_with({{0, 3}, {1, 3}, {1, 3}});
    const People a2 = people_with({{1, 3}, {2, 3}}), b2 = people_with({{1, 3}, {1, 3}});
    const PeopleTest test = compare_differences(a1, b1, a2, b2, {});
    CHECK(test.difference == close_to(2.0 / 3.0 - 1.0 / 6.0));
    CHECK(test.people_a == 3);
    CHECK(test.people_b == 2);
    CHECK(test.design == Design::between);
}

TEST_CASE("people test: paired, Welch's and permutation tests as scipy has them") {
    const std::string python = python_with("scipy");
    if (python.empty()) {
        MESSAGE("not checked: python3-scipy is not installed");
        return;
    }
    constexpr std::uint64_t kSeed = 33;
    CAPTURE(kSeed);
    Random random(kSeed);
    const TemporaryFolder folder;
    std::string rows = "study\ta\tb\n";
    std::vector<std::pair<People, People>> studies;
    for (int study = 0; study < 40; ++study) {
        auto& [a, b] = studies.emplace_back();
        for (int i = 0; i < 8; ++i) {
            for (People* side : {&a, &b}) side->emplace_back(Contribution{random.below(7), 6});
            rows +=
                std::to_string(study) + "\t" + std::to_string(a.back()->k) + "\t" + std::to_string(b.back()->k) + "\n";
        }
    }
    write_text_atomically(folder / "studies.tsv", rows);
    REQUIRE(run_python(python, folder, R"py(
from math import inf
from scipy.stats import permutation_test, ttest_ind, ttest_rel
lines = [[int(x) for x in line.split()] for line in open("studies.tsv").readlines()[1:]]
mean_difference = lambda x, y: sum(x) / len(x) - sum(y) / len(y)
with open("expected.tsv", "w") as out:
    print("t p welch_t welch_p signs groups".replace(" ", "\t"), file=out)
    for study in range(40):
        a = [k / 6 for s, k, _ in lines if s == study]
        b = [k / 6 for s, _, k in lines if s == study]
        paired, welch = ttest_rel(a, b), ttest_ind(a[:4], b[4:], equal_var=False)
        signs = permutation_test((a, b), mean_difference, permutation_type="samples", n_resamples=inf).pvalue
        groups = permutation_test((a[:4], b[4:]), mean_difference, n_resamples=inf).pvalue
        print(*(repr(float(x)) for x in (*paired, *welch, signs, groups)), sep="\t", file=out)
)py"));
    Table expected = read_tsv(folder / "expected.tsv");
    for (const auto& [a, b] : studies) {
        REQUIRE(expected.next());
        const PeopleTest paired = compare_people(a, b, Average::people, {});
        CHECK(std::abs(paired.t - expected.number(0)) <= 1e-9 * std::max(1.0, std::abs(expected.number(0))));
        CHECK(paired.p == close_to(expected.number(1)).epsilon(1e-9));
        CHECK(paired.p_permutation == close_to(expected.number(4)).epsilon(1e-9));
        People first = a, second = b;
        for (std::size_t i = 0; i < 8; ++i) (i < 4 ? second : first)[i].reset();
        const PeopleTest groups = compare_people(first, second, Average::people, {});
        CHECK(groups.t == close_to(expected.number(2)).epsilon(1e-9));
        CHECK(groups.p == close_to(expected.number(3)).epsilon(1e-9));
        CHECK(groups.p_permutation == close_to(expected.number(5)).epsilon(1e-9));
    }
}

TEST_CASE("people test: with three times the marks under one condition, signs of PPV keep their level and t does not") {
    constexpr int kStudies = 1000, kPeople = 12;
    Random random(1);
    const auto person = [&](double marks) {
        const std::int64_t n = binomial_draw(30, marks / 30.0, random);
        return Contribution{binomial_draw(n, 0.8, random), n};
    };
    int computed = 0, t = 0, signs = 0;
    for (int i = 0; i < kStudies; ++i) {
        People a, b;
        for (int k = 0; k < kPeople; ++k) {
            a.emplace_back(person(1.5));
            b.emplace_back(person(0.5));
        }
        const PeopleTest test = compare_people(a, b, Average::pooled, {});
        if (std::isnan(test.difference)) continue;
        ++computed;
        t += test.p < 0.05;
        signs += test.p_permutation < 0.05;
    }
    CAPTURE(t);
    CAPTURE(signs);
    REQUIRE(computed > 900);
    CHECK(signs < 0.05 * computed);
    CHECK(t > 0.1 * computed);  // what the report warns of
}

TEST_CASE("people test: a single false mark among uneven numbers of marks is not permuted, five are") {
    const auto test_of = [](int false_marks, std::int64_t marks_of_b, bool within) {
        People a, b;
        for (int i = 0; i < 12; ++i) {
            const std::int64_t right = i < false_marks ? 1 : 2;
            a.emplace_back(Contribution{right, 2});
            b.emplace_back(Contribution{marks_of_b, marks_of_b});
        }
        if (!within) {
            a.resize(24);
            b.insert(b.begin(), 12, std::nullopt);
        }
        return compare_people(a, b, Average::pooled, {});
    };
    for (const bool within : {true, false}) {
        const PeopleTest one =
            test_of(1, 5, within);  // 23 of 24 against 60 of 60: p 0.0005 before, where chance gives 0.29
        CHECK(one.design == (within ? Design::within : Design::between));
        CHECK(one.permutation_unfit);
        CHECK(std::isnan(one.p_permutation));
        CHECK(one.p > 0.3);
        CHECK_FALSE(test_of(1, 2, within).permutation_unfit);
        const PeopleTest five = test_of(5, 5, within);
        CHECK_FALSE(five.permutation_unfit);
        CHECK(five.p_permutation < 0.05);
    }
}
