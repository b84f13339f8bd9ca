#include "tactile/table_cache.h"

#include "files/cache.h"

namespace palpa::tactile {
namespace {

constexpr double kTableVersion = 2.0;

// 64-bit FNV-1a over the bytes of numbers.
struct Digest {
    std::uint64_t hash = 14695981039346656037ull;
    void add(const double* values, std::size_t n) {
        const auto* byte = reinterpret_cast<const unsigned char*>(values);
        for (std::size_t i = 0; i < n * sizeof(double); ++i) hash = (hash ^ byte[i]) * 1099511628211ull;
    }
};

template <class T>
std::vector<double> doubles(const std::vector<T>& values) {
    return {values.begin(), values.end()};
}

std::vector<float> floats(const std::vector<double>& values) {
    std::vector<float> out;
    out.reserve(values.size());
    for (const double value : values) out.push_back(static_cast<float>(value));
    return out;
}

std::vector<double> numbers_of(const Table& t) {
    return {t.first_m[0],
            t.first_m[1],
            t.spacing_m[0],
            t.spacing_m[1],
            static_cast<double>(t.count[0]),
            static_cast<double>(t.count[1]),
            t.error,
            t.shape_error_m,
            static_cast<double>(t.checked)};
}

}  // namespace

std::uint64_t table_fingerprint(const Renderer& r, const TableOptions& options) {
    Digest digest;
    const bool pad = r.finger.contact == mechanics::FingerContact::pad;
    const double numbers[] = {kTableVersion,
                              static_cast<double>(r.finger.contact),
                              r.finger.diameter_m,
                              pad ? r.finger.pad.young_Pa : 0.0,
                              pad ? r.finger.pad.rise_Pa_per_N : 0.0,
                              pad ? r.finger.pad.poisson : 0.0,
                              r.force_limit_N / r.stiffness_scale,
                              options.spacing_m,
                              options.error,
                              options.shape_error_m,
                              options.most_MB,
                              static_cast<double>(r.observed.map.rows())};
    digest.hash ^= r.content;
    digest.add(numbers, std::size(numbers));
    digest.add(r.observed.points_m.data(), static_cast<std::size_t>(r.observed.points_m.size()));
    digest.add(r.observed.map.data(), static_cast<std::size_t>(r.observed.map.size()));
    return digest.hash;
}

bool restore_table(const std::filesystem::path& cache, std::uint64_t fingerprint, Table& table) {
    if (cache.empty()) return false;
    const auto arrays = files::read_cache(cache, fingerprint);
    if (!arrays || arrays->size() != 5 || (*arrays)[0].size() != 9) return false;
    const std::vector<double>& numbers = (*arrays)[0];
    Table t = table;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        t.first_m[axis] = numbers[axis];
        t.spacing_m[axis] = numbers[2 + axis];
        if (!(numbers[4 + axis] >= 4.0) || !(numbers[4 + axis] < 1e6) || !(t.spacing_m[axis] > 0.0)) return false;
        t.count[axis] = static_cast<int>(numbers[4 + axis]);
    }
    t.force_N = (*arrays)[1];
    const std::size_t n =
        static_cast<std::size_t>(t.count[0]) * static_cast<std::size_t>(t.count[1]) * t.force_N.size();
    if (n == 0 || (*arrays)[2].size() != n || (*arrays)[3].size() != n ||
        (*arrays)[4].size() != n * static_cast<std::size_t>(t.observed) || (t.linear && t.force_N.size() != 1))
        return false;
    t.depth_m = floats((*arrays)[2]);
    t.linearity = floats((*arrays)[3]);
    t.value_m = floats((*arrays)[4]);
    t.error = numbers[6];
    t.shape_error_m = numbers[7];
    t.checked = static_cast<int>(numbers[8]);
    t.good = true;
    t.from_cache = true;
    table = std::move(t);
    return true;
}

std::string store_table(const std::filesystem::path& cache, std::uint64_t fingerprint, const Table& t) {
    if (cache.empty()) return "";
    return files::write_cache(cache, fingerprint,
                              {numbers_of(t), t.force_N, doubles(t.depth_m), doubles(t.linearity), doubles(t.value_m)});
}

}  // namespace palpa::tactile
