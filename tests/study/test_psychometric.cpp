#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <fstream>
#include <sstream>

#include "files/text.h"
#include "study/psychometric.h"
#include "study/simulated_observer.h"
#include "tests/close_to.h"
#include "tests/study/python.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

constexpr double kOpen = 1e9;  // in the table below: no limit

bool near_limit(const std::optional<double>& limit, double expected) {
    if (expected == kOpen) return !limit;
    return limit && std::abs(*limit - expected) <= 1e-4;
}

struct ReferenceSet {
    const char* name;
    std::vector<std::int64_t> stiffer;
    double pse, pse_low, pse_high, sd, sd_low, sd_high, lapse, minus_log_likelihood, deviance;
    double probit_pse, probit_sd;
};

// Found by two independent optimisers that agree to 6 digits; the last two columns by statsmodels, without lapse.
const std::vector<ReferenceSet> kReferenceSets{
    {"A",
     {1, 3, 10, 16, 25, 31, 37, 40},
     -.015354,
     -.072212,
     .041777,
     .316631,
     .229769,
     .385169,
     0.0,
     123.846278,
     1.31258,
     -.01535416,
     .31663149},
    {"B",
     {2, 3, 6, 14, 26, 35, 37, 38},
     -.006051,
     -.055943,
     .044010,
     .185396,
     .132658,
     .273079,
     .05,
     121.321037,
     .70832,
     -.00452347,
     .33278826},
    {"C",
     {17, 19, 18, 21, 20, 22, 21, 24},
     -.057020,
     kOpen,
     kOpen,
     3.643338,
     1.510897,
     kOpen,
     0.0,
     220.339275,
     .68007,
     -.05701963,
     3.64333791},
    {"D",
     {1, 1, 7, 13, 26, 33, 38, 39},
     .006575,
     -.043176,
     .057346,
     .218663,
     .156787,
     .303230,
     .023567,
     110.426778,
     .47625,
     .00951854,
     .28427618},
};

std::vector<LevelAnswers> eight_levels(const std::vector<std::int64_t>& stiffer) {
    constexpr double kComparisons_kPa[] = {.875, 1.1, 1.4, 1.6, 1.9, 2.2, 2.8, 3.5};
    std::vector<LevelAnswers> levels;
    for (std::size_t i = 0; i < 8; ++i) levels.push_back({std::log(kComparisons_kPa[i] / 1.75), stiffer[i], 40});
    return levels;
}

std::string text_of(const std::vector<LevelAnswers>& levels) {
    std::string out;
    for (const LevelAnswers& level : levels) {
        out += number_text(level.x) + " " + std::to_string(level.stiffer) + " " + std::to_string(level.n) + "\n";
    }
    return out;
}

// Twelve observers with other PSE, sd and lapse, of whom psignifit and scipy are asked too.
std::vector<std::vector<LevelAnswers>> drawn_sets(std::uint64_t seed) {
    Random random(seed);
    std::vector<std::vector<LevelAnswers>> sets;
    for (int i = 0; i < 12; ++i) {
        const PsychometricCurve truth{random.uniform(-0.2, 0.2), random.uniform(0.15, 0.5), random.uniform(0.0, 0.05)};
        sets.push_back(draw_answers(paper_levels(), 240, truth, random));
    }
    return sets;
}

}  // namespace

TEST_CASE("psychometric: estimates, limits and deviance of reference sets") {
    for (const ReferenceSet& set : kReferenceSets) {
        CAPTURE(set.name);
        const PsychometricFit fit = fit_psychometric(eight_levels(set.stiffer), {});
        REQUIRE(fit.pse);
        REQUIRE(fit.sd);
        CHECK(std::abs(*fit.pse - set.pse) <= 1e-6);
        CHECK(std::abs(*fit.sd - set.sd) <= 1e-6);
        CHECK(std::abs(fit.lapse - set.lapse) <= 1e-6);
        CHECK(std::abs(-fit.log_likelihood - set.minus_log_likelihood) <= 1e-6);
        CHECK(std::abs(fit.deviance - set.deviance) <= 1e-5);
        CHECK(near_limit(fit.pse_ci.low, set.pse_low));
        CHECK(near_limit(fit.pse_ci.high, set.pse_high));
        CHECK(near_limit(fit.sd_ci.low, set.sd_low));
        CHECK(near_limit(fit.sd_ci.high, set.sd_high));
        CHECK(fit.status == (set.sd_high == kOpen ? FitStatus::open : FitStatus::ok));
        const PsychometricFit probit = fit_psychometric(eight_levels(set.stiffer), {0.95, 0.0});
        CHECK(probit.lapse == 0.0);
        CHECK(std::abs(*probit.pse - set.probit_pse) <= 1e-8);
        CHECK(std::abs(*probit.sd - set.probit_sd) <= 2e-8);
    }
}

TEST_CASE("psychometric: answers that a step separates have no estimate, and sd has an upper limit only") {
    for (const std::vector<std::int64_t>& stiffer : {std::vector<std::int64_t>{0, 0, 0, 0, 40, 40, 40, 40},
                                                     {0, 0, 0, 0, 7, 40, 40, 40},
                                                     {0, 0, 0, 1, 40, 40, 40, 40}}) {
        const PsychometricFit fit = fit_psychometric(eight_levels(stiffer), {});
        CHECK(fit.status == FitStatus::separated);
        CHECK_FALSE(fit.pse);
        CHECK_FALSE(fit.sd);
        CHECK_FALSE(fit.pse_ci.low);
        CHECK_FALSE(fit.pse_ci.high);
        CHECK_FALSE(fit.sd_ci.low);
        REQUIRE(fit.sd_ci.high);
        CHECK(*fit.sd_ci.high > 0.0);
        CHECK(*fit.sd_ci.high < 0.3);
    }
}

TEST_CASE("psychometric: the upper limit of sd of a step is that of the flattest curve that the answers allow") {
    // levels that lie close together; a grid of 4,401 places, 101 lapses and sd gives the limit 0.471. Between 0.046 and 0.15
    // the answers exclude sd.
    const double kPa[] = {500, 700, 714.2857, 857.1429, 875, 1142.857, 1166.667, 1400, 1428.571, 2000};
    const std::int64_t stiffer[] = {0, 0, 0, 0, 2, 1, 2, 1, 2, 4}, n[] = {4, 2, 2, 2, 2, 2, 2, 2, 2, 4};
    std::vector<LevelAnswers> levels;
    for (std::size_t i = 0; i < std::size(kPa); ++i) levels.push_back({std::log(kPa[i] / 1000.0), stiffer[i], n[i]});
    const PsychometricFit fit = fit_psychometric(levels, {});
    CHECK(fit.status == FitStatus::separated);
    CHECK_FALSE(fit.sd_ci.low);
    REQUIRE(fit.sd_ci.high);
    CHECK(*fit.sd_ci.high == close_to(0.471).epsilon(0.005));
}

TEST_CASE("psychometric: the lower limit of sd is that of the steepest curve that the answers allow") {
    // one simulated person of a study with pairs of 1, 1.1, 1.3, 1.6 and 2 times the stiffness; another program finds that the
    // answers allow sd from 0.0294 to 0.117 and from 0.145 to 0.872
    const double x[] = {-0.5108256238, -0.4700036292, -0.2876820725, -0.2623642645, -0.1053605157, -0.0953101798,
                        0.0953101798,  0.1053605157,  0.2623642645,  0.2876820725,  0.4700036292,  0.5108256238};
    const std::int64_t stiffer[] = {0, 0, 2, 1, 0, 0, 2, 0, 2, 2, 2, 2};
    std::vector<LevelAnswers> levels;
    for (std::size_t i = 0; i < std::size(x); ++i) levels.push_back({x[i], stiffer[i], 2});
    const PsychometricFit fit = fit_psychometric(levels, {});
    CHECK(fit.status == FitStatus::ok);
    REQUIRE(fit.sd_ci.low);
    CHECK(*fit.sd_ci.low == close_to(0.0294).epsilon(0.005));
    CHECK(*fit.sd_ci.high == close_to(0.8719).epsilon(0.001));
}

TEST_CASE("psychometric: answers that do not rise have no estimate") {
    for (const std::vector<std::int64_t>& stiffer : {std::vector<std::int64_t>{40, 37, 31, 25, 16, 10, 3, 1},
                                                     {20, 20, 20, 20, 20, 20, 20, 20},
                                                     {40, 40, 40, 40, 40, 40, 40, 40},
                                                     {0, 0, 0, 0, 0, 0, 0, 0}}) {
        const PsychometricFit fit = fit_psychometric(eight_levels(stiffer), {});
        CHECK(fit.status == FitStatus::open);
        CHECK_FALSE(fit.rises);
        CHECK_FALSE(fit.pse);
        CHECK_FALSE(fit.sd);
        CHECK_FALSE(fit.pse_ci.low);
        CHECK_FALSE(fit.sd_ci.high);
    }
}

TEST_CASE("psychometric: both limits have the likelihood that their level asks for") {
    const std::vector<LevelAnswers> levels = eight_levels(kReferenceSets[3].stiffer);
    for (const double level : {0.8, 0.95, 0.99}) {
        const PsychometricFit fit = fit_psychometric(levels, {level, 0.05});
        const double z = z_of_level(level);
        const double least = fit.log_likelihood - 0.5 * z * z;
        for (const double sd : {*fit.sd_ci.low, *fit.sd_ci.high}) {
            double best = -1e300;  // over a grid of the others, fine enough for 2e-3 of the likelihood
            for (double pse = -0.1; pse <= 0.1; pse += 0.002) {
                for (double lapse = 0.0; lapse <= 0.05001; lapse += 0.001)
                    best = std::max(best, log_likelihood(levels, {pse, sd, lapse}));
            }
            CHECK(best <= least + 1e-6);
            CHECK(best >= least - 2e-2);
        }
    }
}

TEST_CASE("psychometric: a limit of the PSE at a level is there, where steps on its way are likely enough") {
    // the shares 1/8 at ln(18/20) and 1/2 at ln(19/20) let the PSE be anywhere between these levels, by a step; at
    // ln(18/20) the profile jumps, as a grid of sd and lapse shows
    std::vector<LevelAnswers> levels;
    const double kPa[] = {10, 13, 16, 18, 19, 21, 23, 26, 32, 40};
    const std::int64_t stiffer[] = {1, 1, 1, 1, 1, 7, 8, 8, 7, 6}, n[] = {2, 10, 9, 8, 2, 8, 8, 8, 8, 6};
    for (std::size_t i = 0; i < std::size(kPa); ++i) levels.push_back({std::log(kPa[i] / 20.0), stiffer[i], n[i]});
    const PsychometricFit fit = fit_psychometric(levels, {0.95, 0.1});
    REQUIRE(fit.pse_ci.closed());
    CHECK(std::abs(*fit.pse_ci.low - std::log(18.0 / 20.0)) < 1e-6);
    CHECK(std::abs(*fit.pse_ci.high - std::log(21.0 / 20.0)) < 1e-6);
}

// Few answers may make two tops: a wide flat one, and a narrow steep one between two levels.
TEST_CASE("psychometric: the likeliest of several tops is found") {
    const std::vector<double> comparisons{.8167, 1.1136, 1.3611, 1.5312, 1.6333, 1.875, 2.0, 2.25, 2.75, 3.75};
    const auto answers = [&](const std::vector<std::int64_t>& stiffer, std::int64_t n) {
        std::vector<LevelAnswers> levels;
        for (std::size_t i = 0; i < comparisons.size(); ++i)
            levels.push_back({std::log(comparisons[i] / 1.75), stiffer[i], n});
        return levels;
    };
    const PsychometricFit steep = fit_psychometric(answers({0, 1, 0, 0, 1, 1, 5, 5, 6, 6}, 6), {});
    CHECK(*steep.sd == close_to(0.0286).epsilon(2e-3));
    CHECK(*steep.pse == close_to(0.1013).epsilon(1e-3));
    CHECK(steep.lapse == close_to(0.05));
    CHECK(steep.deviance == close_to(6.371).epsilon(1e-3));
    const PsychometricFit flatter = fit_psychometric(answers({0, 0, 1, 1, 0, 5, 5, 8, 8, 8}, 8), {});
    CHECK(*flatter.sd == close_to(0.0886).epsilon(2e-3));
    CHECK(flatter.deviance == close_to(7.673).epsilon(1e-3));
}

TEST_CASE("psychometric: no curve of a dense grid is likelier, for drawn answers of few") {
    const std::uint64_t seed = 20261128;
    CAPTURE(seed);
    Random random(seed);
    for (int set = 0; set < 60; ++set) {
        CAPTURE(set);
        std::vector<LevelAnswers> levels;
        const double sd = random.uniform(0.03, 0.4), pse = random.uniform(-0.2, 0.2), lapse = random.uniform(0.0, 0.05);
        const int n = 4 + static_cast<int>(random.below(5));
        for (int i = 0; i < 10; ++i) {
            LevelAnswers level{-0.8 + 0.16 * i + random.uniform(-0.03, 0.03), 0, n};
            for (int k = 0; k < n; ++k)
                level.stiffer += random.uniform() < probability_stiffer(level.x, {pse, sd, lapse});
            levels.push_back(level);
        }
        const PsychometricFit fit = fit_psychometric(levels, {});
        double greatest = -std::numeric_limits<double>::infinity();
        for (double u = std::log(0.004); u < std::log(2.0); u += 0.15) {
            for (double at = -0.8; at < 0.8; at += 0.01) {
                for (const double l : {0.0, 0.01, 0.03, 0.05})
                    greatest = std::max(greatest, log_likelihood(levels, {at, std::exp(u), l}));
            }
        }
        CHECK(fit.log_likelihood >= greatest - 1e-7);
    }
}

TEST_CASE("psychometric: the curve, its lapse and the just noticeable difference") {
    const PsychometricCurve curve{0.1, 0.3, 0.04};
    CHECK(probability_stiffer(0.1, curve) == close_to(0.5));
    CHECK(probability_stiffer(-9.0, curve) == close_to(0.04));
    CHECK(probability_stiffer(9.0, curve) == close_to(0.96));
    CHECK(probability_stiffer(0.1 + jnd_of_sd(0.3), {0.1, 0.3, 0.0}) == close_to(0.75));
    // the paper's two conditions: 82 % right is a JND of 18.9 %, 56 % right one of 339 %
    const auto right = [](double sd) {
        double sum = 0.0;
        for (const double x : paper_levels()) sum += probability_stiffer(std::abs(x), {0.0, sd, 0.0}) / 10.0;
        return sum;
    };
    CHECK(right(.2567221) == close_to(.82).epsilon(1e-6));
    CHECK(right(2.1929494) == close_to(.56).epsilon(1e-6));
    CHECK(jnd_percent_of_sd(.2567221) == close_to(18.9).epsilon(2e-3));
    CHECK(jnd_percent_of_sd(2.1929494) == close_to(339).epsilon(2e-3));
}

TEST_CASE("psychometric: turning the axis around turns the PSE, units of x scale both") {
    std::vector<LevelAnswers> levels = eight_levels(kReferenceSets[3].stiffer);
    const PsychometricFit fit = fit_psychometric(levels, {});
    for (LevelAnswers& level : levels) level = {-2.0 * level.x, level.n - level.stiffer, level.n};
    const PsychometricFit turned = fit_psychometric(merged_levels(levels), {});
    CHECK(*turned.pse == close_to(-2.0 * *fit.pse).epsilon(1e-6));
    CHECK(*turned.sd == close_to(2.0 * *fit.sd).epsilon(1e-6));
    CHECK(*turned.sd_ci.low == close_to(2.0 * *fit.sd_ci.low).epsilon(1e-5));
    CHECK(*turned.pse_ci.high == close_to(-2.0 * *fit.pse_ci.low).epsilon(1e-4));
    CHECK(turned.deviance == close_to(fit.deviance).epsilon(1e-6));
}

TEST_CASE("psychometric: levels are sorted, equal ones added up, empty ones left out") {
    const auto levels = merged_levels({{0.5, 3, 4}, {-0.5, 0, 2}, {0.5 + 1e-12, 1, 2}, {0.2, 0, 0}});
    REQUIRE(levels.size() == 2);
    CHECK(levels[0].x == -0.5);
    CHECK(levels[1].stiffer == 4);
    CHECK(levels[1].n == 6);
}

TEST_CASE("psychometric: statsmodels' probit and scipy's optimisers find the same, and nothing likelier") {
    const std::string python = python_with("statsmodels.api, scipy.optimize");
    if (python.empty()) {
        MESSAGE("not checked: no Python with statsmodels and scipy");
        return;
    }
    constexpr std::uint64_t kSeed = 4;
    CAPTURE(kSeed);
    const TemporaryFolder folder;
    const auto sets = drawn_sets(kSeed);
    std::string data;
    for (const auto& set : sets) data += text_of(set) + "\n";
    write_text_atomically(folder / "sets.txt", data);
    REQUIRE_MESSAGE(run_python(python, folder, R"py(
import warnings
import numpy as np
import statsmodels.api as sm
from scipy.optimize import minimize
from scipy.stats import norm
warnings.simplefilter("ignore")
for block in open("sets.txt").read().strip().split("\n\n"):
    x, k, n = np.array([line.split() for line in block.split("\n")], float).T
    probit = sm.GLM(np.column_stack([k, n - k]), sm.add_constant(x), family=sm.families.Binomial(sm.families.links.probit()))
    a, b = probit.fit(tol=1e-14, maxiter=500).params
    def minus(theta):
        p = theta[2] + (1 - 2 * theta[2]) * norm.cdf((x - theta[0]) / np.exp(theta[1]))
        p = np.clip(p, 1e-12, 1 - 1e-12)
        return -np.sum(k * np.log(p) + (n - k) * np.log(1 - p))
    fits = [minimize(minus, [-a / b, -np.log(b), l], method=m, bounds=[(-3, 3), (-6, 3), (0, 0.05)],
                     options={"maxiter": 20000, "xatol": 1e-10, "fatol": 1e-12} if m == "Nelder-Mead" else {})
            for l in (0.001, 0.02, 0.045) for m in ("Nelder-Mead", "L-BFGS-B")]
    best = min(fits, key=lambda f: f.fun)
    print(repr(-a / b), repr(1 / b), repr(best.x[0]), repr(np.exp(best.x[1])), repr(best.x[2]), repr(-best.fun))
)py"),
                    read_text(folder / "said.txt"));
    std::istringstream said(read_text(folder / "said.txt"));
    for (const auto& set : sets) {
        double probit_pse = 0.0, probit_sd = 0.0, pse = 0.0, sd = 0.0, lapse = 0.0, log_likelihood = 0.0;
        const bool read = static_cast<bool>(said >> probit_pse >> probit_sd >> pse >> sd >> lapse >> log_likelihood);
        REQUIRE(read);
        CAPTURE(text_of(set));
        const PsychometricFit probit = fit_psychometric(set, {0.95, 0.0});
        CHECK(std::abs(*probit.pse - probit_pse) <= 1e-6);
        CHECK(std::abs(*probit.sd - probit_sd) <= 1e-6);
        const PsychometricFit fit = fit_psychometric(set, {});
        CHECK(fit.log_likelihood >= log_likelihood - 1e-9);
        CHECK(std::abs(fit.log_likelihood - log_likelihood) <= 1e-6);
        CHECK(std::abs(*fit.pse - pse) <= 1e-4);
        CHECK(std::abs(*fit.sd - sd) <= 1e-4);
        CHECK(std::abs(fit.lapse - lapse) <= 1e-3);
    }
}

TEST_CASE("psychometric: psignifit finds nothing likelier, and the same sd to 2 % where limits exist") {
    if (std::system("command -v psignifit >/dev/null 2>&1") != 0) {
        MESSAGE("not checked: psignifit is not installed");
        return;
    }
    constexpr std::uint64_t kSeed = 5;
    CAPTURE(kSeed);
    const TemporaryFolder folder;
    auto sets = drawn_sets(kSeed);
    for (const ReferenceSet& set : kReferenceSets) sets.push_back(eight_levels(set.stiffer));
    double greatest_off = 0.0;
    for (const auto& set : sets) {
        const std::string asked =
            "#matrix_format xrn\n#shape cumulative gaussian\n#n_intervals 1\n#lambda_equals_gamma true\n#verbose "
            "false\n"
            "#write_pa_est -n -\n#write_format %.12g\n";  // its lapse is at most 0.05 too, unless told otherwise
        write_text_atomically(folder / "asked.txt", text_of(set) + asked);
        const std::string command =
            "cd " + folder.path().string() + " && timeout 20 psignifit - <asked.txt >said.txt 2>&1";
        const int status = std::system(command.c_str());
        CAPTURE(text_of(set));
        REQUIRE_MESSAGE(status == 0, read_text(folder / "said.txt"));
        std::string text = read_text(folder / "said.txt");
        std::replace(text.begin(), text.end(), ',', ' ');
        std::istringstream said(text);
        PsychometricCurve other;
        double gamma = 0.0;
        const bool read = static_cast<bool>(said >> other.pse >> other.sd >> gamma >> other.lapse);
        REQUIRE_MESSAGE(read, said.str());
        const PsychometricFit fit = fit_psychometric(set, {});
        CHECK(fit.log_likelihood >= log_likelihood(set, other) - 1e-9);
        if (fit.status != FitStatus::ok) continue;
        greatest_off = std::max(greatest_off, std::abs(other.sd / *fit.sd - 1.0));
        CHECK(std::abs(other.sd / *fit.sd - 1.0) <= 0.02);
    }
    MESSAGE("greatest difference of sd: ", 100.0 * greatest_off, " %");
}
