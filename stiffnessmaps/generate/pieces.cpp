#include "stiffnessmaps/generate/pieces.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "files/input_error.h"
#include "files/text.h"
#include "mechanics/error.h"
#include "stiffnessmaps/generate/cost.h"
#include "stiffnessmaps/map_file.h"

namespace palpa::stiffnessmaps {
namespace {

constexpr std::uint64_t kVersion = 3;  // of the format, and of the way the numbers are computed
constexpr char kMagic[8] = {'p', 'a', 'l', 'p', 'a', 'n', 'u', 'm'};

struct Fnv {
    std::uint64_t hash = 14695981039346656037ull;
    void add(const void* data, std::size_t bytes) {
        const auto* byte = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < bytes; ++i) hash = (hash ^ byte[i]) * 1099511628211ull;
    }
    void add(double value) { add(&value, sizeof value); }
    void add(const std::vector<double>& values) {
        for (const double value : values) add(value);
    }
};

std::uint64_t fingerprint_of(const MapTask& task) {
    Fnv fnv;
    const mechanics::RollingModel& m = task.model;
    const mechanics::RollingMesh& q = task.mesh;
    const Phantom& p = task.phantom;
    fnv.add(&kVersion, sizeof kVersion);
    fnv.add({m.size_m[0], m.size_m[1], m.size_m[2], m.tissue.young_Pa, m.tissue.poisson, m.radius_m, m.length_m,
             m.friction, m.shape == mechanics::IndenterShape::cylinder ? 1.0 : 0.0});
    for (const mechanics::Inclusion& i : m.inclusions) {
        fnv.add({i.sphere.centre_m[0], i.sphere.centre_m[1], i.sphere.centre_m[2], i.sphere.radius_m,
                 i.material.young_Pa, i.material.poisson});
    }
    fnv.add({q.contact_m, q.surface_m[0], q.surface_m[1], q.cells_across, q.reach_m});
    fnv.add(p.depths_m);
    fnv.add({p.origin_m[0], p.origin_m[1], p.spacing_m[0], p.spacing_m[1], static_cast<double>(p.n_x),
             static_cast<double>(p.n_y)});
    return fnv.hash;
}

void write_piece(const MapTask& task, const std::string& name, const Numbers& numbers) {
    std::string bytes(kMagic, sizeof kMagic);
    const auto append = [&](const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); };
    const std::uint64_t count = numbers.size();
    append(&task.fingerprint, sizeof task.fingerprint);
    append(&count, sizeof count);
    append(numbers.data(), count * sizeof(double));
    Fnv fnv;
    fnv.add(name.data(), name.size());
    fnv.add(bytes.data(), bytes.size());
    append(&fnv.hash, sizeof fnv.hash);
    files::write_text_atomically(task.folder / name, bytes);
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& key, const std::string& found,
                         const std::string& expected) {
    throw files::bad_input(file.string(), key, found, expected);
}

void append(const std::vector<double>& list, Numbers& out) { out.insert(out.end(), list.begin(), list.end()); }

// Reads the table's lists from `first` to the end of `numbers`: one list, or with friction three of the same length.
template <class Table>
void take_lists(const MapTask& task, const Numbers& numbers, std::ptrdiff_t first, Table& table) {
    const std::ptrdiff_t n = (static_cast<std::ptrdiff_t>(numbers.size()) - first) / (is_rough(task) ? 3 : 1);
    const auto at = numbers.begin() + first;
    table.value.assign(at, at + n);
    if (!is_rough(task)) return;
    table.along_x.assign(at + n, at + 2 * n);
    table.along_y.assign(at + 2 * n, at + 3 * n);
}

Numbers numbers_of(const mechanics::PairTable& table) {
    Numbers out{static_cast<double>(table.x_m.size()), static_cast<double>(table.y_m.size()),
                static_cast<double>(table.reach_x), static_cast<double>(table.reach_y)};
    for (const auto* list : {&table.x_m, &table.y_m, &table.value, &table.along_x, &table.along_y}) append(*list, out);
    return out;
}

mechanics::PairTable pair_table_of(const MapTask& task, const Numbers& numbers) {
    mechanics::PairTable table;
    const auto n_x = static_cast<std::ptrdiff_t>(numbers[0]);
    const auto n_y = static_cast<std::ptrdiff_t>(numbers[1]);
    table.reach_x = static_cast<int>(numbers[2]);
    table.reach_y = static_cast<int>(numbers[3]);
    const auto lines = numbers.begin() + 4;
    table.x_m.assign(lines, lines + n_x);
    table.y_m.assign(lines + n_x, lines + n_x + n_y);
    take_lists(task, numbers, 4 + n_x + n_y, table);
    return table;
}

Numbers numbers_of(const mechanics::LayerKernel& kernel) {
    Numbers out{kernel.spacing_m[0], kernel.spacing_m[1], static_cast<double>(kernel.n_x),
                static_cast<double>(kernel.n_y)};
    for (const auto* list : {&kernel.value, &kernel.along_x, &kernel.along_y}) append(*list, out);
    return out;
}

mechanics::LayerKernel layer_kernel_of(const MapTask& task, const Numbers& numbers) {
    mechanics::LayerKernel kernel;
    kernel.spacing_m = {numbers[0], numbers[1]};
    kernel.n_x = static_cast<int>(numbers[2]);
    kernel.n_y = static_cast<int>(numbers[3]);
    take_lists(task, numbers, 4, kernel);
    return kernel;
}

}  // namespace

void check_phantom(const Phantom& phantom, const std::filesystem::path& file) {
    // a map that could not be written is refused before it is computed
    check_map(map_of_phantom(phantom), file.string());
    if (phantom.depths_m.back() >= phantom.size_m[2]) {
        refuse(file, "depths_mm", files::short_number(1e3 * phantom.depths_m.back()),
               "depths less than the thickness, " + files::short_number(1e3 * phantom.size_m[2]) + " mm");
    }
    for (int c = 0; c < 2; ++c) {
        const auto n = c == 0 ? phantom.n_x : phantom.n_y;
        const double first_m = phantom.origin_m[c];
        const double last_m = first_m + phantom.spacing_m[c] * static_cast<double>(n - 1);
        const double slack_m = 0.5 * phantom.indenter_radius_m;  // how far the indenter may extend beyond a side
        if (first_m >= -slack_m && last_m <= phantom.size_m[c] + slack_m) continue;
        refuse(file, "grid",
               std::string(c == 0 ? "x " : "y ") + files::short_number(1e3 * first_m) + " to " +
                   files::short_number(1e3 * last_m) + " mm",
               "an indenter on the tissue, 0 to " + files::short_number(1e3 * phantom.size_m[c]) + " mm");
    }
}

MapTask make_map_task(const std::filesystem::path& phantom_file, const std::filesystem::path& folder,
                      double coarseness) {
    MapTask task;
    task.phantom = read_phantom(phantom_file);
    task.folder = folder;
    const Phantom& phantom = task.phantom;
    check_phantom(phantom, phantom_file);
    mechanics::RollingModel& model = task.model;
    std::copy_n(phantom.size_m, 3, model.size_m.begin());
    model.tissue = {phantom.tissue.young_Pa, phantom.tissue.poisson};
    for (const PhantomNodule& nodule : phantom.nodules) {
        mechanics::Inclusion inclusion;
        inclusion.sphere.centre_m = {nodule.centre_m[0], nodule.centre_m[1], phantom.size_m[2] - nodule.centre_m[2]};
        inclusion.sphere.radius_m = 0.5 * nodule.diameter_m;
        inclusion.material = {nodule.material.young_Pa, nodule.material.poisson};
        model.inclusions.push_back(inclusion);
    }
    if (phantom.indenter == IndenterShape::cylinder) model.shape = mechanics::IndenterShape::cylinder;
    model.radius_m = phantom.indenter_radius_m;
    model.length_m = phantom.indenter_length_m;
    model.friction = phantom.rolling ? 0.0 : phantom.friction;
    model.least_depth_m = phantom.depths_m.front();
    model.greatest_depth_m = phantom.depths_m.back();
    try {
        task.mesh = mechanics::choose_rolling_mesh(model, coarseness);
    } catch (const mechanics::MechanicsError& error) {
        throw files::InputError(phantom_file.string() + ": " + error.what());
    }
    task.groups = mechanics::inclusion_groups(model, task.mesh);
    check_cost(task, coarseness, phantom_file.string());
    task.fingerprint = fingerprint_of(task);
    return task;
}

std::string window_name(int window) { return "window-" + std::to_string(window); }
std::string line_name(std::size_t line) { return "line-" + std::to_string(line); }

std::optional<Numbers> read_piece(const MapTask& task, const std::string& name) {
    const std::filesystem::path file = task.folder / name;
    if (!std::filesystem::exists(file)) return std::nullopt;
    const std::string bytes = files::read_text(file);
    constexpr std::size_t kHead = sizeof kMagic + 2 * sizeof(std::uint64_t);
    std::uint64_t fingerprint = 0;
    std::uint64_t count = 0;
    std::uint64_t sum = 0;
    bool whole = bytes.size() >= kHead + sizeof sum && std::memcmp(bytes.data(), kMagic, sizeof kMagic) == 0;
    if (whole) {
        std::memcpy(&fingerprint, bytes.data() + sizeof kMagic, sizeof fingerprint);
        std::memcpy(&count, bytes.data() + sizeof kMagic + sizeof fingerprint, sizeof count);
        std::memcpy(&sum, bytes.data() + bytes.size() - sizeof sum, sizeof sum);
        Fnv fnv;
        fnv.add(name.data(), name.size());
        fnv.add(bytes.data(), bytes.size() - sizeof sum);
        whole = sum == fnv.hash && count == (bytes.size() - kHead - sizeof sum) / sizeof(double);
    }
    if (!whole || fingerprint != task.fingerprint) {
        std::fprintf(stderr, "palpa: %s: %s, taken as missing\n", file.c_str(),
                     whole ? "of another phantom or mesh" : "damaged");
        return std::nullopt;
    }
    Numbers numbers(count);
    std::memcpy(numbers.data(), bytes.data() + kHead, count * sizeof(double));
    return numbers;
}

void compute_window(const MapTask& task, int window) {
    const int last = window_count(task) - 1;
    if (window == last) {
        write_piece(task, window_name(window), numbers_of(mechanics::contact_kernel(task.model, task.mesh)));
    } else if (window == 0) {
        write_piece(task, window_name(window), numbers_of(mechanics::side_table(task.model, task.mesh)));
    } else {
        const auto& group = task.groups[static_cast<std::size_t>(window - 1)];
        write_piece(task, window_name(window), numbers_of(mechanics::inclusion_table(task.model, task.mesh, group)));
    }
}

mechanics::RollingTables read_windows(const MapTask& task) {
    mechanics::RollingTables tables;
    for (int window = 0; window < window_count(task); ++window) {
        const auto numbers = read_piece(task, window_name(window));
        if (!numbers) throw std::runtime_error((task.folder / window_name(window)).string() + ": not there");
        if (window == window_count(task) - 1) {
            tables.contact = layer_kernel_of(task, *numbers);
        } else {
            tables.parts.push_back(pair_table_of(task, *numbers));
        }
    }
    return tables;
}

void compute_line(const MapTask& task, const mechanics::RollingTables& tables, std::size_t line) {
    const Phantom& p = task.phantom;
    mechanics::RollingWork work;
    std::vector<mechanics::RollingForce> forces;
    Numbers numbers;
    const double y_m = p.origin_m[1] + p.spacing_m[1] * static_cast<double>(line);
    for (std::size_t i = 0; i < p.n_x; ++i) {
        const double x_m = p.origin_m[0] + p.spacing_m[0] * static_cast<double>(i);
        mechanics::roll_to(task.model, task.mesh, tables, x_m, y_m, p.depths_m, work, forces);
        for (const auto& force : forces) numbers.push_back(force.normal_N);
        if (!is_rough(task)) {
            for (const auto& force : forces) numbers.push_back(force.energy_J);
            continue;
        }
        for (const auto& force : forces) numbers.push_back(force.tangential_x_N);
        for (const auto& force : forces) numbers.push_back(force.tangential_y_N);
    }
    write_piece(task, line_name(line), numbers);
}

std::vector<Cell> probe_cells(const Phantom& phantom, std::size_t count) {
    std::vector<Cell> cells;
    std::size_t tried = 0;
    const auto add = [&](double x_m, double y_m) {
        const auto nearest = [](double at_m, double origin_m, double spacing_m, std::size_t n) {
            const double steps = std::round((at_m - origin_m) / spacing_m);
            return static_cast<std::size_t>(std::clamp(steps, 0.0, static_cast<double>(n - 1)));
        };
        if (tried == count) return;
        ++tried;
        const Cell cell{nearest(x_m, phantom.origin_m[0], phantom.spacing_m[0], phantom.n_x),
                        nearest(y_m, phantom.origin_m[1], phantom.spacing_m[1], phantom.n_y)};
        const auto same = [&](const Cell& other) { return other.i == cell.i && other.j == cell.j; };
        if (std::none_of(cells.begin(), cells.end(), same)) cells.push_back(cell);
    };
    constexpr std::size_t kNodules = 3;  // at most, so that the rest of the grid keeps its share
    // the nodules that demand most of the meshes: those with the least cover for their size
    std::vector<PhantomNodule> nodules = phantom.nodules;
    const auto cover = [](const PhantomNodule& n) { return n.centre_m[2] / n.diameter_m; };
    std::stable_sort(nodules.begin(), nodules.end(),
                     [&](const PhantomNodule& a, const PhantomNodule& b) { return cover(a) < cover(b); });
    for (std::size_t k = 0; k < std::min(kNodules, nodules.size()); ++k) {
        const PhantomNodule& nodule = nodules[k];
        const double x = nodule.centre_m[0];
        const double y = nodule.centre_m[1];
        const double r = 0.5 * nodule.diameter_m;
        add(x, y);
        for (const double far : {r, r + phantom.indenter_radius_m}) {
            add(x - far, y), add(x + far, y), add(x, y - far), add(x, y + far);
        }
    }
    // a low-discrepancy sequence (Roberts' R2), stretched so that it also meets the edges of the grid
    for (int k = 1; tried < count; ++k) {
        const auto share = [&](double step) {
            const double s = std::fmod(0.5 + step * k, 1.0);
            return 1.06 * s - 0.03;
        };
        const double w = phantom.spacing_m[0] * static_cast<double>(phantom.n_x - 1);
        const double h = phantom.spacing_m[1] * static_cast<double>(phantom.n_y - 1);
        add(phantom.origin_m[0] + w * share(0.7548776662466927), phantom.origin_m[1] + h * share(0.5698402909980532));
    }
    return cells;
}

std::vector<mechanics::RollingForce> press_cell(const MapTask& task, const mechanics::RollingTables& tables,
                                                const Cell& cell) {
    const Phantom& p = task.phantom;
    const double x_m = p.origin_m[0] + p.spacing_m[0] * static_cast<double>(cell.i);
    const double y_m = p.origin_m[1] + p.spacing_m[1] * static_cast<double>(cell.j);
    mechanics::RollingWork work;
    std::vector<mechanics::RollingForce> forces;
    mechanics::roll_to(task.model, task.mesh, tables, x_m, y_m, p.depths_m, work, forces);
    return forces;
}

}  // namespace palpa::stiffnessmaps
