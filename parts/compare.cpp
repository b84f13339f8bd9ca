#include "parts/compare.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "files/input_error.h"
#include "files/text.h"
#include "parts/button_file.h"
#include "parts/info.h"

namespace palpa::parts {
namespace {

constexpr double kSameWay = 0.9999;  // cosine of the angle between two loads that are the same

const PartLoad* load_of(const Part& part, const std::string& name) {
    for (const PartLoad& load : part.loads) {
        if (load.name == name) return &load;
    }
    return nullptr;
}

std::string common_loads(const Part& a, const Part& b, int& n) {
    std::string out;
    n = 0;
    for (const PartLoad& load : a.loads) {
        if (load_of(b, load.name) == nullptr) continue;
        out += (out.empty() ? "" : ", ") + load.name;
        ++n;
    }
    return out;
}

std::string chosen_load(const Part& a, const Part& b, const std::string& name) {
    int n = 0;
    const std::string common = common_loads(a, b, n);
    if (n == 0) throw files::bad_input(b.file, "loads", "no load of a name that " + a.file + " has too", "one");
    if (name.empty() && n == 1) return common;
    if (!name.empty() && load_of(a, name) != nullptr && load_of(b, name) != nullptr) return name;
    throw files::bad_input(b.file, "--load", name.empty() ? "several loads" : files::shown(name), "one of " + common);
}

ComparedDesign design_of(const Part& part, const PartLoad& load, const StiffnessOptions& options) {
    ComparedDesign out;
    out.stiffness = stiffness_of(part, load, options).at(0);
    if (!out.stiffness.answered) {
        throw files::bad_input(part.file, name_of(out.stiffness.method), "no answer: " + out.stiffness.why_not,
                               "a load and a method that have one");
    }
    out.mass_kg = info_of(part).mass_kg;
    if (part.button) {
        const mechanics::ButtonCurve curve = button_curve(part);
        if (curve.snaps) out.switch_force_N = curve.peak_N;
    }
    return out;
}

}  // namespace

PartComparison compare_parts(const Part& a, const Part& b, const std::string& load, const StiffnessOptions& options) {
    PartComparison out;
    out.load = chosen_load(a, b, load);
    const PartLoad &of_a = *load_of(a, out.load), &of_b = *load_of(b, out.load);
    out.force_N = of_a.force_N;
    if (of_b.force_N != of_a.force_N) {
        throw files::bad_input(b.file, "loads." + out.load + ".force_N", files::number_text(of_b.force_N),
                               files::number_text(of_a.force_N) + ", as in " + a.file);
    }
    const mechanics::Point &way_a = of_a.direction, &way_b = of_b.direction;
    if (std::abs(std::inner_product(way_a.begin(), way_a.end(), way_b.begin(), 0.0)) < kSameWay) {
        const auto text = [](const mechanics::Point& way) {
            return "(" + files::short_number(way[0]) + ", " + files::short_number(way[1]) + ", " +
                   files::short_number(way[2]) + ")";
        };
        throw files::bad_input(b.file, "loads." + out.load + ".direction", text(way_b),
                               text(way_a) + " or against it, as in " + a.file);
    }
    out.a = design_of(a, of_a, options);
    out.b = design_of(b, of_b, options);
    out.stiffness_ratio = out.b.stiffness.stiffness_N_per_m / out.a.stiffness.stiffness_N_per_m;
    out.mass_ratio = out.b.mass_kg / out.a.mass_kg;
    out.difference = std::max(out.stiffness_ratio, 1.0 / out.stiffness_ratio) - 1.0;
    if (out.a.switch_force_N && out.b.switch_force_N)
        out.switch_force_ratio = *out.b.switch_force_N / *out.a.switch_force_N;
    return out;
}

}  // namespace palpa::parts
