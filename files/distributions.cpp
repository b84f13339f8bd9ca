#include "files/distributions.h"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cassert>
#include <cmath>
#include <numbers>

namespace palpa::files {
namespace {

namespace policies = boost::math::policies;

// `double` throughout: the long double of x86 would give other digits than that of the web. Results that overflow or
// lose all digits are infinity or 0, not exceptions.
using Policy =
    policies::policy<policies::promote_double<false>, policies::domain_error<policies::ignore_error>,
                     policies::pole_error<policies::ignore_error>, policies::overflow_error<policies::ignore_error>,
                     policies::underflow_error<policies::ignore_error>,
                     policies::rounding_error<policies::ignore_error>,
                     policies::evaluation_error<policies::ignore_error>>;
using Normal = boost::math::normal_distribution<double, Policy>;
using Student = boost::math::students_t_distribution<double, Policy>;
using ChiSquared = boost::math::chi_squared_distribution<double, Policy>;
using FisherF = boost::math::fisher_f_distribution<double, Policy>;
using Binomial = boost::math::binomial_distribution<double, Policy>;

}  // namespace

double normal_quantile(double p) {
    assert(p > 0.0 && p < 1.0);
    return boost::math::quantile(Normal(), p);
}

double normal_probability(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

double student_p(double t, double df) {
    assert(df > 0.0);
    if (std::isnan(t)) return t;
    if (std::isinf(t)) return 0.0;
    return 2.0 * boost::math::cdf(boost::math::complement(Student(df), std::abs(t)));
}

double student_quantile(double level, double df) {
    assert(level > 0.0 && level < 1.0 && df > 0.0);
    return boost::math::quantile(boost::math::complement(Student(df), 0.5 * (1.0 - level)));
}

double chi_squared_p(double x, double df) {
    assert(df > 0.0);
    if (std::isnan(x)) return x;
    if (!(x > 0.0)) return 1.0;
    if (std::isinf(x)) return 0.0;
    return boost::math::cdf(boost::math::complement(ChiSquared(df), x));
}

double f_distribution_p(double f, double df1, double df2) {
    assert(df1 > 0.0 && df2 > 0.0);
    if (std::isinf(df2)) return chi_squared_p(f * df1, df1);
    if (std::isnan(f)) return f;
    if (!(f > 0.0)) return 1.0;
    if (std::isinf(f)) return 0.0;
    return boost::math::cdf(boost::math::complement(FisherF(df1, df2), f));
}

double binomial_probability(std::int64_t k, std::int64_t n, double chance) {
    assert(k >= 0 && k <= n && chance > 0.0 && chance < 1.0);
    return boost::math::pdf(Binomial(static_cast<double>(n), chance), static_cast<double>(k));
}

double binomial_at_most(std::int64_t k, std::int64_t n, double chance) {
    assert(k >= 0 && k <= n && chance > 0.0 && chance < 1.0);
    return boost::math::cdf(Binomial(static_cast<double>(n), chance), static_cast<double>(k));
}

}  // namespace palpa::files
