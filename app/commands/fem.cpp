// palpa fem solve

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

#include "app/commands/command_line.h"
#include "fem/locking.h"
#include "fem/solve.h"
#include "files/input_error.h"
#include "files/printable.h"
#include "files/progress_line.h"
#include "files/regular_file.h"
#include "files/text.h"

namespace palpa::app {
namespace {

using mechanics::LinearRange;

const char* range_name(LinearRange range) {
    switch (range) {
        case LinearRange::fine:
            return "green";
        case LinearRange::amber:
            return "amber";
        case LinearRange::red:
            return "red";
    }
    return "";
}

// The law of the materials, or the laws, each once.
std::string law_names(const fem::FemCase& model) {
    std::string out;
    for (std::size_t i = 0; i < model.laws.size(); ++i) {
        if (std::find(model.laws.begin(), model.laws.begin() + static_cast<std::ptrdiff_t>(i), model.laws[i]) !=
            model.laws.begin() + static_cast<std::ptrdiff_t>(i))
            continue;
        out += (out.empty() ? "" : ", ") + std::string(mechanics::name_of(model.laws[i]));
    }
    return out;
}

files::Json in_mm(const std::optional<double>& value_m) {
    return value_m ? files::Json(1e3 * *value_m) : files::Json(nullptr);
}

double max_von_mises_Pa(const fem::FemResult& result) {
    double largest = 0.0;
    for (const double value : result.von_mises_Pa) largest = std::max(largest, value);  // NaN leaves it as it is
    return largest;
}

std::vector<std::string> warnings_of(const fem::FemCase& model, const fem::FemResult& result) {
    std::vector<std::string> out = model.warnings;
    if (const std::string locking = fem::locking_warning(model.problem); !locking.empty()) out.push_back(locking);
    if (const std::string bending = fem::bending_warning(model); !bending.empty()) out.push_back(bending);
    if (result.linear != LinearRange::fine) {
        out.push_back("the linear range is left: " + files::short_number(100.0 * result.linear_ratio) +
                      " % (strain, rotation, or depth over thickness or width); amber above 10, red above 25");
    }
    if (result.partial)
        out.push_back("part of the pressure is beside the body: " + files::short_number(result.applied_N) +
                      " N fell on it");
    if (result.contact && result.contact->over_edge) out.push_back("part of the indenter is beside the tissue");
    if (result.contact) {
        for (std::string& warning : fem::contact_warnings(*result.contact)) out.push_back(std::move(warning));
    }
    if (result.large && !result.converged) {
        out.push_back("stopped at " + files::short_number(100.0 * result.large->load_share) +
                      " % of loads and prescribed displacements, to which all results belong: no equilibrium was found "
                      "beyond it");
    }
    if (result.large && result.large->load_share > 0.0 && !result.large->stable)
        out.push_back("the equilibrium is not stable: the body would buckle; a small load across shows where to");
    if (!result.large && !(result.solution.backward_error < fem::kMostBackwardError))
        out.push_back("not converged: backward error " + files::short_number(result.solution.backward_error));
    if (!model.report.slivers.empty()) {
        out.push_back(std::to_string(model.report.slivers.size()) + " flat cells, the worst is cell " +
                      std::to_string(number_of_cell(model.problem.mesh, model.report.worst_cell)));
    }
    return out;
}

files::Json newton_json(const mechanics::LargeSolution& large) {
    return {{"load_share", large.load_share},
            {"stable", large.stable},
            {"load_steps", large.load_steps},
            {"iterations", large.iterations},
            {"halvings", large.halvings},
            {"repairs", large.repairs},
            {"solver", mechanics::name_of(large.solver)}};
}

files::Json json_of(const fem::FemCase& model, const fem::FemResult& result) {
    files::Json json;
    json["case"] = model.file;
    json["element"] = mechanics::name_of(model.problem.element);
    json["law"] = law_names(model);
    json["nodes"] = model.problem.mesh.nodes_m.cols();
    json["elements"] = model.problem.mesh.cells.cols();
    json["dofs"] = result.equations;
    json["max_displacement_mm"] = 1e3 * result.max_displacement_m;
    json["centre_displacement_mm"] = in_mm(result.centre_m);
    json["d_skel_mm"] = in_mm(result.skel_m);
    json["applied_N"] = result.applied_N;
    json["reaction_N"] = files::Json::array();
    for (std::size_t i = 0; i < model.supports.size(); ++i) {
        const Eigen::Vector3d& f = result.reaction_N[i];
        json["reaction_N"].push_back(
            {{"support", model.supports[i].name}, {"fix", model.supports[i].axes}, {"force_N", {f.x(), f.y(), f.z()}}});
    }
    if (!result.body_reaction_N.isZero(0.0)) {
        const Eigen::Vector3d& f = result.body_reaction_N;
        json["reaction_of_held_rigid_cells_N"] = {f.x(), f.y(), f.z()};
    }
    if (result.contact) {
        const fem::IndenterContact& contact = *result.contact;
        const Eigen::Vector3d f = contact.force_N.rowwise().sum();
        json["contact"] = {{"force_N", {f.x(), f.y(), f.z()}},
                           {"area_mm2", 1e6 * contact.area_m2},
                           {"nodes", contact.nodes},
                           {"cells_across_radius", contact.cells_across_radius},
                           {"cells_under_radius", contact.cells_under_radius},
                           {"depth_mm", 1e3 * contact.depth_m},
                           {"lateral_N", {contact.lateral_N[0], contact.lateral_N[1]}},
                           {"compliance_columns", contact.columns}};
        if (contact.cells_along_length) json["contact"]["cells_along_length"] = *contact.cells_along_length;
    }
    json["energy_J"] = result.solution.energy_J;
    json["max_strain"] = result.max_strain;
    json["max_von_mises_Pa"] = max_von_mises_Pa(result);
    json["max_rotation_deg"] = 180.0 / std::numbers::pi * result.max_rotation_rad;
    json["linear_range"] = {{"gauge", range_name(result.linear)}, {"ratio", result.linear_ratio}};
    json["residual"] = result.residual;
    json["backward_error"] = result.solution.backward_error;
    if (result.large) {
        json["max_rotation_deg"] = nullptr;
        json["linear_range"] = nullptr;
        json["backward_error"] = nullptr;
        json["newton"] = newton_json(*result.large);
    }
    json["converged"] = result.converged;
    json["time_s"] = {{"assemble", result.assemble_s}, {"factor", result.factor_s}, {"solve", result.solution.solve_s}};
    if (result.contact) json["time_s"]["contact"] = result.contact->seconds;
    json["warnings"] = warnings_of(model, result);
    return json;
}

std::string six_digits(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

std::string three_N(const Eigen::Vector3d& f) {
    return files::short_number(f.x()) + "  " + files::short_number(f.y()) + "  " + files::short_number(f.z()) + " N";
}

void row(const char* what, const std::string& value) {
    std::printf("  %-22s %s\n", files::printable(what).c_str(), value.c_str());
}

void print_table(const fem::FemCase& model, const fem::FemResult& result) {
    const auto mm = [](const std::optional<double>& value_m) {
        return value_m ? six_digits(1e3 * *value_m) + " mm" : std::string("-");
    };
    std::printf("%s: %s, %s, %td nodes, %td elements, %d equations\n", files::printable(model.file).c_str(),
                law_names(model).c_str(), mechanics::name_of(model.problem.element), model.problem.mesh.nodes_m.cols(),
                model.problem.mesh.cells.cols(), result.equations);
    row("applied", files::short_number(result.applied_N) + " N");
    row("centre displacement", mm(result.centre_m));
    row("d_skel (mean)", mm(result.skel_m));
    row("max displacement", mm(result.max_displacement_m));
    for (std::size_t i = 0; i < model.supports.size(); ++i) {
        row(("reaction " + model.supports[i].name).c_str(), three_N(result.reaction_N[i]));
    }
    if (!result.body_reaction_N.isZero(0.0)) row("reaction, held rigid", three_N(result.body_reaction_N));
    if (result.contact) {
        const fem::IndenterContact& contact = *result.contact;
        row("contact force", three_N(contact.force_N.rowwise().sum()));
        row("contact area", files::short_number(1e6 * contact.area_m2) + " mm2 on " + std::to_string(contact.nodes) +
                                " nodes, " + files::short_number(1e3 * contact.depth_m) + " mm deep");
    }
    row("energy", files::short_number(result.solution.energy_J) + " J");
    row("largest strain", files::short_number(100.0 * result.max_strain) + " %, von Mises " +
                              files::short_number(max_von_mises_Pa(result)) + " Pa");
    if (result.large) {
        const mechanics::LargeSolution& large = *result.large;
        row("Newton", std::to_string(large.iterations) + " iterations, " + std::to_string(large.load_steps) +
                          " load steps, " + std::to_string(large.repairs) + " repairs, " +
                          mechanics::name_of(large.solver) + (large.stable ? ", stable" : ", NOT stable"));
        row("residual", files::short_number(result.residual) + (result.converged ? ", converged" : ", NOT converged"));
    } else {
        row("linear range",
            std::string(range_name(result.linear)) + ", " + files::short_number(100.0 * result.linear_ratio) + " %");
        row("residual", files::short_number(result.residual) + ", backward error " +
                            files::short_number(result.solution.backward_error) +
                            (result.converged ? ", converged" : ", NOT converged"));
    }
    std::string times = "assemble " + files::short_number(result.assemble_s) + ", factor " +
                        files::short_number(result.factor_s) + ", solve " +
                        files::short_number(result.solution.solve_s);
    if (result.contact) times += ", contact " + files::short_number(result.contact->seconds);
    row("time", times + " s");
}

fem::FemResult solve_with_progress(const fem::FemCase& model) {
    files::ProgressLine line;
    return fem::solve_case(model, [&](const char* what, int done, int total) {
        line.show(what, total > 0 ? static_cast<double>(done) / total : std::nan(""));
    });
}

struct SolveOptions {
    std::string file;
    std::string output;
    bool json = false;
};

void solve_file(const SolveOptions& options) {
    const fem::FemCase model = fem::read_case(options.file);
    if (!options.output.empty())
        files::check_output(options.output, {options.file, model.mesh_file});  // checked before the long computation
    const fem::FemResult result = solve_with_progress(model);
    if (!options.output.empty()) files::write_vtu(options.output, fem::vtu_of(model, result));
    if (options.json) {
        std::printf("%s", files::json_text(json_of(model, result)).c_str());
    } else {
        print_table(model, result);
    }
    for (const std::string& warning : warnings_of(model, result)) {
        std::fprintf(stderr, "palpa: %s\n", files::printable(options.file + ": " + warning).c_str());
    }
    if (!result.converged) throw std::runtime_error(options.file + ": not converged");
}

}  // namespace

void add_fem(CLI::App& app) {
    CLI::App* fem = app.add_subcommand("fem", "Finite elements: solve");
    fem->require_subcommand(1);
    auto options = std::make_shared<SolveOptions>();
    CLI::App* command =
        fem->add_subcommand("solve", "Compute the displacements, forces and strains of a case file (docs/fem.md)");
    command->add_option("CASE", options->file, "case JSON")->required();
    command->add_option("-o,--output", options->output,
                        "write a VTU file with displacement, reaction, strain and stress");
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->callback([options] { solve_file(*options); });
}

}  // namespace palpa::app
