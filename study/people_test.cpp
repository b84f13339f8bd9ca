#include "study/people_test.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "files/distributions.h"
#include "study/permutation.h"

namespace palpa::study {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

// A sum of squares below this is rounding: the shares are exact to 1e-16.
constexpr double kNoSquares = 1e-24;

double own_share(const Contribution& one) { return static_cast<double>(one.k) / static_cast<double>(one.n); }

double mean_of(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double squares_of(std::span<const double> residuals) {
    return std::inner_product(residuals.begin(), residuals.end(), residuals.begin(), 0.0);
}

// One condition of the people who are compared: its share, how each person departs from it, and what is permuted.
struct Side {
    double share = 0.0;
    std::vector<double> residuals;  // mean 0
    std::vector<double> permuted;
};

Contribution total_of(std::span<const Contribution> people) {
    Contribution total;
    for (const Contribution& one : people) {
        total.k += one.k;
        total.n += one.n;
    }
    return total;
}

double pooled_share(std::span<const Contribution> people) { return own_share(total_of(people)); }

Side side_of(std::span<const Contribution> people, Average average, double share_of_both) {
    Side side;
    if (average == Average::people) {
        for (const Contribution& one : people) side.permuted.push_back(own_share(one));
        side.share = mean_of(side.permuted);
        for (const double value : side.permuted) side.residuals.push_back(value - side.share);
        return side;
    }
    const Contribution total = total_of(people);
    const auto k = static_cast<double>(total.k), n = static_cast<double>(total.n);
    side.share = k / n;
    const auto m = static_cast<double>(people.size());
    for (const Contribution& one : people) {
        const auto k_i = static_cast<double>(one.k), n_i = static_cast<double>(one.n);
        side.residuals.push_back((m - 1.0) * (side.share - (k - k_i) / (n - n_i)));
        side.permuted.push_back(k_i - share_of_both * n_i);
    }
    const double mean = mean_of(side.residuals);
    for (double& residual : side.residuals) residual -= mean;
    return side;
}

void cannot(const std::string& because, PeopleTest& test) {
    test.ci = {kNotKnown, kNotKnown};
    test.t = test.df = test.p = kNotKnown;
    test.status = "cannot be computed, because " + because;
}

void cannot_at_all(const std::string& because, PeopleTest& test) {
    cannot(because, test);
    test.difference = test.p_permutation = kNotKnown;
}

void take_t(double error, double df, double level, PeopleTest& test) {
    test.df = df;
    test.t = test.difference / error;
    test.p = files::student_p(test.t, df);
    const double arm = files::student_quantile(level, df) * error;
    test.ci = {test.difference - arm, test.difference + arm};
}

void take_permutation(const Permutation& permutation, PeopleTest& test) {
    test.p_permutation = permutation.p;
    test.permutation_exact = permutation.exact;
}

// Student's t of residuals around `difference`, one for each person.
void student(std::span<const double> residuals, const char* what, double level, PeopleTest& test) {
    const auto m = static_cast<double>(residuals.size());
    const double squares = squares_of(residuals);
    if (squares < kNoSquares) {
        cannot("the " + std::string(what) + " of all " + std::to_string(residuals.size()) +
                   " people are the same: no variance",
               test);
        return;
    }
    take_t(std::sqrt(squares / (m - 1.0) / m), m - 1.0, level, test);
}

// Welch's t of two groups' residuals.
void welch(std::span<const double> a, std::span<const double> b, double level, PeopleTest& test) {
    const auto m_a = static_cast<double>(a.size()), m_b = static_cast<double>(b.size());
    const double squares_a = squares_of(a), squares_b = squares_of(b);
    if (squares_a + squares_b < kNoSquares) {
        cannot("all people of each side have the same value: no variance", test);
        return;
    }
    const double v_a = squares_a / (m_a - 1.0) / m_a, v_b = squares_b / (m_b - 1.0) / m_b;
    const double v = v_a + v_b;
    take_t(std::sqrt(v), v * v / (v_a * v_a / (m_a - 1.0) + v_b * v_b / (m_b - 1.0)), level, test);
}

std::string too_few(std::size_t people, const char* where) {
    return (people == 0 ? "nobody " : "only one person ") + std::string(where);
}

bool counts(const std::optional<Contribution>& one, Average average) {
    return one && (one->n > 0 || average == Average::pooled);
}

// Those with something to count, for a share that is defined.
std::size_t with_something(std::span<const Contribution> people) {
    return static_cast<std::size_t>(
        std::count_if(people.begin(), people.end(), [](const Contribution& one) { return one.n > 0; }));
}

// Says whether the permutation of pooled counts keeps its level (people_test.h).
bool permutation_fits(std::span<const Contribution> a, std::span<const Contribution> b) {
    constexpr std::int64_t kFewestOfRarer = 5;
    constexpr double kUneven = 1.25;
    const Contribution of_a = total_of(a), of_b = total_of(b);
    const std::int64_t right = of_a.k + of_b.k, wrong = of_a.n + of_b.n - right;
    const auto [fewer, more] = std::minmax({static_cast<double>(of_a.n), static_cast<double>(of_b.n)});
    return std::min(right, wrong) >= kFewestOfRarer || more <= kUneven * fewer;
}

void compare_within(std::span<const Contribution> a, std::span<const Contribution> b, Average average,
                    const PeopleTestOptions& options, PeopleTest& test) {
    const std::size_t least = std::min({a.size(), with_something(a), with_something(b)});
    if (least < 2) return cannot_at_all(too_few(least, "has something to count under both conditions"), test);
    std::vector<Contribution> all(a.begin(), a.end());
    all.insert(all.end(), b.begin(), b.end());
    const Side of_a = side_of(a, average, pooled_share(all)), of_b = side_of(b, average, pooled_share(all));
    test.difference = of_a.share - of_b.share;
    std::vector<double> residuals, permuted;
    for (std::size_t i = 0; i < a.size(); ++i) {
        residuals.push_back(of_a.residuals[i] - of_b.residuals[i]);
        permuted.push_back(of_a.permuted[i] - of_b.permuted[i]);
    }
    student(residuals, "differences", options.level, test);
    test.permutation_unfit = options.permutation && average == Average::pooled && !permutation_fits(a, b);
    if (options.permutation && !test.permutation_unfit)
        take_permutation(sign_permutation(permuted, options.seed), test);
}

void compare_between(std::span<const Contribution> a, std::span<const Contribution> b, Average average,
                     const PeopleTestOptions& options, PeopleTest& test) {
    const std::size_t least = std::min(with_something(a), with_something(b));
    if (least < 2) return cannot_at_all(too_few(least, "of one side has something to count"), test);
    std::vector<Contribution> all(a.begin(), a.end());
    all.insert(all.end(), b.begin(), b.end());
    const Side of_a = side_of(a, average, pooled_share(all)), of_b = side_of(b, average, pooled_share(all));
    test.difference = of_a.share - of_b.share;
    welch(of_a.residuals, of_b.residuals, options.level, test);
    test.permutation_unfit = options.permutation && average == Average::pooled && !permutation_fits(a, b);
    if (options.permutation && !test.permutation_unfit)
        take_permutation(group_permutation(of_a.permuted, of_b.permuted, options.seed), test);
}

std::vector<double> differences(const People& a, const People& b) {
    std::vector<double> out;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (counts(a[i], Average::people) && counts(b[i], Average::people))
            out.push_back(own_share(*a[i]) - own_share(*b[i]));
    }
    return out;
}

std::vector<double> around_mean(std::vector<double> values) {
    const double mean = mean_of(values);
    for (double& value : values) value -= mean;
    return values;
}

PeopleTest new_test(Design design) {
    PeopleTest test;
    test.design = design;
    test.p_permutation = kNotKnown;
    return test;
}

}  // namespace

PeopleTest compare_people(const People& a, const People& b, Average average, const PeopleTestOptions& options) {
    assert(a.size() == b.size());
    std::vector<Contribution> both_a, both_b, only_a, only_b;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const bool in_a = counts(a[i], average), in_b = counts(b[i], average);
        if (in_a && in_b) {
            both_a.push_back(*a[i]);
            both_b.push_back(*b[i]);
        } else if (in_a) {
            only_a.push_back(*a[i]);
        } else if (in_b) {
            only_b.push_back(*b[i]);
        }
    }
    PeopleTest test = new_test(both_a.empty() ? Design::between : Design::within);
    if (test.design == Design::within) {
        test.people_a = test.people_b = static_cast<int>(both_a.size());
        test.left_out = static_cast<int>(only_a.size() + only_b.size());
        compare_within(both_a, both_b, average, options, test);
    } else {
        test.people_a = static_cast<int>(only_a.size());
        test.people_b = static_cast<int>(only_b.size());
        compare_between(only_a, only_b, average, options, test);
    }
    return test;
}

PeopleTest compare_with_chance(const People& people, double chance, const PeopleTestOptions& options) {
    PeopleTest test = new_test(Design::against_chance);
    std::vector<double> shares, permuted;
    for (const auto& one : people) {
        if (!counts(one, Average::people)) continue;
        shares.push_back(own_share(*one));
        permuted.push_back(static_cast<double>(one->k) - chance * static_cast<double>(one->n));
    }
    test.people_a = static_cast<int>(shares.size());
    if (shares.size() < 2) {
        cannot_at_all(too_few(shares.size(), "answered"), test);
        return test;
    }
    test.difference = mean_of(shares) - chance;
    student(around_mean(shares), "shares", options.level, test);
    if (options.permutation) take_permutation(sign_permutation(permuted, options.seed), test);
    return test;
}

PeopleTest compare_differences(const People& a_first, const People& b_first, const People& a_second,
                               const People& b_second, const PeopleTestOptions& options) {
    PeopleTest test = new_test(Design::between);
    const std::vector<double> first = differences(a_first, b_first), second = differences(a_second, b_second);
    test.people_a = static_cast<int>(first.size());
    test.people_b = static_cast<int>(second.size());
    const std::size_t least = std::min(first.size(), second.size());
    if (least < 2) {
        cannot_at_all(too_few(least, "of one group took part in both conditions"), test);
        return test;
    }
    test.difference = mean_of(first) - mean_of(second);
    welch(around_mean(first), around_mean(second), options.level, test);
    if (options.permutation) take_permutation(group_permutation(first, second, options.seed), test);
    return test;
}

}  // namespace palpa::study
