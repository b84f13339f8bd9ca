#include "parts/button_file.h"

#include <cmath>

#include "files/cache.h"
#include "files/input_error.h"
#include "files/text.h"
#include "mechanics/error.h"

namespace palpa::parts {
namespace {

using namespace mechanics;

Point read_axis_direction(files::JsonReader& json, const char* key) {
    const auto choice = json.choice(key, {"x", "-x", "y", "-y", "z", "-z"});
    Point out{};
    out[choice / 2] = choice % 2 == 0 ? 1.0 : -1.0;
    return out;
}

ButtonCover read_cover(files::JsonReader json, const Part& part) {
    json.only({"radius_mm", "cap_radius_mm", "thickness_mm", "material", "spacings"});
    ButtonCover out;
    out.radius_m = 1e-3 * json.number("radius_mm", files::kPositive);
    out.cap_radius_m = 1e-3 * json.number("cap_radius_mm", files::kPositive);
    if (!(out.cap_radius_m < out.radius_m)) {
        json.fail("cap_radius_mm", files::number_text(1e3 * out.cap_radius_m),
                  "less than radius_mm: the cap must be smaller than the cover");
    }
    out.thickness_m = 1e-3 * json.number("thickness_mm", files::kPositive);
    out.spacings = json.integer("spacings", 4, 100, out.spacings);
    const std::string name = json.text("material");
    for (const PartMaterial& material : part.materials) {
        if (material.name != name) continue;
        out.young_Pa = material.elastic.young_Pa;
        out.density_kg_per_m3 = material.density_kg_per_m3;
    }
    if (!(out.young_Pa > 0.0)) json.fail("material", files::shown(name), "one of the part's materials");
    json.finish();
    return out;
}

TrussSupport read_truss(files::JsonReader json) {
    json.only({"bar_N_per_m", "half_span_mm", "rise_mm"});
    TrussSupport out;
    out.bar_N_per_m = json.number("bar_N_per_m", files::kPositive);
    out.half_span_m = 1e-3 * json.number("half_span_mm", files::kPositive);
    out.rise_m = 1e-3 * json.number("rise_mm", files::kPositive);
    json.finish();
    return out;
}

LatchSupport read_latch(files::JsonReader json) {
    json.only({"stiffness_N_per_m", "threshold_N"});
    LatchSupport out;
    out.stiffness_N_per_m = json.number("stiffness_N_per_m", files::kPositive);
    out.threshold_N = json.number("threshold_N", files::kPositive);
    json.finish();
    return out;
}

void read_support(files::JsonReader json, const Part& part, Button& button) {
    json.only({"truss", "latch", "curve"});
    const int kinds = json.has("truss") + json.has("latch") + json.has("curve");
    if (kinds != 1) json.fail("", std::to_string(kinds) + " supports", "one of truss, latch, curve");
    if (json.has("truss")) button.support = read_truss(json.object("truss"));
    if (json.has("latch")) button.support = read_latch(json.object("latch"));
    if (json.has("curve")) {
        const std::filesystem::path file = std::filesystem::path(part.file).parent_path() / json.text("curve");
        files::Table table = files::read_tsv(file);
        MeasuredSupport support = read_curve(table);
        if (!(support.travel_m.back() >= button.travel_m * (1.0 - 1e-9))) {
            json.fail("curve", "travels up to " + files::short_number(1e3 * support.travel_m.back()) + " mm",
                      "a curve to travel_mm = " + files::short_number(1e3 * button.travel_m));
        }
        button.support = std::move(support);
    }
    json.finish();
}

void read_gravity(files::JsonReader& json, const Point& direction, ButtonCover& cover) {
    constexpr double kStandard_m_per_s2 = 9.80665;
    const Point down = read_axis_direction(json, "gravity");
    double along = 0.0;
    for (std::size_t c = 0; c < 3; ++c) along += down[c] * direction[c];
    cover.gravity_m_per_s2 = {kStandard_m_per_s2 * std::sqrt(1.0 - along * along), 0.0, kStandard_m_per_s2 * along};
}

constexpr double kMostTravel = 2.0;

// The travel over which the button does what it does. The curve is a table of equal steps, which must resolve that.
double own_travel_m(const Button& button) {
    double out = 0.0;
    if (button.cover) out = button.cover->radius_m;
    if (const auto* truss = std::get_if<TrussSupport>(&button.support)) out = std::max(out, 2.0 * truss->rise_m);
    if (const auto* latch = std::get_if<LatchSupport>(&button.support))
        out = std::max(out, latch->threshold_N / latch->stiffness_N_per_m);
    if (const auto* curve = std::get_if<MeasuredSupport>(&button.support)) out = std::max(out, curve->travel_m.back());
    return out;
}

std::uint64_t fingerprint_of(const ButtonCover& c, double travel_m) {
    constexpr int kVersion = 1;  // of what the cache holds
    const Eigen::Vector3d& g = c.gravity_m_per_s2;
    return files::fingerprint_of({"cover", kVersion, c.radius_m, c.cap_radius_m, c.thickness_m, c.young_Pa,
                                  c.density_kg_per_m3, c.spacings, g.x(), g.y(), g.z(), travel_m});
}

CoverTable table_of_cover(const Button& button, const std::filesystem::path& cache, std::string& warning) {
    if (!button.cover) return {};
    const std::uint64_t key = fingerprint_of(*button.cover, button.travel_m);
    if (cache.empty()) return make_cover_table(*button.cover, button.travel_m);
    if (auto known = files::read_cache(cache, key)) {
        const files::CachedArrays& a = *known;
        if (a.size() == 3 && a[0].size() == 2 && a[1].size() == kCoverTravels && a[2].size() == kCoverTravels)
            return {a[0][0], a[1], a[2], static_cast<int>(a[0][1])};
    }
    CoverTable table = make_cover_table(*button.cover, button.travel_m);
    const std::string failed = files::write_cache(
        cache, key, {{table.step_m, static_cast<double>(table.iterations)}, table.force_N, table.slope_N_per_m});
    if (!failed.empty()) warning = failed;
    return table;
}

}  // namespace

Button read_button(files::JsonReader json, const Part& part) {
    json.only({"travel_mm", "direction", "gravity", "cover", "support", "on_mm", "off_mm"});
    Button out;
    out.travel_m = 1e-3 * json.number("travel_mm", files::kPositive);
    const Point direction = json.has("direction") ? read_axis_direction(json, "direction") : Point{0.0, 0.0, -1.0};
    if (auto cover = json.optional_object("cover")) out.cover = read_cover(*cover, part);
    if (auto support = json.optional_object("support")) read_support(*support, part, out);
    if (!out.cover && std::holds_alternative<std::monostate>(out.support))
        json.fail("", "neither cover nor support", "at least one of both");
    if (const double most_m = kMostTravel * own_travel_m(out); out.travel_m > most_m)
        json.fail("travel_mm", files::short_number(1e3 * out.travel_m),
                  "at most " + files::short_number(1e3 * most_m) +
                      ": twice the cover's radius, or what the support takes to snap");
    if (json.has("gravity")) {
        if (!out.cover) json.fail("gravity", "no cover that it acts on", "the key cover beside it");
        read_gravity(json, direction, *out.cover);
    }
    if (json.has("on_mm")) out.on_m = 1e-3 * json.number("on_mm", {0.0, 1e3 * out.travel_m, true});
    if (json.has("off_mm")) out.off_m = 1e-3 * json.number("off_mm", {0.0, 1e3 * out.travel_m, true});
    if (out.on_m && out.off_m && !(*out.off_m < *out.on_m)) {
        json.fail("off_mm", files::number_text(1e3 * *out.off_m),
                  "less than on_mm = " + files::number_text(1e3 * *out.on_m) + ": off before on");
    }
    if (out.on_m && std::holds_alternative<LatchSupport>(out.support))
        json.fail("on_mm", "a travel beside a latch", "none: a latch goes on at its threshold_N");
    json.finish();
    return out;
}

MeasuredSupport read_curve(files::Table& table) {
    constexpr std::size_t kMostRows = 100000;
    const std::size_t travel = table.column("travel_mm"), press = table.column("press_N"),
                      release = table.column("release_N");
    MeasuredSupport out;
    while (table.next()) {
        const double travel_m = 1e-3 * table.finite_number(travel);
        if (out.travel_m.empty() && travel_m != 0.0) table.fail(travel, "0 in the first row");
        if (!out.travel_m.empty() && !(travel_m > out.travel_m.back()))
            table.fail(travel, "a travel above that of the row before");
        if (out.travel_m.size() >= kMostRows) table.fail(travel, "at most 100000 rows");
        out.travel_m.push_back(travel_m);
        out.press_N.push_back(table.finite_number(press));
        out.release_N.push_back(table.finite_number(release));
        if (!(out.release_N.back() <= out.press_N.back()))
            table.fail(release, "at most press_N: a cycle would make energy");
    }
    if (out.travel_m.size() < 2) {
        throw files::InputError(table.file() + ": " + std::to_string(out.travel_m.size()) +
                                " rows; expected at least 2, from a travel of 0 on");
    }
    return out;
}

ButtonCurve button_curve(const Part& part) {
    std::string none;
    return button_curve(part, {}, none);
}

ButtonCurve button_curve(const Part& part, const std::filesystem::path& cache, std::string& warning) {
    if (!part.button) throw files::bad_input(part.file, "button", "no button", "the key button");
    try {
        return press_button(*part.button, table_of_cover(*part.button, cache, warning));
    } catch (const MechanicsError& error) {
        throw files::bad_input(part.file, "button", error.what(), "a button that can be pressed (docs/parts.md)");
    }
}

}  // namespace palpa::parts
