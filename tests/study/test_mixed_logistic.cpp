#include <cmath>
#include <doctest/doctest.h>
#include <random>
#include <utility>

#include "files/table.h"
#include "study/mixed_logistic.h"
#include "tests/close_to.h"

using namespace palpa::study;
using namespace palpa::test;

namespace {

// The invented answers data/statistics/glmm*.csv beside the checkout: p participant, l nodule, c condition, y found.
MixedData stored_answers(const char* name) {
    palpa::files::Table table = palpa::files::read_csv(std::string(PALPA_RECORDINGS) + "/statistics/" + name);
    MixedData data;
    while (table.next()) {
        const auto of = [&](const char* column) { return static_cast<int>(table.number(table.column(column))); };
        data.cells.push_back({of("c"), of("p") - 1, of("l") - 1, of("y"), 1});
        data.participants = std::max(data.participants, of("p"));
        data.nodules = std::max(data.nodules, of("l"));
        data.conditions = std::max(data.conditions, of("c") + 1);
    }
    return data;
}

struct Stored {
    const char* name;
    double b0, b_c, se_0, se_c, rx_0, rx_c, s_p, s_l, log_likelihood, log_likelihood_null;
};

MixedData drawn_answers(std::uint32_t seed, int people, int nodules, double effect) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    MixedData data{2, people, nodules, {}};
    std::vector<double> v;
    for (int k = 0; k < nodules; ++k) v.push_back(normal(random));
    for (int i = 0; i < people; ++i) {
        const double u = 0.7 * normal(random);
        for (int c = 0; c < 2; ++c) {
            for (int k = 0; k < nodules; ++k) {
                const double p = 1.0 / (1.0 + std::exp(-(0.2 + effect * c + u + v[static_cast<std::size_t>(k)])));
                data.cells.push_back({c, i, k, uniform(random) < p ? 1 : 0, 1});
            }
        }
    }
    return data;
}

}  // namespace

TEST_CASE("mixed model: lme4's values of the stored answers") {
    // R 4.2.2, lme4 1.1.31: glmer(y ~ c + (1|p) + (1|l), nAGQ = 1, tolPwrss = 1e-13), printed with 5 digits
    constexpr Stored kStored[] = {
        {"glmm1.csv", -.00854, .88374, .57256, .36708, .56947, .35747, .21169, 1.44116, -105.129521, -108.172666},
        {"glmm2.csv", .04857, .65666, .53204, .35143, .52742, .33558, 1.07923, .95267, -115.203911, -116.994481}};
    for (const Stored& stored : kStored) {
        CAPTURE(stored.name);
        const MixedData data = stored_answers(stored.name);
        const MixedFit fit = fit_mixed_logistic(data);
        REQUIRE(fit.status.empty());
        CHECK_FALSE(fit.prior);
        CHECK(std::abs(fit.beta[0] - stored.b0) < 1e-4);
        CHECK(std::abs(fit.beta[1] - fit.beta[0] - stored.b_c) < 1e-4);
        CHECK(std::abs(fit.s_participants - stored.s_p) < 1e-4);
        CHECK(std::abs(fit.s_nodules - stored.s_l) < 1e-4);
        CHECK(std::abs(fit.log_likelihood - stored.log_likelihood) < 1e-5);
        REQUIRE_FALSE(fit.covariance.empty());
        CHECK(std::abs(standard_error(fit, 0, -1) - stored.se_0) < 1e-4);
        CHECK(std::abs(standard_error(fit, 1, 0) - stored.se_c) < 1e-4);
        MixedFit given = fit;
        given.covariance.clear();
        CHECK(std::abs(standard_error(given, 0, -1) - stored.rx_0) < 1e-4);
        CHECK(std::abs(standard_error(given, 1, 0) - stored.rx_c) < 1e-4);
        const MixedFit null = fit_mixed_logistic(data, {0, 0});
        CHECK(std::abs(null.log_likelihood - stored.log_likelihood_null) < 1e-5);
        CHECK(null.beta[0] == null.beta[1]);
    }
}

TEST_CASE("mixed model: the fit is the highest point, and sums of repeats count as the single answers") {
    constexpr std::uint32_t kSeed = 5;
    CAPTURE(kSeed);
    const MixedData data = drawn_answers(kSeed, 15, 7, 0.8);
    const MixedFit fit = fit_mixed_logistic(data);
    REQUIRE(fit.status.empty());
    const double top = mixed_log_likelihood(data, fit.beta, fit.s_participants, fit.s_nodules);
    CHECK(top == close_to(fit.log_likelihood).epsilon(1e-10));
    for (const double d : {-0.05, 0.05}) {
        CHECK(mixed_log_likelihood(data, {fit.beta[0] + d, fit.beta[1]}, fit.s_participants, fit.s_nodules) < top);
        CHECK(mixed_log_likelihood(data, {fit.beta[0], fit.beta[1] + d}, fit.s_participants, fit.s_nodules) < top);
        CHECK(mixed_log_likelihood(data, fit.beta, fit.s_participants + d, fit.s_nodules) < top);
        CHECK(mixed_log_likelihood(data, fit.beta, fit.s_participants, fit.s_nodules + d) < top);
    }
    MixedData twice = data, summed = data;
    twice.cells.insert(twice.cells.end(), data.cells.begin(), data.cells.end());
    for (MixedCell& cell : summed.cells) cell = {cell.condition, cell.participant, cell.nodule, 2 * cell.found, 2};
    CHECK(fit_mixed_logistic(twice).beta[1] == close_to(fit_mixed_logistic(summed).beta[1]).epsilon(1e-6));
}

TEST_CASE("mixed model: more nodules than people are fitted as well, with each spread at its own name") {
    constexpr std::uint32_t kSeed = 6;
    CAPTURE(kSeed);
    const MixedData data = drawn_answers(kSeed, 9, 21, 0.8);
    const MixedFit fit = fit_mixed_logistic(data);
    REQUIRE(fit.status.empty());
    REQUIRE(fit.covariance.size() == 4);
    const auto at = [&](double d_p, double d_n) {
        return mixed_log_likelihood(data, fit.beta, fit.s_participants + d_p, fit.s_nodules + d_n);
    };
    CHECK(at(0.0, 0.0) == close_to(fit.log_likelihood).epsilon(1e-10));
    for (const double d : {-0.05, 0.05}) {
        CHECK(at(d, 0.0) < at(0.0, 0.0));
        CHECK(at(0.0, d) < at(0.0, 0.0));
    }
    // with people and nodules in each other's place
    MixedData other{2, data.nodules, data.participants, data.cells};
    for (MixedCell& cell : other.cells) std::swap(cell.participant, cell.nodule);
    const MixedFit turned = fit_mixed_logistic(other);
    CHECK(turned.s_participants == close_to(fit.s_nodules).epsilon(1e-6));
    CHECK(turned.covariance[2][2] == close_to(fit.covariance[3][3]).epsilon(1e-6));
    CHECK(turned.covariance[0][3] == close_to(fit.covariance[0][2]).epsilon(1e-6));
}

TEST_CASE("mixed model: people and nodules that do not differ leave the spreads at 0 and the plain log odds") {
    MixedData data{2, 6, 6, {}};
    for (int c = 0; c < 2; ++c) {
        for (int i = 0; i < 6; ++i) {
            for (int k = 0; k < 6; ++k) data.cells.push_back({c, i, k, (i + k) % 6 <= 2 + c ? 1 : 0, 1});
        }
    }
    const MixedFit fit = fit_mixed_logistic(data);
    REQUIRE(fit.status.empty());
    CHECK(fit.s_participants < 1e-3);
    CHECK(fit.s_nodules < 1e-3);
    CHECK(fit.beta[0] == close_to(0.0).epsilon(1e-5));
    CHECK(fit.beta[1] == close_to(std::log(2.0)).epsilon(1e-5));
    CHECK(fit.covariance.empty());
    CHECK(standard_error(fit, 1, 0) == close_to(std::sqrt(4.0 / 36 + 1.5 / 24 * 36.0 / 36 * 2.0)).epsilon(1e-4));
    CHECK(averaged_share(fit, 1, 0.95).share == close_to(2.0 / 3.0).epsilon(1e-6));
}

TEST_CASE("mixed model: a condition under which everything was found gets the stated prior") {
    MixedData data = drawn_answers(11, 12, 6, 0.5);
    for (MixedCell& cell : data.cells) {
        if (cell.condition == 1) cell.found = 1;
    }
    CHECK(is_separated(data));
    const MixedFit fit = fit_mixed_logistic(data);
    REQUIRE(fit.status.empty());
    CHECK(fit.prior);
    CHECK(fit.beta[1] > fit.beta[0] + 1.0);
    CHECK(fit.beta[1] < 4.0 * kPriorSpread);
    CHECK(std::isfinite(standard_error(fit, 1, 0)));
    // the null model has the same prior, so that twice the difference is a likelihood ratio
    CHECK(fit_mixed_logistic(data, {0, 0}).log_likelihood < fit.log_likelihood - 2.0);
}

TEST_CASE("mixed model: one person, one lesion type, or nothing that differs cannot be computed, and it says why") {
    const auto status = [](const MixedData& data) { return fit_mixed_logistic(data).status; };
    const auto says = [&](const MixedData& data, const char* part) {
        CAPTURE(status(data));
        CHECK(status(data).find(part) != std::string::npos);
    };
    says({1, 1, 2, {{0, 0, 0, 1, 1}, {0, 0, 1, 0, 1}}}, "fewer than two participants");
    says({1, 2, 1, {{0, 0, 0, 1, 1}, {0, 1, 0, 0, 1}}}, "one nodule only");
    says({1, 2, 2, {{0, 0, 0, 1, 1}, {0, 1, 1, 1, 1}}}, "everything was found");
    says({1, 2, 2, {{0, 0, 0, 0, 1}, {0, 1, 1, 0, 1}}}, "nothing was found");
}

TEST_CASE("mixed model: a model that does not converge says so, and that the nodules differ without bound") {
    MixedData split{2, 30, 6, {}};  // half of the nodules found by everybody, half by nobody
    for (int c = 0; c < 2; ++c) {
        for (int i = 0; i < 30; ++i) {
            for (int k = 0; k < 6; ++k) split.cells.push_back({c, i, k, k % 2, 1});
        }
    }
    const MixedFit fit = fit_mixed_logistic(split);
    CAPTURE(fit.status);
    CHECK(fit.status.find("the model does not converge") != std::string::npos);
    CHECK(fit.status.find("differ without bound") != std::string::npos);
    CHECK(fit.beta.empty());
}

TEST_CASE("mixed model: the averaged share is the mean over the population") {
    CHECK(averaged_share(0.7, 0.0) == close_to(1.0 / (1.0 + std::exp(-0.7))).epsilon(1e-12));
    CHECK(averaged_share(0.0, 2.5) == close_to(0.5).epsilon(1e-12));
    CHECK(averaged_share(-1.3, 1.7) == close_to(1.0 - averaged_share(1.3, 1.7)).epsilon(1e-12));
    constexpr std::uint32_t kSeed = 3;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    std::normal_distribution<double> normal;
    double sum = 0.0;
    for (int i = 0; i < 200000; ++i) sum += 1.0 / (1.0 + std::exp(-(1.0 + 1.5 * normal(random))));
    CHECK(averaged_share(1.0, 1.5) == close_to(sum / 200000).epsilon(4e-3));
    const AveragedShare share = averaged_share(fit_mixed_logistic(drawn_answers(5, 15, 7, 0.8)), 0, 0.95);
    REQUIRE(share.ci);
    CHECK(share.ci->low < share.share);
    CHECK(share.ci->high > share.share);
}
