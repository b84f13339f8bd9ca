#include "tactile/arm_compensation.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "files/json.h"
#include "files/text.h"

namespace palpa::tactile {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kSteady_m_per_s2 = 0.03;  // 1.6 kg: 0.05 N
constexpr double kSlowest_m_per_s = 0.8e-3;
constexpr double kFastest_m_per_s = 0.06;
// Friction turns over this distance: some steps of an encoder of 2 um, and no less than a bearing sticks over. In
// simulations 30 um kept a held arm quiet with hands of 0.3 to 3 N/mm; 100 um doubled the error of the stiffness.
constexpr double kFrictionReach_m = 30e-6;

struct Steady {  // readings of steady motion
    std::vector<double> depth_m, velocity_m_per_s, force_N;
};

// Rows that move, and whose velocity is the same 20 ms before and after.
Steady steady_rows(std::span<const StrokeRow> rows) {
    constexpr std::size_t kAround = 20, kEach = 4;
    Steady out;
    for (std::size_t i = kAround; i + kAround < rows.size(); i += kEach) {
        const StrokeRow& row = rows[i];
        const StrokeRow& before = rows[i - kAround];
        const StrokeRow& after = rows[i + kAround];
        const double v = row.velocity_m_per_s, dt_s = after.time_s - before.time_s;
        const bool moves = std::abs(v) > kSlowest_m_per_s && std::abs(v) < kFastest_m_per_s;
        const bool steady =
            dt_s > 0.0 && std::abs(after.velocity_m_per_s - before.velocity_m_per_s) < kSteady_m_per_s2 * dt_s;
        if (!moves || !steady || !std::isfinite(row.sensor_N + row.motor_N + row.depth_m)) continue;
        out.depth_m.push_back(row.depth_m);
        out.velocity_m_per_s.push_back(v);
        out.force_N.push_back(row.sensor_N - row.motor_N);
    }
    return out;
}

void check_strokes(const Steady& rows) {
    constexpr std::size_t kFewest = 250;  // of each fourth row
    constexpr double kShortest_m = 0.02;
    const auto down =
        std::count_if(rows.velocity_m_per_s.begin(), rows.velocity_m_per_s.end(), [](double v) { return v > 0.0; });
    const auto all = static_cast<std::ptrdiff_t>(rows.force_N.size());
    if (rows.force_N.size() < kFewest)
        throw std::runtime_error("identify: found " + std::to_string(4 * rows.force_N.size()) +
                                 " readings of steady motion, expected 1000: move evenly, at 1 to 60 mm/s");
    if (down < all / 10 || down > all - all / 10)
        throw std::runtime_error("identify: found strokes in one direction, expected down and up");
    const auto [low, high] = std::minmax_element(rows.depth_m.begin(), rows.depth_m.end());
    if (*high - *low < kShortest_m)
        throw std::runtime_error("identify: found strokes over " + files::short_number(1e3 * (*high - *low)) +
                                 " mm, expected at least 20 mm: the ripple's wavelength cannot be told otherwise");
}

struct LinearFit {
    Eigen::Matrix<double, 6, 1> x = Eigen::Matrix<double, 6, 1>::Zero();  // 1, sin, cos, sign, Stribeck, v
    double squares_N2 = 0.0;
};

// All parameters but wavelength and Stribeck's velocity. A zero wavelength: without ripple.
LinearFit linear_fit(const Steady& rows, double wavelength_m, double stribeck_m_per_s) {
    using Vector = Eigen::Matrix<double, 6, 1>;
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Vector right = Vector::Zero();
    double total = 0.0;
    for (std::size_t i = 0; i < rows.force_N.size(); ++i) {
        const double v = rows.velocity_m_per_s[i], ratio = v / stribeck_m_per_s, sign = v > 0.0 ? 1.0 : -1.0;
        const double angle = wavelength_m > 0.0 ? kTurn * rows.depth_m[i] / wavelength_m : 0.0;
        Vector a;
        a << 1.0, wavelength_m > 0.0 ? std::sin(angle) : 0.0, wavelength_m > 0.0 ? std::cos(angle) : 0.0, sign,
            sign * std::exp(-ratio * ratio), v;
        normal += a * a.transpose();
        right += a * rows.force_N[i];
        total += rows.force_N[i] * rows.force_N[i];
    }
    normal.diagonal().array() += 1e-9 * normal.trace();  // without slow or without fast strokes two columns are alike
    LinearFit fit;
    fit.x = normal.ldlt().solve(right);
    fit.squares_N2 = total - 2.0 * fit.x.dot(right) + fit.x.dot(normal * fit.x);
    return fit;
}

// What the fit without ripple leaves, as means over pieces of the depth; pieces without readings are interpolated.
std::vector<double> residual_over_depth(const Steady& rows, const LinearFit& fit, double stribeck_m_per_s,
                                        double lowest_m, double piece_m, std::size_t pieces) {
    std::vector<double> sum(pieces, 0.0), count(pieces, 0.0);
    for (std::size_t i = 0; i < rows.force_N.size(); ++i) {
        const double v = rows.velocity_m_per_s[i], ratio = v / stribeck_m_per_s, sign = v > 0.0 ? 1.0 : -1.0;
        const double model_N = fit.x[0] + sign * (fit.x[3] + fit.x[4] * std::exp(-ratio * ratio)) + fit.x[5] * v;
        const auto at = std::min(static_cast<std::size_t>((rows.depth_m[i] - lowest_m) / piece_m), pieces - 1);
        sum[at] += rows.force_N[i] - model_N;
        count[at] += 1.0;
    }
    double last = 0.0;
    for (std::size_t i = 0; i < pieces; ++i) last = sum[i] = count[i] > 0.0 ? sum[i] / count[i] : last;
    return sum;
}

// The wavelength of the greatest wave, by a Fourier transform of the residual.
double wavelength_of(const Steady& rows, double stribeck_m_per_s) {
    constexpr std::size_t kPieces = 256, kPadded = 4096;
    constexpr double kShortest_m = 2e-3;
    const auto [low, high] = std::minmax_element(rows.depth_m.begin(), rows.depth_m.end());
    const double range_m = *high - *low, piece_m = range_m / kPieces;
    std::vector<double> wave =
        residual_over_depth(rows, linear_fit(rows, 0.0, stribeck_m_per_s), stribeck_m_per_s, *low, piece_m, kPieces);
    double mean = 0.0;
    for (const double value : wave) mean += value / kPieces;
    for (std::size_t i = 0; i < kPieces; ++i)  // Hann's window
        wave[i] = (wave[i] - mean) * (0.5 - 0.5 * std::cos(kTurn * (static_cast<double>(i) + 0.5) / kPieces));
    wave.resize(kPadded, 0.0);
    std::vector<std::complex<double>> spectrum;
    Eigen::FFT<double> transform;
    transform.fwd(spectrum, wave);
    const double padded_m = piece_m * kPadded;
    std::size_t best = 0;
    for (std::size_t k = 1; k < kPadded / 2; ++k) {
        const double wavelength_m = padded_m / static_cast<double>(k);
        if (wavelength_m < kShortest_m || wavelength_m > 0.75 * range_m) continue;
        if (best == 0 || std::norm(spectrum[k]) > std::norm(spectrum[best])) best = k;
    }
    return best == 0 ? 0.5 * range_m : padded_m / static_cast<double>(best);
}

// The x with the smallest f between low and high, by the golden section.
template <class F>
double least(double low, double high, F&& f) {
    constexpr double kGolden = 0.6180339887498949;
    double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    double fa = f(a), fb = f(b);
    for (int i = 0; i < 24; ++i) {
        if (fa < fb) {
            high = b, b = a, fb = fa;
            a = high - kGolden * (high - low), fa = f(a);
        } else {
            low = a, a = b, fa = fb;
            b = low + kGolden * (high - low), fb = f(b);
        }
    }
    return 0.5 * (low + high);
}

ArmCompensation compensation_of(const LinearFit& fit, double wavelength_m, double stribeck_m_per_s) {
    ArmCompensation out;
    out.weight_N = -fit.x[0];
    out.ripple = {std::hypot(fit.x[1], fit.x[2]), wavelength_m, std::atan2(fit.x[2], fit.x[1])};
    out.coulomb_N = std::max(fit.x[3], 0.0);
    out.static_N = std::max(fit.x[3] + fit.x[4], out.coulomb_N);
    out.stribeck_m_per_s = stribeck_m_per_s;
    out.viscous_N_s_per_m = std::max(fit.x[5], 0.0);
    return out;
}

}  // namespace

CompensationFit fit_compensation(std::span<const StrokeRow> rows) {
    const Steady steady = steady_rows(rows);
    check_strokes(steady);
    double stribeck = 4e-3;
    double wavelength = wavelength_of(steady, stribeck);
    for (int i = 0; i < 3; ++i) {
        wavelength = least(0.9 * wavelength, 1.1 * wavelength,
                           [&](double w) { return linear_fit(steady, w, stribeck).squares_N2; });
        stribeck = std::exp(least(std::log(1e-3), std::log(2e-2), [&](double log_v) {
            return linear_fit(steady, wavelength, std::exp(log_v)).squares_N2;
        }));
    }
    const LinearFit fit = linear_fit(steady, wavelength, stribeck);
    CompensationFit out;
    out.compensation = compensation_of(fit, wavelength, stribeck);
    out.rows = steady.force_N.size();
    out.residual_N = std::sqrt(std::max(fit.squares_N2, 0.0) / static_cast<double>(out.rows));
    const auto [low, high] = std::minmax_element(steady.depth_m.begin(), steady.depth_m.end());
    out.lowest_m = *low;
    out.deepest_m = *high;
    const auto slower = [](double a, double b) { return std::abs(a) < std::abs(b); };
    const auto& v = steady.velocity_m_per_s;
    out.slowest_m_per_s = std::abs(*std::min_element(v.begin(), v.end(), slower));
    out.fastest_m_per_s = std::abs(*std::max_element(v.begin(), v.end(), slower));
    return out;
}

double compensation_N(const ArmCompensation& arm, double depth_m, double velocity_m_per_s,
                      FrictionDirection& direction) noexcept {
    if (!std::isfinite(depth_m) || !std::isfinite(velocity_m_per_s)) return 0.0;
    const double moved_m = direction.begun ? depth_m - direction.depth_m : 0.0;
    direction.begun = true;
    direction.depth_m = depth_m;
    const double way = moved_m > 0.0 ? 1.0 : -1.0;
    direction.share =
        std::clamp(direction.share + moved_m / kFrictionReach_m * (1.0 - way * direction.share), -1.0, 1.0);
    const double ratio = velocity_m_per_s / arm.stribeck_m_per_s;
    const double dry_N = arm.coulomb_N + (arm.static_N - arm.coulomb_N) * std::exp(-ratio * ratio);
    const double friction_N = direction.share * dry_N + arm.viscous_N_s_per_m * velocity_m_per_s;
    const double ripple_N =
        arm.ripple.amplitude_N * std::sin(kTurn * depth_m / arm.ripple.wavelength_m + arm.ripple.phase_rad);
    return arm.weight_N - ripple_N - arm.share * friction_N;
}

files::Json parameters_json(const ArmCompensation& arm) {
    return {{"coulomb_N", arm.coulomb_N},
            {"static_N", arm.static_N},
            {"stribeck_mm_per_s", 1e3 * arm.stribeck_m_per_s},
            {"viscous_N_s_per_m", arm.viscous_N_s_per_m},
            {"weight_N", arm.weight_N},
            {"ripple",
             {{"amplitude_N", arm.ripple.amplitude_N},
              {"wavelength_mm", 1e3 * arm.ripple.wavelength_m},
              {"phase_rad", arm.ripple.phase_rad}}}};
}

void write_compensation(const CompensationFit& fit, const std::string& arm, const std::filesystem::path& path) {
    files::Json json{{"kind", "compensation"}, {"arm", arm}};
    json.update(parameters_json(fit.compensation));
    json["share"] = fit.compensation.share;
    json["quality"] = {{"rows", fit.rows},
                       {"residual_N", fit.residual_N},
                       {"depth_mm", {1e3 * fit.lowest_m, 1e3 * fit.deepest_m}},
                       {"speed_mm_per_s", {1e3 * fit.slowest_m_per_s, 1e3 * fit.fastest_m_per_s}}};
    files::write_text_atomically(path, files::json_text(json));
}

ArmCompensation read_compensation(const std::filesystem::path& path) {
    const files::Json json = files::read_json(path);
    files::JsonReader reader(json, path.string());
    reader.only({"kind", "arm", "coulomb_N", "static_N", "stribeck_mm_per_s", "viscous_N_s_per_m", "weight_N", "ripple",
                 "share", "quality"});
    reader.choice("kind", {"compensation"});
    reader.text("arm", "");
    ArmCompensation out;
    out.coulomb_N = reader.number("coulomb_N", {0.0, 100.0});
    out.static_N = reader.number("static_N", {out.coulomb_N, 100.0});
    out.stribeck_m_per_s = 1e-3 * reader.number("stribeck_mm_per_s", {0.01, 1000.0});
    out.viscous_N_s_per_m = reader.number("viscous_N_s_per_m", {0.0, 1000.0});
    out.weight_N = reader.number("weight_N", {-100.0, 100.0});
    files::JsonReader ripple = reader.object("ripple");
    out.ripple.amplitude_N = ripple.number("amplitude_N", {0.0, 100.0});
    out.ripple.wavelength_m = 1e-3 * ripple.number("wavelength_mm", {0.1, 10000.0});
    out.ripple.phase_rad = ripple.number("phase_rad", {-10.0, 10.0});
    ripple.finish();
    out.share = reader.number("share", {0.0, 1.0}, out.share);
    if (reader.has("quality")) reader.any("quality");
    reader.finish();
    return out;
}

}  // namespace palpa::tactile
