#include "study/levels.h"

#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <limits>

#include "study/bootstrap.h"
#include "study/people_test.h"
#include "study/random.h"
#include "study/statistics.h"

namespace palpa::study {
namespace {

constexpr std::array<double, 3> kNodules{1.0, 0.0, -1.0};  // logits
constexpr double kPersonSd = 1.0;
constexpr double kFalseMarks = 0.6065306597126334;  // exp(-0.5), of one trial
constexpr double kFalseMarksSd = 0.5;
constexpr double kEffect = 0.8;       // logits, where a difference is to be covered
constexpr int kChoiceAnswers = 10;    // of a repeat
constexpr double kChoiceLogit = 0.8;  // of a right answer

double logistic(double x) { return 1.0 / (1.0 + std::exp(-x)); }

// Mean of logistic(x + sd z) over a standard normal z, by Simpson's rule from -8 to 8.
double mean_logistic(double x, double sd) {
    constexpr int kSteps = 400;
    constexpr double kWidth = 16.0 / kSteps;
    double sum = 0.0;
    for (int i = 0; i <= kSteps; ++i) {
        const double z = -8.0 + kWidth * i;
        const double weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
        sum += weight * std::exp(-0.5 * z * z) * logistic(x + sd * z);
    }
    return sum * kWidth / 3.0 / std::sqrt(2.0 * std::acos(-1.0));
}

int poisson(double mean, Random& random) {
    int count = 0;
    for (double product = random.uniform(); product > std::exp(-mean); product *= random.uniform()) ++count;
    return count;
}

// What people found and marked under the two conditions.
struct Drawn {
    std::array<People, 2> found, marked;              // by condition
    std::array<std::array<People, 3>, 2> nodule;      // found, by condition and nodule
    std::array<Proportion, 2> all{{{0, 0}, {0, 0}}};  // found, all answers as one sample
    PairedCounts pairs;
};

void draw_person(const LevelCase& the_case, double effect, std::size_t i, Random& random, Drawn& out) {
    const double u = kPersonSd * random.normal(), w = effect + the_case.slope_sd * random.normal();
    const double v = kFalseMarksSd * random.normal();
    for (std::size_t c = 0; c < 2; ++c) {
        out.found[c][i] = out.marked[c][i] = Contribution{};
        for (std::size_t l = 0; l < 3; ++l) out.nodule[c][l][i] = Contribution{};
    }
    for (int r = 0; r < the_case.repeats; ++r) {
        for (std::size_t l = 0; l < kNodules.size(); ++l) {
            std::array<bool, 2> hit{};
            for (std::size_t c = 0; c < 2; ++c) {
                hit[c] = random.uniform() < logistic(kNodules[l] + u + (c == 1 ? 0.5 : -0.5) * w);
                for (auto* one : {&*out.found[c][i], &*out.nodule[c][l][i]}) {
                    one->k += hit[c];
                    ++one->n;
                }
            }
            ++(hit[0] ? (hit[1] ? out.pairs.both : out.pairs.only_a) : (hit[1] ? out.pairs.only_b : out.pairs.neither));
        }
        for (std::size_t c = 0; c < 2; ++c) {
            const double mean = kFalseMarks * std::exp(v - 0.5 * kFalseMarksSd * kFalseMarksSd);
            out.marked[c][i]->n += poisson(mean, random);
        }
    }
    for (std::size_t c = 0; c < 2; ++c) {
        out.all[c].k += out.found[c][i]->k;
        out.all[c].n += out.found[c][i]->n;
        out.marked[c][i]->k = out.found[c][i]->k;
        out.marked[c][i]->n += out.found[c][i]->k;
    }
}

Drawn draw(const LevelCase& the_case, double effect, Random& random) {
    Drawn out;
    const auto people = static_cast<std::size_t>(the_case.people);
    for (std::size_t c = 0; c < 2; ++c) {
        out.found[c].resize(people);
        out.marked[c].resize(people);
        for (People& one : out.nodule[c]) one.resize(people);
    }
    for (std::size_t i = 0; i < people; ++i) draw_person(the_case, effect, i, random, out);
    return out;
}

// The same with the first half of the people under the first condition only, the others under the second only.
std::array<People, 2> halves(const std::array<People, 2>& both) {
    std::array<People, 2> out = both;
    for (std::size_t i = 0; i < both[0].size(); ++i) out[2 * i < both[0].size() ? 1 : 0][i].reset();
    return out;
}

// Two groups of people, each under one condition.
std::array<People, 2> side_by_side(const People& a, const People& b) {
    std::array<People, 2> out{a, People(a.size())};
    out[0].resize(a.size() + b.size());
    out[1].insert(out[1].end(), b.begin(), b.end());
    return out;
}

Proportion total(const People& people) {
    Proportion x{0, 0};
    for (const auto& one : people) {
        x.k += one ? one->k : 0;
        x.n += one ? one->n : 0;
    }
    return x;
}

// NaN where there is nothing to count.
Interval wilson_of(const Proportion& x, double z) {
    constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
    return x.n > 0 ? wilson(x, z) : Interval{kNotKnown, kNotKnown};
}

People draw_choices(const LevelCase& the_case, double logit, Random& random) {
    People out;
    for (int i = 0; i < the_case.people; ++i) {
        const double p = logistic(logit + the_case.slope_sd * random.normal());
        Contribution one{0, kChoiceAnswers * the_case.repeats};
        for (std::int64_t k = 0; k < one.n; ++k) one.k += random.uniform() < p;
        out.emplace_back(one);
    }
    return out;
}

// Adds up rates in the order of their first use.
class Rates {
  public:
    explicit Rates(std::vector<Rate>& rates) : rates_(rates) {}
    void begin() { next_ = 0; }
    void add(const char* name, bool computed, bool happened, const char* label = "") {
        if (next_ == rates_.size()) rates_.push_back({name, label, 0, 0});
        Rate& rate = rates_[next_++];
        assert(rate.name == name);
        rate.n += computed;
        rate.hits += computed && happened;
    }
    void covers(const char* name, const Interval& ci, double truth, const char* label = "") {
        add(name, !std::isnan(ci.low), ci.low <= truth && truth <= ci.high, label);
    }

  private:
    std::vector<Rate>& rates_;
    std::size_t next_ = 0;
};

constexpr const char* kReplication = "replication";
constexpr const char* kIgnores = "ignores clustering";

void reject(const LevelCase& the_case, const LevelOptions& options, Random& random, Rates& rates) {
    const double alpha = 1.0 - options.level;
    const PeopleTestOptions how{options.level, options.seed, true};
    const auto of_test = [&](const char* t, const char* permutation, const PeopleTest& test) {
        rates.add(t, true, test.p < alpha);  // false for NaN
        rates.add(permutation, true, test.p_permutation < alpha);
    };
    const Drawn seen = draw(the_case, 0.0, random);
    rates.begin();
    of_test("paired t", "signs", compare_people(seen.found[0], seen.found[1], Average::people, how));
    of_test("PPV: paired t", "PPV: signs", compare_people(seen.marked[0], seen.marked[1], Average::pooled, how));
    const auto groups = halves(seen.found), marked = halves(seen.marked);
    of_test("groups: Welch's t", "groups: exchange", compare_people(groups[0], groups[1], Average::people, how));
    of_test("PPV of groups: t", "PPV of groups: exchange", compare_people(marked[0], marked[1], Average::pooled, how));
    const auto first = halves(seen.found);
    of_test("mixed: Welch's t", "mixed: exchange", [&] {
        std::array<People, 4> parts{seen.found[0], seen.found[1], seen.found[0], seen.found[1]};
        for (std::size_t i = 0; i < seen.found[0].size(); ++i) {
            const std::size_t other = first[0][i] ? 2 : 0;
            parts[other][i].reset();
            parts[other + 1][i].reset();
        }
        return compare_differences(parts[0], parts[1], parts[2], parts[3], how);
    }());
    of_test("choices: t", "choices: signs", compare_with_chance(draw_choices(the_case, 0.0, random), 0.5, how));
    rates.add("the paper's interval", true, combined_p(seen.all[0], seen.all[1]) < alpha, kReplication);
    rates.add("McNemar", true, mcnemar_p(seen.pairs) < alpha, kIgnores);
}

struct Truth {
    std::array<double, 2> se, ppv;
    std::array<double, 3> nodule;  // of the first condition
    double choices;
};

Truth truth_of(const LevelCase& the_case) {
    Truth truth{};
    const double sd = std::hypot(kPersonSd, 0.5 * the_case.slope_sd);
    for (std::size_t c = 0; c < 2; ++c) {
        double found = 0.0;
        for (std::size_t l = 0; l < kNodules.size(); ++l) {
            const double p = mean_logistic(kNodules[l] + (c == 1 ? 0.5 : -0.5) * kEffect, sd);
            if (c == 0) truth.nodule[l] = p;
            found += p;
        }
        truth.se[c] = found / 3.0;
        truth.ppv[c] = found / (found + kFalseMarks);
    }
    truth.choices = mean_logistic(kChoiceLogit, the_case.slope_sd);
    return truth;
}

void cover(const LevelCase& the_case, const Truth& truth, const LevelOptions& options, Random& random, Rates& rates) {
    const double z = z_of_level(options.level);
    const PeopleTestOptions how{options.level, options.seed, false};
    const BootstrapOptions boot{options.resamples, random.bits(), options.level};
    const Drawn seen = draw(the_case, kEffect, random);
    const auto &a = seen.found[0], &b = seen.found[1], &marked_a = seen.marked[0], &marked_b = seen.marked[1];
    rates.begin();
    rates.covers("Se: bootstrap", bootstrap_share(a, boot), truth.se[0]);
    const std::array<const char*, 3> nodules{"nodule A", "nodule B", "nodule C"};
    for (std::size_t l = 0; l < 3; ++l) {
        const People& nodule = seen.nodule[0][l];
        rates.covers(nodules[l], the_case.repeats == 1 ? wilson(total(nodule), z) : bootstrap_share(nodule, boot),
                     truth.nodule[l]);
    }
    rates.covers("PPV: bootstrap", bootstrap_share(marked_a, boot), truth.ppv[0]);
    const double se = truth.se[0] - truth.se[1], ppv = truth.ppv[0] - truth.ppv[1];
    rates.covers("Se a - b: paired t", compare_people(a, b, Average::people, how).ci, se);
    rates.covers("Se a - b: bootstrap", bootstrap_difference(a, b, Average::people, boot), se);
    rates.covers("PPV a - b: paired t", compare_people(marked_a, marked_b, Average::pooled, how).ci, ppv);
    rates.covers("PPV a - b: bootstrap", bootstrap_difference(marked_a, marked_b, Average::pooled, boot), ppv);
    const Drawn other = draw(the_case, kEffect, random);
    const std::array<People, 2> groups = side_by_side(a, other.found[1]),
                                groups_marked = side_by_side(marked_a, other.marked[1]);
    rates.covers("groups: Welch's t", compare_people(groups[0], groups[1], Average::people, how).ci, se);
    rates.covers("groups: bootstrap", bootstrap_difference(groups[0], groups[1], Average::people, boot), se);
    rates.covers("PPV of groups: t", compare_people(groups_marked[0], groups_marked[1], Average::pooled, how).ci, ppv);
    rates.covers("PPV of groups: bootstrap",
                 bootstrap_difference(groups_marked[0], groups_marked[1], Average::pooled, boot), ppv);
    const People choices = draw_choices(the_case, kChoiceLogit, random);
    rates.covers("choices: t", compare_with_chance(choices, 0.5, how).ci, truth.choices - 0.5);
    rates.covers("choices: bootstrap", bootstrap_share(choices, boot), truth.choices);
    rates.covers("Se: Wilson", wilson(seen.all[0], z), truth.se[0], kIgnores);
    rates.covers("PPV: Wilson", wilson_of(total(marked_a), z), truth.ppv[0], kIgnores);
    rates.covers("choices: Wilson", wilson(total(choices), z), truth.choices, kIgnores);
    rates.covers("Se a - b: Newcombe, paired", newcombe_paired(seen.pairs, z), se, kIgnores);
    rates.covers("Se a - b: Newcombe", newcombe(seen.all[0], seen.all[1], z), se, kReplication);
}

std::string percent(const Rate& rate) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", 100.0 * rate.rate());
    return rate.n == 0 ? "n/a" : text;
}

void append_table(const std::vector<LevelResult>& results, std::vector<Rate> LevelResult::*rates, std::string& out) {
    out += "| people, repeats, slope SD |";
    for (const LevelResult& one : results) {
        char text[64];
        std::snprintf(text, sizeof text, " %d, %d, %.3g |", one.the_case.people, one.the_case.repeats,
                      one.the_case.slope_sd);
        out += text;
    }
    out += "\n| --- |";
    for (std::size_t i = 0; i < results.size(); ++i) out += " --- |";
    out += "\n";
    for (std::size_t r = 0; !results.empty() && r < (results[0].*rates).size(); ++r) {
        const Rate& first = (results[0].*rates)[r];
        out += "| " + first.name + (first.label.empty() ? "" : " (" + first.label + ")") + " |";
        for (const LevelResult& one : results) out += " " + percent((one.*rates)[r]) + " |";
        out += "\n";
    }
}

}  // namespace

LevelResult measure_levels(const LevelCase& the_case, const LevelOptions& options) {
    LevelResult result;
    result.the_case = the_case;
    const std::uint64_t seed =
        derived_seed(options.seed, static_cast<std::uint64_t>(1000 * the_case.people + the_case.repeats),
                     static_cast<std::uint64_t>(std::llround(1000.0 * the_case.slope_sd)));
    Random random(seed);
    Rates rejections(result.rejections), coverage(result.coverage);
    const Truth truth = truth_of(the_case);
    for (int i = 0; i < options.studies; ++i) {
        reject(the_case, options, random, rejections);
        if (options.coverage) cover(the_case, truth, options, random, coverage);
    }
    return result;
}

std::string levels_markdown(const std::vector<LevelResult>& results, const LevelOptions& options) {
    std::string out = "Rejections of a true null hypothesis in " + std::to_string(options.studies) + " studies, %:\n\n";
    append_table(results, &LevelResult::rejections, out);
    if (!options.coverage) return out;
    out += "\nCoverage of the intervals, %:\n\n";
    append_table(results, &LevelResult::coverage, out);
    return out;
}

}  // namespace palpa::study
