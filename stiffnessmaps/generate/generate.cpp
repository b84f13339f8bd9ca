#include "stiffnessmaps/generate/generate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "files/input_error.h"
#include "files/json.h"
#include "files/quantile.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "mechanics/error.h"
#include "stiffnessmaps/analytic.h"
#include "stiffnessmaps/generate/jobs.h"
#include "stiffnessmaps/generate/pieces.h"
#include "stiffnessmaps/generate/provenance.h"
#include "stiffnessmaps/grid.h"
#include "stiffnessmaps/map_file.h"

namespace palpa::stiffnessmaps {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kProbes = 50;
constexpr const char* kChecked = " Checked:";  // a check writes its result into `how` from here on
// How much coarser the meshes are from which the error is estimated: at a convergence order of 1.7, the difference
// between their map and this one equals this map's own error.
constexpr double kCoarser = 1.5;

fs::path without_slash(const fs::path& path) { return path.has_filename() ? path : path.parent_path(); }

fs::path pieces_folder(const fs::path& output, MeshSet meshes) {
    fs::path folder = without_slash(output);
    folder += meshes == MeshSet::refined ? ".check" : meshes == MeshSet::coarser ? ".estimate" : ".lines";
    return folder;
}

MapTask task_of(const GenerateOptions& options, MeshSet meshes) {
    const double times = meshes == MeshSet::refined ? 0.5 : meshes == MeshSet::coarser ? kCoarser : 1.0;
    return make_map_task(options.phantom, pieces_folder(options.output, meshes), options.coarseness * times);
}

// Joins the finished lines into a map. Throws std::runtime_error if some are missing.
Map joined(const MapTask& task) {
    const Phantom& p = task.phantom;
    Map map = map_of_phantom(p);
    const std::size_t n_depths = p.depths_m.size();
    const std::size_t n_cells = p.n_x * p.n_y;
    map.normal_N.resize(n_depths * n_cells);
    const auto gaps = missing(task, p.n_y, line_name);
    if (!gaps.empty()) {
        throw std::runtime_error(task.folder.string() + ": " + std::to_string(gaps.size()) + " of " +
                                 std::to_string(p.n_y) + " lines are not there yet (first: line " +
                                 std::to_string(gaps.front()) + ")");
    }
    const bool rough = is_rough(task);
    std::vector<std::vector<double>> energy_J(rough ? 0 : n_depths, std::vector<double>(n_cells));
    if (rough) {
        map.tangential = TangentialKind::recorded;  // as in a recording of a sliding tool, the arrays contain friction
        map.tangential_x_N.resize(n_depths * n_cells);
        map.tangential_y_N.resize(n_depths * n_cells);
    }
    const std::size_t per_cell = n_depths * (rough ? 3 : 2);
    for (std::size_t j = 0; j < p.n_y; ++j) {
        const Numbers numbers = *read_piece(task, line_name(j));
        for (std::size_t i = 0; i < p.n_x; ++i) {
            const double* at = &numbers[per_cell * i];
            for (std::size_t k = 0; k < n_depths; ++k) {
                const std::size_t cell = j * p.n_x + i;
                map.normal_N[k * n_cells + cell] = static_cast<float>(at[k]);
                if (rough) {
                    map.tangential_x_N[k * n_cells + cell] = static_cast<float>(at[n_depths + k]);
                    map.tangential_y_N[k * n_cells + cell] = static_cast<float>(at[2 * n_depths + k]);
                } else {
                    energy_J[k][cell] = at[n_depths + k];
                }
            }
        }
    }
    for (const std::vector<double>& layer : energy_J) {
        const Gradient slope = gradient(layer, {p.n_x, p.n_y, p.spacing_m[0], p.spacing_m[1]});
        for (const double f : slope.x) map.tangential_x_N.push_back(static_cast<float>(f));
        for (const double f : slope.y) map.tangential_y_N.push_back(static_cast<float>(f));
    }
    map.source.kind = SourceKind::simulated;
    map.source.how = how_made(task);
    map.source.from = p.name + ".json";
    map.source.licence = "made by Palpa";
    return map;
}

struct Differences {
    std::size_t points = 0;
    double largest = 0.0;
    double median = 0.0;
    double largest_tangential = 0.0;  // with friction: either array
};

files::Json convergence_json(const MapTask& task, const MapTask& refined, const Map& map, Differences& found) {
    const double greatest_N = force_range(map).highest_N;
    const mechanics::RollingTables tables = read_windows(refined);
    std::vector<double> differences;
    files::Json points = files::Json::array();
    const std::vector<Cell> cells = probe_cells(task.phantom, kProbes);
    found.points = cells.size();
    for (const Cell& cell : cells) {
        const std::vector<mechanics::RollingForce> reference = press_cell(refined, tables, cell);
        files::Json in_map = files::Json::array();
        files::Json refined_N = files::Json::array();
        for (std::size_t d = 0; d < map.n_depths(); ++d) {
            const std::size_t at = d * map.n_cells() + cell.j * map.n_x + cell.i;
            const auto force = static_cast<double>(map.normal_N[at]);
            in_map.push_back(force);
            refined_N.push_back(reference[d].normal_N);
            differences.push_back(std::abs(force - reference[d].normal_N) / greatest_N);
            if (!is_rough(task)) continue;
            const double off_x_N = std::abs(static_cast<double>(map.tangential_x_N[at]) - reference[d].tangential_x_N);
            const double off_y_N = std::abs(static_cast<double>(map.tangential_y_N[at]) - reference[d].tangential_y_N);
            found.largest_tangential = std::max({found.largest_tangential, off_x_N / greatest_N, off_y_N / greatest_N});
        }
        points.push_back({{"x_mm", 1e3 * map.x_of(cell.i)},
                          {"y_mm", 1e3 * map.y_of(cell.j)},
                          {"map_N", in_map},
                          {"refined_N", refined_N}});
    }
    found.largest = *std::max_element(differences.begin(), differences.end());
    found.median = files::median(std::move(differences));
    const auto mesh_json = [](const MapTask& t) {
        return files::Json{{"contact_spacing_mm", 1e3 * t.mesh.contact_m},
                           {"side_spacing_mm", {1e3 * t.mesh.surface_m[0], 1e3 * t.mesh.surface_m[1]}},
                           {"cells_across_nodule", t.mesh.cells_across}};
    };
    files::Json report{{"what", "normal force of the map against all its meshes refined once, at stated points"},
                       {"mesh", mesh_json(task)},
                       {"refined_mesh", mesh_json(refined)},
                       {"greatest_force_N", greatest_N},
                       {"max_difference", found.largest},
                       {"median_difference", found.median},
                       {"differences_are", "shares of the greatest force"},
                       {"depths_mm", map_json(map)["depths_mm"]},
                       {"points", points}};
    if (is_rough(task)) report["max_tangential_difference"] = found.largest_tangential;
    return report;
}

// Returns the sentence with which a new map states its own error.
std::string error_estimate(const GenerateOptions& options, const MapTask& task, const Map& map) {
    try {
        const MapTask coarser = task_of(options, MeshSet::coarser);
        constexpr double kAsFine =
            1.2;  // a cylinder shorter than the nodes' spacing has one row of nodes, and no fewer
        if (coarser.mesh.contact_m < kAsFine * task.mesh.contact_m)
            return " Error of the meshes: not estimated, there are no coarser ones under so short a tool.";
        compute_windows(options, coarser, MeshSet::coarser, "estimating");
        Differences found;
        convergence_json(task, coarser, map, found);
        std::string text = " Estimated error of the meshes: " + files::short_number(100.0 * found.largest) +
                           " % of the greatest force where it is largest, " +
                           files::short_number(100.0 * found.median) + " % in the median";
        if (is_rough(task))
            text += ", tangential force " + files::short_number(100.0 * found.largest_tangential) +
                    " % of it where it is largest";
        return text + " (" + std::to_string(found.points) + " points against meshes " + files::short_number(kCoarser) +
               " times coarser); up to twice that on meshes so coarse that a contact spans one or two cells, and up to "
               "three times over stiff nodules, whose surfaces are as ragged as their cells.";
    } catch (const files::InputError&) {
        return " Error of the meshes: not estimated, coarser ones cannot be made.";
    } catch (const mechanics::SolverError&) {
        return " Error of the meshes: not estimated, on coarser ones the contact does not settle.";
    }
}

void merge(const GenerateOptions& options, const MapTask& task) {
    Map map = joined(task);
    map.source.how += error_estimate(options, task, map);
    write_map(map, options.output);
    fs::remove_all(task.folder);
    fs::remove_all(pieces_folder(options.output, MeshSet::coarser));
    const ForceRange range = force_range(map);
    std::printf("%s: %zu x %zu cells, %zu depths, %s to %s N, by finite elements\n", options.output.c_str(), map.n_x,
                map.n_y, map.n_depths(), files::short_number(range.lowest_N).c_str(),
                files::short_number(range.highest_N).c_str());
}

// A check speaks of the phantom and of the meshes that the map was made with.
void refuse_other_maps(const GenerateOptions& options, const MapTask& task, const Map& map) {
    const std::string expected = "a map made from " + options.phantom.string();
    const auto refuse = [&](const char* found) {
        throw files::bad_input(options.output.string(), "", found, expected);
    };
    if (is_rough(task) && (map.tangential_x_N.empty() || map.tangential_y_N.empty())) refuse("no tangential arrays");
    Map made = map;
    std::erase_if(made.nodules, [](const Nodule& nodule) { return !nodule.placed; });
    const files::Json its = map_json(made);
    const files::Json wanted = map_json(map_of_phantom(task.phantom));
    const auto differs = [&](const char* key) {
        return its.value(key, files::Json()) != wanted.value(key, files::Json());
    };
    if (differs("origin_mm") || differs("spacing_mm") || differs("count") || differs("depths_mm"))
        refuse("another grid or other depths");
    if (differs("nodules")) refuse("other nodules");
    if (differs("indenter")) refuse("another indenter");
    if (map.source.how.rfind(how_made(task), 0) != 0)
        refuse("a map of another tissue, of other meshes (--coarseness) or not by finite elements");
}

void check(const GenerateOptions& options, const MapTask& task, const MapTask& refined) {
    Map map = read_map(options.output);
    refuse_other_maps(options, task, map);
    compute_windows(options, refined, MeshSet::refined, "checking");
    Differences differences;
    const files::Json report = convergence_json(task, refined, map, differences);
    files::write_text_atomically(without_slash(options.output) / "convergence.json", report.dump(1) + "\n");
    std::string found = std::to_string(differences.points) +
                        " points against meshes refined once: " + files::short_number(100.0 * differences.largest) +
                        " % of the greatest force at most, " + files::short_number(100.0 * differences.median) +
                        " % in the median";
    if (is_rough(task))
        found +=
            "; tangential force " + files::short_number(100.0 * differences.largest_tangential) + " % of it at most";
    const auto halved = [&](std::size_t c) { return refined.mesh.surface_m[c] < 0.6 * task.mesh.surface_m[c]; };
    if (!halved(0) || !halved(1))
        found += "; the mesh of what the block's sides change is not refined, it has its limit";
    map.source.how =
        map.source.how.substr(0, map.source.how.find(kChecked)) + kChecked + " " + found + " (convergence.json).";
    files::write_text_atomically(without_slash(options.output) / "map.json", files::json_text(map_json(map)));
    fs::remove_all(refined.folder);
    std::printf("%s: %s\n", options.output.c_str(), found.c_str());
}

int number_from_environment(const char* name) {
    const char* text = std::getenv(name);
    double value = 0.0;
    if (text == nullptr || !files::parse_number(text, value) || value < 0.0 || value > 1e6 ||
        value != std::floor(value)) {
        throw files::bad_input(name, "", text == nullptr ? "nothing" : files::shown(text),
                               "a whole number (or give --part i/n)");
    }
    return static_cast<int>(value);
}

void refuse_beyond_analytic(const Phantom& phantom, const fs::path& file) {
    if (phantom.indenter != IndenterShape::sphere) {
        throw files::bad_input(file.string(), "indenter.shape", "cylinder", "sphere with --method analytic");
    }
    if (!phantom.rolling && phantom.friction > 0.0) {
        throw files::bad_input(file.string(), "indenter.friction", files::short_number(phantom.friction),
                               "0 with --method analytic");
    }
}

}  // namespace

Part parse_part(const std::string& text) {
    const std::size_t slash = text.find('/');
    double index = 0.0;
    double count = 0.0;
    const bool good =
        slash != std::string::npos && files::parse_number(std::string_view(text).substr(0, slash), index) &&
        files::parse_number(std::string_view(text).substr(slash + 1), count) && index == std::floor(index) &&
        count == std::floor(count) && index >= 1.0 && index <= count && count <= 1e6;
    if (!good) throw files::bad_input("--part", "", files::shown(text), "i/n with 1 <= i <= n, such as 2/8");
    return {static_cast<int>(index), static_cast<int>(count)};
}

std::optional<Part> part_from_environment() {
    Part part;
    if (std::getenv("SLURM_ARRAY_TASK_ID") != nullptr) {
        part.index =
            number_from_environment("SLURM_ARRAY_TASK_ID") - number_from_environment("SLURM_ARRAY_TASK_MIN") + 1;
        part.count = number_from_environment("SLURM_ARRAY_TASK_COUNT");
    } else if (std::getenv("OMPI_COMM_WORLD_RANK") != nullptr) {
        part.index = number_from_environment("OMPI_COMM_WORLD_RANK") + 1;
        part.count = number_from_environment("OMPI_COMM_WORLD_SIZE");
    } else {
        return std::nullopt;
    }
    return parse_part(std::to_string(part.index) + "/" + std::to_string(part.count));
}

void generate_map(const GenerateOptions& options) {
    if (options.analytic) {
        const Phantom phantom = read_phantom(options.phantom);
        refuse_beyond_analytic(phantom, options.phantom);
        check_phantom(phantom, options.phantom);
        const Map map = analytic_map(phantom);
        write_map(map, options.output);
        std::printf("%s: %zu x %zu cells, %zu depths; analytic stand-in, not a simulation\n", options.output.c_str(),
                    map.n_x, map.n_y, map.n_depths());
        return;
    }
    const MapTask task = task_of(options, options.meshes);
    if (options.window && !(*options.window >= 0 && *options.window < window_count(task))) {
        throw files::bad_input("--window", "", std::to_string(*options.window),
                               "0 to " + std::to_string(window_count(task) - 1));
    }
    if (options.window) return compute_window(task, *options.window);
    if (!options.check || options.merge || !fs::exists(options.output)) {
        files::check_new(options.output);
        if (options.merge && !fs::exists(task.folder))
            throw files::bad_input(task.folder.string(), "", "nothing", "the pieces of the parts, before --merge");
        fs::create_directories(task.folder);
        if (options.part) return compute_part(task, *options.part);
        if (!options.merge) compute_with_jobs(options, task);
        merge(options, task);
    }
    if (options.check) check(options, task, task_of(options, MeshSet::refined));
}

}  // namespace palpa::stiffnessmaps
