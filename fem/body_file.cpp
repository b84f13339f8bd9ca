#include "fem/body_file.h"

#include <algorithm>
#include <array>

#include "files/input_error.h"
#include "files/text.h"

namespace palpa::fem {
namespace {

using namespace mechanics;
using Eigen::Index;

// at 0.5 - 1e-10 a block sinks as much as at 0.4999999 to six digits, at 0.5 - 1e-12 only to five; a few units of
// round-off below 0.5 the matrix can no longer be factored (2026-11)
constexpr double kMostPoisson = 0.5 - 1e-10;

constexpr files::Bounds kModulus{1e-6, 1e15};  // softer than any gel, stiffer than diamond

Law read_law(files::JsonReader& json) {
    if (!json.has("law")) {
        for (const char* key : {"mu_Pa", "kappa_Pa"}) {
            if (json.has(key))
                json.fail("law", "nothing beside " + std::string(key), "one of the laws for large strains");
        }
        return Law::linear;
    }
    return static_cast<Law>(json.choice("law", {kLawNames[0], kLawNames[1], kLawNames[2], kLawNames[3], kLawNames[4]}));
}

// Returns the moduli at rest of a law for large strains.
Material read_large_material(files::JsonReader& json, Law law) {
    json.only({"law", "mu_Pa", "kappa_Pa"});
    LargeMaterial large{law, json.number("mu_Pa", kModulus), json.number("kappa_Pa", kModulus)};
    const Material material = at_rest(large);
    if (!(material.poisson <= kMostPoisson)) {
        json.fail("kappa_Pa", files::number_text(large.kappa_Pa),
                  "at most " + files::short_number(large.mu_Pa / (3.0 * (0.5 - kMostPoisson))) +
                      " with this mu_Pa (1e4 times mu_Pa stands for an incompressible tissue)");
    }
    // bulk moduli far below that leave nothing of 1 + Poisson's ratio but round-off
    constexpr double kLeastShare = 1e-6;
    if (large.kappa_Pa < kLeastShare * large.mu_Pa) {
        json.fail("kappa_Pa", files::number_text(large.kappa_Pa),
                  "at least " + files::short_number(kLeastShare * large.mu_Pa) + " with this mu_Pa");
    }
    return material;
}

Material read_material(files::JsonReader json, Law& law) {
    law = read_law(json);
    if (law != Law::linear) return read_large_material(json, law);
    json.only({"law", "young_Pa", "poisson"});
    Material material;
    material.young_Pa = json.number("young_Pa", kModulus);
    material.poisson = json.number("poisson", files::kAnyNumber);
    if (!(material.poisson > -1.0 && material.poisson <= kMostPoisson)) {
        json.fail("poisson", files::number_text(material.poisson),
                  "a number > -1 and < 0.5 by at least 1e-10 (0.4999 stands for an incompressible tissue)");
    }
    return material;
}

std::vector<Material> read_materials(files::JsonReader& json, BodyFile& out) {
    const files::Json& list = json.any("materials");
    if (!list.is_object() || list.empty()) {
        json.fail("materials", files::described(list),
                  "an object with at least one material: {\"gel\": {\"young_Pa\": 2500, \"poisson\": 0.45}}");
    }
    std::vector<Material> materials;
    for (const auto& item : list.items()) {
        out.materials.push_back(item.key());
        Law law = Law::linear;
        files::JsonReader entry(item.value(), json.file(), "materials." + item.key());
        materials.push_back(read_material(entry, law));
        out.laws.push_back(law);
        if ((law == Law::linear) != (out.laws.front() == Law::linear)) {
            entry.fail(
                "law", std::string(name_of(law)) + " beside " + std::string(name_of(out.laws.front())),
                "linear materials alone, or laws for large strains alone (corotational is the one next to linear)");
        }
    }
    return materials;
}

Eigen::Matrix3Xd centroids_m(const Mesh& mesh) {
    Eigen::Matrix3Xd out(3, mesh.cells.cols());
    for (Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        out.col(cell).setZero();
        for (Index k = 0; k < mesh.cells.rows(); ++k) out.col(cell) += mesh.nodes_m.col(mesh.cells(k, cell));
        out.col(cell) /= static_cast<double>(mesh.cells.rows());
    }
    return out;
}

Eigen::Vector3d vector_of(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

// Returns the cells of one region: those whose centre is inside, or those of its physical group.
std::vector<int> cells_of_region(files::JsonReader& entry, const CaseMesh& mesh, const Eigen::Matrix3Xd& centre_m) {
    if (entry.has("physical")) return cells_of_group(entry, mesh);
    std::vector<int> cells;
    const auto take_if = [&](auto&& inside) {
        for (Index cell = 0; cell < centre_m.cols(); ++cell) {
            if (inside(Eigen::Vector3d(centre_m.col(cell)))) cells.push_back(static_cast<int>(cell));
        }
    };
    if (entry.has("all")) {
        if (!entry.boolean("all", true)) entry.fail("all", "false", "true");
        take_if([](const Eigen::Vector3d&) { return true; });
    } else if (entry.has("sphere")) {
        files::JsonReader sphere = entry.object("sphere");
        sphere.only({"centre_mm", "radius_mm"});
        const Eigen::Vector3d middle = 1e-3 * vector_of(sphere.numbers("centre_mm", 3, files::kAnyNumber));
        const double radius_m = 1e-3 * sphere.number("radius_mm", files::kPositive);
        take_if([&](const Eigen::Vector3d& x) { return (x - middle).norm() <= radius_m; });
    } else {
        files::JsonReader box = entry.object("box");
        box.only({"min_mm", "max_mm"});
        const Eigen::Vector3d low = 1e-3 * vector_of(box.numbers("min_mm", 3, files::kAnyNumber));
        const Eigen::Vector3d high = 1e-3 * vector_of(box.numbers("max_mm", 3, files::kAnyNumber));
        if (!(low.array() < high.array()).all())
            box.fail("max_mm", "a corner that is not above min_mm", "max_mm > min_mm in x, y and z");
        take_if([&](const Eigen::Vector3d& x) {
            return (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
        });
    }
    return cells;
}

void read_regions(files::JsonReader& json, const std::vector<std::string>& materials, CaseMesh& mesh) {
    auto entries = json.objects("regions");
    if (entries.empty() && materials.size() == 1) return;  // a single material is everywhere
    mesh.mesh.region.setConstant(-1);
    const Eigen::Matrix3Xd centre_m = centroids_m(mesh.mesh);
    for (files::JsonReader& entry : entries) {
        entry.only({"all", "box", "sphere", "physical", "material"});
        const int kinds =
            int{entry.has("all")} + int{entry.has("box")} + int{entry.has("sphere")} + int{entry.has("physical")};
        if (kinds != 1) entry.fail("", std::to_string(kinds) + " shapes", "one of all, box, sphere, physical");
        const std::string name = entry.text("material");
        const auto it = std::find(materials.begin(), materials.end(), name);
        if (it == materials.end()) {
            std::string known;
            for (const auto& material : materials) known += (known.empty() ? "" : ", ") + material;
            entry.fail("material", files::shown(name), "one of the materials: " + known);
        }
        const std::vector<int> cells = cells_of_region(entry, mesh, centre_m);
        if (cells.empty())
            entry.fail("", "no cell whose centre is inside", "at least one (a finer mesh, a larger region)");
        for (const int cell : cells) mesh.mesh.region(cell) = static_cast<int>(it - materials.begin());
    }
    const auto bare = (mesh.mesh.region.array() < 0).count();
    if (bare > 0) {
        Index first = 0;
        while (mesh.mesh.region(first) >= 0) ++first;
        json.fail("regions",
                  std::to_string(bare) + " of " + std::to_string(mesh.mesh.region.size()) +
                      " cells without a material, the first is cell " +
                      std::to_string(number_of_cell(mesh.mesh, first)),
                  "a region for each: begin with {\"all\": true, \"material\": ...}");
    }
}

}  // namespace

BodyFile read_body(files::JsonReader& json, const std::filesystem::path& folder) {
    BodyFile out;
    const std::vector<Material> materials = read_materials(json, out);
    out.mesh = read_case_mesh(json, folder, out.element);
    for (std::size_t i = 0; i < out.laws.size(); ++i) {
        if (out.element != Element::hex8i || out.laws[i] == Law::linear || out.laws[i] == Law::corotational) continue;
        json.fail("element",
                  "'hex8i' with materials." + out.materials[i] + " of law " + std::string(name_of(out.laws[i])),
                  "the law corotational, or another element");
    }
    read_regions(json, out.materials, out.mesh);
    out.body = {out.mesh.mesh, materials_of_cells(out.mesh.mesh.region, materials)};
    return out;
}

std::vector<CaseSupport> read_supports(files::JsonReader& json, const CaseMesh& mesh, Supports& supports) {
    std::vector<CaseSupport> out;
    for (files::JsonReader& entry : json.objects("supports")) {
        entry.only({"face", "physical", "fix", "value_mm"});
        CaseSupport support;
        support.nodes = nodes_named(entry, mesh, support.name);
        support.axes = entry.text("fix");
        std::string sorted = support.axes;
        std::sort(sorted.begin(), sorted.end());
        const bool once = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
        if (sorted.empty() || !once || sorted.find_first_not_of("xyz") != std::string::npos) {
            entry.fail("fix", files::shown(support.axes), "some of x, y and z, each once: \"xyz\", \"z\"");
        }
        support.value_m = 1e-3 * entry.number("value_mm", files::kAnyNumber, 0.0);
        fix(support.nodes, support.axes, support.value_m, supports);
        out.push_back(std::move(support));
    }
    const std::string held = "supports that hold every part, each displacement given once";
    with_key(json.file(), "supports", held, [&] {
        check_supported(mesh.mesh, supports);
        make_reduction(mesh.mesh, supports, {});
    });
    return out;
}

}  // namespace palpa::fem
