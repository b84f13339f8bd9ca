#include "accuracy/parts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "accuracy/timing.h"
#include "files/clock.h"
#include "files/text.h"
#include "mechanics/button.h"
#include "mechanics/voxel_solve.h"
#include "parts/cell_model.h"
#include "parts/stiffness.h"

namespace palpa::accuracy {
namespace {

using parts::Method;

// A beam of the paper: 100 x 10 x 10 mm, 10 N at the tip.
struct PaperBeam {
    const char* name;
    double voxel_mm;
    const char* pattern;  // h and s, along the axis or, for layers, upwards
    bool layers;
    double extrapolated_mm;  // by quadratic elements of CalculiX 2.20
};
constexpr std::array<PaperBeam, 5> kPaperBeams{{{"homogeneous", 1.25, "h", false, 0.4828},
                                                {"alternating-hshsh", 1.25, "hshsh", false, 1.0086},
                                                {"alternating-shshs", 1.25, "shshs", false, 1.439},
                                                {"sandwich-hsh", 10.0 / 9.0, "hsh", true, 0.5036},
                                                {"sandwich-shs", 10.0 / 9.0, "shs", true, 1.776}}};

files::Json materials_json() {
    return {{"hard", {{"young_Pa", 8.3e9}, {"poisson", 0.28}, {"density_kg_per_m3", 1200}}},
            {"soft", {{"young_Pa", 2e9}, {"poisson", 0.394}, {"density_kg_per_m3", 1020}}}};
}

// `finer`: voxels of a cell of the table of reference values, along each edge.
parts::Part part_of(const PaperBeam& beam, int finer) {
    files::Json json;
    json["name"] = beam.name;
    json["voxel_mm"] = beam.voxel_mm / finer;
    json["size_mm"] = {100, 10, 10};
    json["materials"] = materials_json();
    json["shape"] = files::Json::array();
    json["shape"].push_back({{"add", {{"all", true}}}, {"material", "hard"}});
    const std::string pattern = beam.pattern;
    const double step_mm = (beam.layers ? 10.0 : 100.0) / static_cast<double>(pattern.size());
    const std::size_t axis = beam.layers ? 2 : 0;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        if (pattern[i] != 's') continue;
        files::Json low{0, 0, 0}, high{100, 10, 10};
        low[axis] = step_mm * static_cast<double>(i);
        high[axis] = step_mm * static_cast<double>(i + 1);
        json["shape"].push_back({{"permute", {{"box", {{"min_mm", low}, {"max_mm", high}}}}}, {"material", "soft"}});
    }
    json["supports"] = {{{"face", "xmin"}, {"fix", "xyz"}}};
    json["loads"] = {{"tip", {{"face", "xmax"}, {"direction", "-z"}, {"force_N", 10}}}};
    json["axis"] = "x";
    return parts::parse_part(json, beam.name);
}

AccuracyRow beam_row(const PaperBeam& beam, Method method, int finer, const Effort& effort) {
    const parts::Part part = part_of(beam, finer);
    AccuracyRow row;
    row.group = std::string("beam ") + beam.name;
    row.series = parts::name_of(method);
    row.choice = method >= Method::voxels
                     ? std::string(parts::name_of(method)) + ", " + std::to_string(8 * finer) + " cells across"
                     : parts::name_of(method);
    parts::MethodResult result;
    std::vector<double> taken_us;
    const int repetitions = effort.quick ? 3 : method >= Method::voxels ? 5 : 200;
    for (int i = 0; i < repetitions; ++i) {
        result = parts::stiffness_of(part, part.loads[0], {{method}, {}, 1e-8}).front();
        taken_us.push_back(1e6 * result.time_s);
    }
    std::sort(taken_us.begin(), taken_us.end());
    row.error_percent = 100.0 * (1e3 * result.displacement_m / beam.extrapolated_mm - 1.0);
    row.reference = "CalculiX 2.20, quadratic elements, extrapolated";
    row.reference_error_percent = 0.05;
    row.per_step_us = taken_us[taken_us.size() / 2];
    row.per_step_p99_us = taken_us[taken_us.size() * 99 / 100];
    row.steps = repetitions;
    if (result.memory_bytes > 0) row.memory_MB = 1e-6 * static_cast<double>(result.memory_bytes);
    if (!result.why_not.empty()) row.note = result.why_not;
    return row;
}

// A neck of 6 x 4 mm with bands of 4 mm, whose cells fit neither bands nor section; displacement under 1 N, mm.
double neck_mm(double cell_mm, AccuracyRow& row) {
    files::Json json;
    json["voxel_mm"] = 0.1;
    json["size_mm"] = {52, 6, 4};
    json["cell_mm"] = cell_mm;
    json["materials"] = materials_json();
    json["shape"] = files::Json::array();
    json["shape"].push_back({{"add", {{"all", true}}}, {"material", "hard"}});
    json["shape"].push_back(
        {{"permute", {{"bands", {{"axis", "x"}, {"period_mm", 8}, {"width_mm", 4}}}}}, {"material", "soft"}});
    json["supports"] = {{{"face", "xmin"}, {"fix", "xyz"}}};
    json["loads"] = {{"tip", {{"face", "xmax"}, {"direction", "-z"}, {"force_N", 1}}}};
    const parts::Part part = parts::parse_part(json, "neck");
    const parts::MethodResult result = parts::stiffness_of(part, part.loads[0], {{Method::voxels}, {}, 1e-5}).front();
    row.note = std::to_string(result.cells) + " cells";
    row.offline_s = result.time_s;
    row.offline_repetitions = 1;
    row.memory_MB = 1e-6 * static_cast<double>(result.memory_bytes);
    return 1e3 * result.displacement_m;
}

void neck_rows(const Effort& effort, std::vector<AccuracyRow>& rows) {
    AccuracyRow unused;
    const double fine_mm = neck_mm(0.4, unused);
    std::vector<double> sizes{1.0, 0.9, 0.7};
    if (!effort.quick) sizes.insert(sizes.end(), {0.8, 0.6, 0.5});
    for (const double cell_mm : sizes) {
        AccuracyRow row;
        row.group = "neck of 0.1 mm voxels";
        row.series = "finite cells";
        row.choice = "cells of " + files::short_number(cell_mm) + " mm";
        row.reference = "cells of 0.4 mm";
        row.error_percent = 100.0 * (neck_mm(cell_mm, row) / fine_mm - 1.0);
        rows.push_back(row);
    }
}

AccuracyRow cover_row(int spacings) {
    const mechanics::ButtonCover cover{6e-3, 2.5e-3, 1e-3, 2e6, 1100.0, spacings, Eigen::Vector3d::Zero()};
    AccuracyRow row;
    row.group = "button cover";
    row.series = "net";
    row.choice = std::to_string(spacings) + " spacings";
    const double began_s = files::steady_s();
    const mechanics::CoverNet net = mechanics::make_net(cover);
    const double w = 0.01 * cover.radius_m;
    const mechanics::CoverState state = mechanics::press_cover(net, w);
    row.offline_s = files::steady_s() - began_s;
    row.offline_repetitions = 1;
    row.nodes = net.n_free;
    row.dofs = 3 * net.n_free;
    row.error_percent = 100.0 * (state.force_N / mechanics::membrane_force_N(cover, w) - 1.0);
    row.reference = "membrane of Foeppl, travel over radius 0.01";
    row.note = std::to_string(state.iterations) + " steps of Newton's method";
    return row;
}

// One sample of a button: a look-up and a search in its table.
AccuracyRow button_row() {
    mechanics::Button button;
    button.cover = mechanics::ButtonCover{6e-3, 2.5e-3, 1e-3, 2e6, 1100.0, 12, Eigen::Vector3d::Zero()};
    button.support = mechanics::LatchSupport{800.0, 1.5};
    button.travel_m = 3e-3;
    const mechanics::ButtonCurve curve = mechanics::press_button(button);
    mechanics::ButtonState state;
    std::vector<double> taken_us;
    constexpr int kAtOnce = 64;  // samples between two looks at the clock
    for (int i = 0; i < 2000; ++i) {
        const double began_s = files::steady_s();
        for (int k = 0; k < kAtOnce; ++k)
            mechanics::move_button(curve, 1.5 + 1.5 * std::sin(0.01 * (kAtOnce * i + k)), state);
        taken_us.push_back(1e6 * (files::steady_s() - began_s) / kAtOnce);
    }
    std::sort(taken_us.begin(), taken_us.end());
    AccuracyRow row;
    row.group = "button sample";
    row.series = row.choice = "table of 1,025 travels";
    row.per_step_us = taken_us[taken_us.size() / 2];
    row.per_step_p99_us = taken_us[taken_us.size() * 99 / 100];
    row.steps = 2000 * kAtOnce;
    row.note = "mean of 64 samples each";
    return row;
}

// Time of conjugate gradients with multigrid on a block of about 200,000 cells whose moduli differ; then after an edit, from
// the solution before.
void multigrid_rows(double contrast, int across, std::vector<AccuracyRow>& rows) {
    files::Json json;
    json["voxel_mm"] = 1;
    json["size_mm"] = {13 * across, across, across};
    json["materials"] = materials_json();
    json["materials"]["soft"]["young_Pa"] = 8.3e9 / contrast;
    json["shape"] = files::Json::array();
    json["shape"].push_back({{"add", {{"all", true}}}, {"material", "hard"}});
    json["shape"].push_back(
        {{"permute", {{"bands", {{"axis", "x"}, {"period_mm", 20}, {"width_mm", 7}}}}}, {"material", "soft"}});
    json["supports"] = {{{"face", "xmin"}, {"fix", "xyz"}}};
    json["loads"] = {{"tip", {{"face", "xmax"}, {"direction", "-z"}, {"force_N", 1}}}};
    Eigen::Matrix3Xd before;
    for (const bool edited : {false, true}) {
        if (edited)
            json["shape"].push_back(
                {{"remove", {{"sphere", {{"centre_mm", {6 * across, across / 2, across}}, {"radius_mm", 3.3}}}}}});
        const parts::Part part = parts::parse_part(json, "block");
        const double began_s = files::steady_s();
        const parts::CellModel model = parts::cell_model(part, 1);
        const Eigen::Matrix3Xd load_N = parts::unit_load_N(part, model, part.loads[0]);
        const mechanics::Multigrid multigrid = mechanics::make_multigrid(model.level);
        const bool warm = before.cols() == load_N.cols();
        const mechanics::VoxelSolution solution =
            mechanics::solve(multigrid, load_N, {1e-3, 500}, warm ? before : Eigen::Matrix3Xd());
        AccuracyRow row;
        row.group = "multigrid, " + std::to_string(model.cells.place.size()) + " cells";
        row.series = "moduli within " + files::short_number(contrast) + " times";
        row.choice = edited ? (warm ? "after an edit, from the solution before" : "after an edit") : "from rest";
        row.offline_s = files::steady_s() - began_s;
        row.offline_repetitions = 1;
        row.nodes = static_cast<int>(load_N.cols());
        row.dofs = 3 * row.nodes;
        row.error_percent = 100.0 * solution.energy_error;
        row.reference = "the estimate of the energy's error";
        row.memory_MB = 1e-6 * static_cast<double>(mechanics::memory_bytes(multigrid));
        row.note = std::to_string(solution.iterations) + " iterations";
        rows.push_back(row);
        before = solution.u_m;
    }
}

constexpr const char* kPartsScript =
    R"gp(# gnuplot parts.gp draws parts.csv as parts.png; gnuplot -e "kind='svg'" parts.gp: or svg, pdf
if (!exists("kind")) kind = "png"
set datafile separator ","
set datafile missing NaN
f = "parts.csv"
floored(e) = abs(e) < 1e-3 ? 1e-3 : abs(e)
beam(method) = strstrt(strcol("group"), "beam ") == 1 && strcol("series") eq method ? floored(column("error_percent")) : NaN
err(group) = strcol("group") eq group ? floored(column("error_percent")) : NaN
blocks(line) = strstrt(strcol("group"), "multigrid") == 1 && strcol("series") eq line ? floored(column("error_percent")) : NaN
if (kind eq "png") set terminal pngcairo size 1500,560 font "DejaVu Sans,12"
if (kind eq "svg") set terminal svg size 1500,560 font "DejaVu Sans,13" background rgb "white"
if (kind eq "pdf") set terminal pdfcairo size 15in,5.6in font "DejaVu Sans,12"
set output "parts." . kind
set logscale xy
set grid xtics ytics lc rgb "#BBBBBB" dt 3
set tics nomirror
set border 3
set format x "10^{%L}"
set format y "10^{%L}"
set multiplot layout 1,3 margins 0.055,0.985,0.12,0.78 spacing 0.075,0.1 \
    title "What accuracy costs in time: parts (down and left is better)\n{/*0.8 " . machine . "}"

set title "Five beams of two materials\n{/*0.8 against quadratic elements, extrapolated}"
set xlabel "one answer (us, median)"
set ylabel "|error| of the displacement (%)"
set key bottom left Left reverse
plot f using "per_step_us":(beam("paper")) with points pt 2 ps 1.3 lc rgb "#000000" title "paper", \
     f using "per_step_us":(beam("euler-bernoulli")) with points pt 9 ps 1.4 lc rgb "#D55E00" title "Euler-Bernoulli", \
     f using "per_step_us":(beam("timoshenko")) with points pt 5 ps 1.2 lc rgb "#0072B2" title "Timoshenko", \
     f using "per_step_us":(beam("elastica")) with points pt 11 ps 1.4 lc rgb "#E69F00" title "elastica", \
     f using "per_step_us":(beam("voxels")) with points pt 7 ps 1.3 lc rgb "#009E73" title "voxels, a point each mesh"

set title "A neck whose cells fit neither bands nor section\n{/*0.8 labels: size of the cells, mm; against 0.4 mm}"
set xlabel "one answer (s)"
set key top right noreverse Right
plot f using "offline_s":(err("neck of 0.1 mm voxels")):(word(strcol("choice"), 3)) with labels point pt 7 ps 1.3 lc rgb "#009E73" \
         offset 0,0.8 font ",9" notitle

set title "Multigrid on a block, and a button's cover\n{/*0.8 block: estimated error of the energy}"
set ylabel "|error| (%)"
plot f using "offline_s":(blocks("moduli within 10 times")) with points pt 5 ps 1.3 lc rgb "#0072B2" title "block, moduli within 10 times", \
     f using "offline_s":(blocks("moduli within 1000 times")) with points pt 9 ps 1.4 lc rgb "#D55E00" title "within 1,000 times", \
     f using "offline_s":(err("button cover")) with linespoints pt 11 ps 1.4 lc rgb "#CC79A7" title "cover, 6 to 24 spacings"
unset multiplot
)gp";

}  // namespace

std::vector<Measurement> part_measurements(const Effort& effort) {
    std::vector<Measurement> list;
    for (const PaperBeam& beam : kPaperBeams) {
        list.push_back({std::string("beam ") + beam.name, effort.quick ? 0.5 : 2.0, [&beam, effort](auto& rows) {
                            for (const Method method :
                                 {Method::paper, Method::euler_bernoulli, Method::timoshenko, Method::elastica})
                                rows.push_back(beam_row(beam, method, 1, effort));
                            for (const int finer : effort.quick ? std::vector{1} : std::vector{1, 2, 3})
                                rows.push_back(beam_row(beam, Method::voxels, finer, effort));
                        }});
    }
    list.push_back({"neck", effort.quick ? 2.0 : 10.0, [effort](auto& rows) { neck_rows(effort, rows); }});
    list.push_back({"button", 1.0, [](auto& rows) {
                        for (const int spacings : {6, 12, 24}) rows.push_back(cover_row(spacings));
                        rows.push_back(button_row());
                    }});
    list.push_back({"multigrid", effort.quick ? 2.0 : 30.0, [effort](auto& rows) {
                        for (const double contrast : {10.0, 1000.0})
                            multigrid_rows(contrast, effort.quick ? 10 : 25, rows);
                    }});
    return list;
}

std::string plot_parts(const std::filesystem::path& folder, const Machine& machine) {
    return plot_list(folder, "parts", kPartsScript, machine);
}

}  // namespace palpa::accuracy
