// palpa part compare

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "app/commands/option_checks.h"
#include "app/commands/part.h"
#include "app/commands/part_design.h"
#include "figures/gnuplot.h"
#include "figures/part_figure.h"
#include "files/printable.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "parts/compare.h"
#include "parts/edit.h"

namespace palpa::app {
namespace {

struct CompareOptions {
    std::string a, b, load, figure;
    std::string method = "voxels";
    double cell_mm = 0.0;  // 0: the parts'
    double tolerance = 1e-3;
    bool json = false;
};

parts::Method method_named(const std::string& name) {
    for (const parts::Method method :
         {parts::Method::euler_bernoulli, parts::Method::timoshenko, parts::Method::factorised}) {
        if (name == parts::name_of(method)) return method;
    }
    return parts::Method::voxels;
}

files::Json number_if(const std::optional<double>& value) {
    return value ? files::number_or_null(*value) : files::Json(nullptr);
}

files::Json design_json(const parts::Part& part, const parts::ComparedDesign& design) {
    const parts::MethodResult& result = design.stiffness;
    return {{"part", part.file},
            {"name", part.name},
            {"stiffness_N_per_m", files::number_or_null(result.stiffness_N_per_m)},
            {"displacement_mm", files::number_or_null(1e3 * result.displacement_m)},
            {"applies", result.why_not.empty()},
            {"energy_error_percent", files::number_or_null(100.0 * result.energy_error)},
            {"converged", result.converged},
            {"mass_g", 1e3 * design.mass_kg},
            {"switch_force_N", number_if(design.switch_force_N)}};
}

bool apply(const parts::PartComparison& comparison) {
    return comparison.a.stiffness.why_not.empty() && comparison.b.stiffness.why_not.empty();
}

files::Json felt_json(const parts::PartComparison& comparison) {
    files::Json json{{"difference_percent", files::number_or_null(100.0 * comparison.difference)}};
    for (const parts::WeberFraction& weber : parts::kWeberFractions) {
        json["thresholds"].push_back(
            {{"weber_percent", 100.0 * weber.share},
             {"beyond", apply(comparison) ? files::Json(comparison.difference > weber.share) : files::Json(nullptr)},
             {"measured_with", weber.measured_with}});
    }
    return json;
}

void print_comparison(const parts::Part& a, const parts::Part& b, const parts::PartComparison& comparison) {
    std::printf("%s N at %s\n", files::short_number(comparison.force_N).c_str(),
                files::printable(comparison.load).c_str());
    for (const bool first : {true, false}) {
        const parts::ComparedDesign& design = first ? comparison.a : comparison.b;
        std::printf("  %s: %s N/m, %s mm, %s g%s%s\n", files::printable(first ? a.name : b.name).c_str(),
                    files::short_number(design.stiffness.stiffness_N_per_m).c_str(),
                    files::short_number(1e3 * design.stiffness.displacement_m).c_str(),
                    files::short_number(1e3 * design.mass_kg).c_str(),
                    design.stiffness.why_not.empty() ? "" : "; does not apply: ",
                    files::printable(design.stiffness.why_not).c_str());
    }
    std::printf("  the second is %s times as stiff, %s times as heavy",
                files::short_number(comparison.stiffness_ratio).c_str(),
                files::short_number(comparison.mass_ratio).c_str());
    if (comparison.switch_force_ratio)
        std::printf(", and switches at %s times the force",
                    files::short_number(*comparison.switch_force_ratio).c_str());
    std::printf("\n  compliances differ by %s %%\n", files::short_number(100.0 * comparison.difference).c_str());
    if (!apply(comparison)) {
        std::printf("    whether people tell them apart does not follow from a stiffness that does not apply\n");
        return;
    }
    for (const parts::WeberFraction& weber : parts::kWeberFractions) {
        std::printf("    %s the %s %% that people can just tell (%s)\n",
                    comparison.difference > weber.share ? "more than" : "within",
                    files::short_number(100.0 * weber.share).c_str(), weber.measured_with);
    }
}

figures::DesignLine line_of(const parts::Part& part, const parts::ComparedDesign& design) {
    return {part.name, design.stiffness.stiffness_N_per_m, design.mass_kg, design.stiffness.why_not.empty()};
}

// A button's spring and latch are keys of their file and no voxels; a bare cover has none.
void doubt_button(const parts::Part& part, parts::ComparedDesign& design) {
    if (!part.button || std::holds_alternative<std::monostate>(part.button->support)) return;
    std::string& why_not = design.stiffness.why_not;
    why_not = "the spring of its button is left out, of which `palpa part button` tells" +
              (why_not.empty() ? "" : "; " + why_not);
}

void compare(const CompareOptions& options) {
    if (!options.figure.empty()) {
        figures::check_figure(options.figure);
        for (const std::string& part : {options.a, options.b})
            files::check_output(options.figure, parts::files_of_part(part));
    }
    const parts::Part a = read_part_aloud(options.a), b = read_part_aloud(options.b);
    parts::StiffnessOptions how{{method_named(options.method)}, {}, options.tolerance};
    if (options.cell_mm > 0.0) how.cell_m = 1e-3 * options.cell_mm;
    parts::PartComparison comparison = parts::compare_parts(a, b, options.load, how);
    doubt_button(a, comparison.a);
    doubt_button(b, comparison.b);
    if (options.json) {
        files::Json json{{"load", comparison.load}, {"force_N", comparison.force_N}, {"method", options.method}};
        json["a"] = design_json(a, comparison.a);
        json["b"] = design_json(b, comparison.b);
        json["stiffness_ratio"] = files::number_or_null(comparison.stiffness_ratio);
        json["mass_ratio"] = files::number_or_null(comparison.mass_ratio);
        json["switch_force_ratio"] = number_if(comparison.switch_force_ratio);
        json["felt"] = felt_json(comparison);
        std::printf("%s", files::json_text(json).c_str());
    } else {
        print_comparison(a, b, comparison);
    }
    if (!options.figure.empty()) {
        std::vector<double> fractions;
        for (const parts::WeberFraction& weber : parts::kWeberFractions) fractions.push_back(weber.share);
        figures::plot_designs(line_of(a, comparison.a), line_of(b, comparison.b), comparison.force_N, fractions,
                              options.figure);
    }
    if (!comparison.a.stiffness.converged || !comparison.b.stiffness.converged)
        throw std::runtime_error("not converged");
}

}  // namespace

void add_part_compare(CLI::App& part) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* command =
        part.add_subcommand("compare", "Two designs side by side: stiffness, mass, and whether people feel it");
    command->add_option("A", options->a, "part JSON")->required();
    command->add_option("B", options->b, "part JSON")->required();
    command->add_option("--load", options->load, "name of a load that both have (default: the only one)");
    command->add_option("--method", options->method, "euler-bernoulli, timoshenko, voxels or factorised")
        ->check(one_of({"euler-bernoulli", "timoshenko", "voxels", "factorised"}))
        ->capture_default_str();
    command->add_option("--cell-mm", options->cell_mm, "edge of the cells, a whole number of voxels")
        ->check(CLI::Range(1e-4, 1e3));
    command->add_option("--tolerance", options->tolerance, "relative error of the energy at which voxels stops")
        ->check(CLI::Range(1e-14, 0.5))
        ->capture_default_str();
    command->add_option("-o,--output", options->figure, "also draw a figure: FILE.png, .svg or .pdf");
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->callback([options, command] {
        const bool iterates = options->method == "voxels";
        refuse_unused(*command, "--cell-mm", iterates || options->method == "factorised",
                      "--method voxels or factorised");
        refuse_unused(*command, "--tolerance", iterates, "--method voxels");
        compare(*options);
    });
}

}  // namespace palpa::app
