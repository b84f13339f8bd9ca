// Responses on disk, as arrays of doubles.

#include <algorithm>
#include <cmath>
#include <iterator>

#include "files/cache.h"
#include "parts/response.h"

namespace palpa::parts {
namespace {

constexpr std::size_t kFigures = 11;
constexpr double kAnyDisplacement_m = 1e14;

}  // namespace

std::optional<Response> read_response(const std::filesystem::path& cache, std::uint64_t fingerprint) {
    if (cache.empty()) return std::nullopt;
    const auto arrays = files::read_cache(cache, fingerprint);
    if (!arrays || arrays->size() < 4 || (*arrays)[0].size() != kFigures) return std::nullopt;
    const std::vector<double>& figures = (*arrays)[0];
    Response out;
    out.station_m = (*arrays)[1];
    out.compliance_m_per_N = (*arrays)[2];
    const std::size_t n = out.station_m.size();
    if (n == 0 || out.compliance_m_per_N.size() != n || arrays->size() != 3 + n) return std::nullopt;
    for (const double value : figures) {
        if (!(std::isfinite(value) && value >= 0.0 && value < 1e15)) return std::nullopt;
    }
    out.method = static_cast<Method>(figures[0]);
    out.named = std::min(static_cast<std::size_t>(figures[1]), n - 1);
    out.interpolation_error = figures[2];
    out.energy_error = figures[3];
    out.iterations = static_cast<int>(figures[4]);
    out.cells = static_cast<std::int64_t>(figures[5]);
    out.nodes = {static_cast<int>(figures[6]), static_cast<int>(figures[7])};
    out.spacing_m = figures[8];
    if (figures[9] < kAnyDisplacement_m) out.validity.to_m = figures[9];
    out.validity.why_not = kCellLimits[std::min(static_cast<std::size_t>(figures[10]), std::size(kCellLimits) - 1)];
    for (std::size_t i = 0; i < n; ++i) {
        const std::vector<double>& field = (*arrays)[3 + i];
        if (out.nodes[0] < 2 || out.nodes[1] < 2 ||
            field.size() != 2 * static_cast<std::size_t>(out.nodes[0]) * static_cast<std::size_t>(out.nodes[1]))
            return std::nullopt;
        out.field.emplace_back(field.begin(), field.end());
    }
    return out;
}

std::string write_response(const std::filesystem::path& cache, std::uint64_t fingerprint, const Response& response) {
    if (cache.empty() || !response.converged) return "";
    const auto* limit = std::find(std::begin(kCellLimits), std::end(kCellLimits), response.validity.why_not);
    files::CachedArrays arrays{
        {static_cast<double>(response.method), static_cast<double>(response.named), response.interpolation_error,
         response.energy_error, static_cast<double>(response.iterations), static_cast<double>(response.cells),
         static_cast<double>(response.nodes[0]), static_cast<double>(response.nodes[1]), response.spacing_m,
         std::min(response.validity.to_m, kAnyDisplacement_m), static_cast<double>(limit - std::begin(kCellLimits))},
        response.station_m,
        response.compliance_m_per_N};
    for (const std::vector<float>& field : response.field) arrays.emplace_back(field.begin(), field.end());
    return files::write_cache(cache, fingerprint, arrays);
}

}  // namespace palpa::parts
