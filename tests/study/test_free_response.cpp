#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

#include "study/free_response.h"
#include "tests/close_to.h"
#include "tests/study/froc_sets.h"

using namespace palpa::study;
using namespace palpa::test;

namespace {

constexpr double kX = kUnmarked;

// The example of RJafrocFrocBook, chapter 3 (CC0): four cases without lesions, five with.
FreeResponse book_example(bool equal_weights) {
    FreeResponse data{{"a"}, {"p"}, {}, {}};
    const auto add = [&](std::vector<double> nl, std::vector<double> ll, std::vector<double> weights) {
        FreeResponseCase one{"c", std::vector<std::string>(ll.size(), "l"), {}};
        if (!equal_weights) one.weights = std::move(weights);
        data.cases.push_back(one);
        data.readings.emplace_back(Reading{std::move(nl), std::move(ll)});
    };
    add({}, {}, {});
    add({0.5}, {}, {});
    add({0.7, 0.6}, {}, {});
    add({-0.3}, {}, {});
    add({1.5}, {0.9}, {1.0});
    add({}, {-0.2}, {1.0});
    add({}, {1.6, kX}, {0.1, 0.9});
    add({}, {3.0, 2.0}, {0.9, 0.1});
    add({}, {1.0, 2.5, 1.0}, {0.3, 0.4, 0.3});
    return data;
}

double figure(const FreeResponse& data, Merit merit) { return merit_of(data, 0, 0, merit).all; }

// The figure computed anew without case k.
double without_case(FreeResponse data, std::size_t k, std::size_t condition, std::size_t person, Merit merit) {
    for (std::size_t i = 0; i < data.conditions.size(); ++i) {
        for (std::size_t j = 0; j < data.participants.size(); ++j) data.readings[data.place(i, j, k)].reset();
    }
    return merit_of(data, condition, person, merit).all;
}

// The area under (FPF, weighted LLF) with the straight line from the last point to (1, 1).
double area_under_wafroc(const FreeResponse& data, std::size_t condition, std::size_t person) {
    double normal = 0.0, diseased = 0.0, area = 0.0, x_before = 0.0, y_before = 0.0;
    for (const auto& one : data.cases) (one.lesions.empty() ? normal : diseased) += 1.0;
    for (double rating = 5.0; rating >= 0.0; rating -= 1.0) {
        double x = 0.0, y = 0.0;
        for (std::size_t k = 0; k < data.cases.size(); ++k) {
            const Reading& reading = *data.at(condition, person, k);
            const auto at_least = [&](double z) { return z >= rating; };
            if (reading.ll.empty()) x += std::any_of(reading.nl.begin(), reading.nl.end(), at_least) / normal;
            if (reading.ll.empty()) continue;
            y += static_cast<double>(std::count_if(reading.ll.begin(), reading.ll.end(), at_least)) /
                 static_cast<double>(reading.ll.size()) / diseased;
        }
        area += 0.5 * (x - x_before) * (y + y_before);
        x_before = x;
        y_before = y;
    }
    return area + 0.5 * (1.0 - x_before) * (1.0 + y_before);
}

}  // namespace

TEST_CASE("free response: the book's example, with its weights and with equal ones") {
    const FreeResponse data = book_example(false);
    CHECK(figure(data, Merit::afroc) == close_to(0.8472222).epsilon(1e-7));
    CHECK(figure(data, Merit::wafroc) == close_to(0.7425).epsilon(1e-12));
    CHECK(figure(data, Merit::wafroc1) == close_to(0.7677778).epsilon(1e-7));
    CHECK(figure(data, Merit::hr_auc) == close_to(0.9).epsilon(1e-12));
    CHECK(figure(book_example(true), Merit::wafroc) == close_to(0.8125).epsilon(1e-12));
    CHECK(figure(book_example(true), Merit::wafroc1) == close_to(0.8240741).epsilon(1e-7));
    const auto curve = froc_curve(data, 0, std::nullopt);
    CHECK(curve.back().llf == close_to(8.0 / 9.0));
    CHECK(curve.back().nlf == close_to(5.0 / 9.0));
}

TEST_CASE("free response: figures of the stored sets") {
    for (const char* name : {"froc_small.json", "froc_big.json"}) {
        CAPTURE(name);
        const auto json = froc_json(name);
        const FreeResponse data = froc_set(json);
        for (std::size_t i = 0; i < data.conditions.size(); ++i) {
            for (std::size_t j = 0; j < data.participants.size(); ++j) {
                CAPTURE(i);
                CAPTURE(j);
                constexpr const char* kKeys[] = {"wAFROC", "wAFROC1", "AFROC", "HrAuc"};
                for (std::size_t m = 0; m < kMerits.size(); ++m) {
                    const double expected = json["foms"][kKeys[m]][i][j].get<double>();
                    CHECK(std::abs(merit_of(data, i, j, kMerits[m]).all - expected) < 1e-9);
                }
                const FrocPoint last = froc_curve(data, i, j).back();
                CHECK(std::abs(last.llf - json["foms"]["MaxLLF"][i][j].get<double>()) < 1e-12);
                CHECK(std::abs(last.nlf - json["foms"]["MaxNLFAllCases"][i][j].get<double>()) < 1e-12);
                CHECK(std::abs(merit_of(data, i, j, Merit::wafroc).all - area_under_wafroc(data, i, j)) < 1e-12);
            }
        }
    }
}

TEST_CASE("free response: the figure without a case is that of the other cases") {
    const FreeResponse data = froc_set(froc_json("froc_big.json"));
    for (const Merit merit : kMerits) {
        CAPTURE(name_of(merit));
        const MeritFigure figure = merit_of(data, 1, 3, merit);
        for (std::size_t k = 0; k < data.cases.size(); ++k) {
            CAPTURE(k);
            CHECK(std::abs(figure.without[k] - without_case(data, k, 1, 3, merit)) < 1e-12);
        }
    }
}

TEST_CASE("free response: nobody's marks give one half, false marks alone nothing, and no normal case leaves wafroc1") {
    FreeResponse data = book_example(true);
    for (auto& reading : data.readings) {
        reading->nl.clear();
        for (double& z : reading->ll) z = kX;
    }
    for (const Merit merit : kMerits) CHECK(figure(data, merit) == close_to(0.5));
    CHECK(llf_at(data, 0, std::nullopt, 0.5) == 0.0);
    for (auto& reading : data.readings) reading->nl.push_back(1.0);
    CHECK(figure(data, Merit::wafroc) == 0.0);
    CHECK(figure(data, Merit::hr_auc) == close_to(0.5));
    data = book_example(true);
    data.cases.erase(data.cases.begin(), data.cases.begin() + 4);
    data.readings.erase(data.readings.begin(), data.readings.begin() + 4);
    CHECK(std::isnan(figure(data, Merit::wafroc)));
    CHECK(std::isfinite(figure(data, Merit::wafroc1)));
    for (auto& one : data.cases) one.lesions.clear();
    for (auto& reading : data.readings) reading->ll.clear();
    CHECK(std::isnan(figure(data, Merit::wafroc1)));
    CHECK(std::isnan(llf_at(data, 0, 0, 0.5)));
}

TEST_CASE("free response: the share found at some false marks a case lies on the lines between the points") {
    // (0, 2/7) (0, 4/7) (1/8, 5/7) (3/8, 6/7) (5/8, 6/7)
    const FreeResponse data = froc_set(froc_json("froc_small.json"));
    REQUIRE(froc_curve(data, 0, 0).size() == 5);
    CHECK(llf_at(data, 0, 0, 0.0) == close_to(4.0 / 7.0));
    CHECK(llf_at(data, 0, 0, 1.0 / 16.0) == close_to(9.0 / 14.0));
    CHECK(llf_at(data, 0, 0, 0.25) == close_to(11.0 / 14.0));
    CHECK(llf_at(data, 0, 0, 0.5) == close_to(6.0 / 7.0));
    CHECK(llf_at(data, 0, 0, 9.0) == close_to(6.0 / 7.0));
}
