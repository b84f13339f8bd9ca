#include "accuracy/tangible.h"

#include <cmath>
#include <memory>

#include "accuracy/timing.h"
#include "files/text.h"
#include "tangible/characterise.h"

namespace palpa::accuracy {
namespace {

using files::Json;

// One press: a device file with changes, a plant, and how the loop is run.
struct Setting {
    std::string group, series, choice, note;
    std::filesystem::path device;
    Json model = Json::object();  // merge patch of the device file: the loop's model
    tangible::PlantOptions plant;
    tangible::LoopOptions loop;
    tangible::PressMotion motion;
    double stiffness_N_per_m = 100.0;
    double growth_m = 1.0;  // of the law k d exp(d / growth); 1 m: a straight line
};

std::shared_ptr<const tangible::DeviceModel> model_of(const Setting& setting) {
    Json json = files::read_json(setting.device);
    json.merge_patch(setting.model);
    return std::make_shared<const tangible::DeviceModel>(tangible::make_device_model(
        tangible::parse_soft_device(json, setting.device.string(), setting.device.parent_path())));
}

AccuracyRow press_row(const Setting& setting) {
    AccuracyRow row{.group = setting.group, .series = setting.series, .choice = setting.choice, .note = setting.note};
    row.reference = "force of the virtual tissue over press and release, in per cent of the greatest; plant converged";
    const auto model = model_of(setting);
    row.nodes = static_cast<int>(model->body.mesh.nodes_m.cols());
    row.dofs = model->equations();
    scene::ForceCurveOptions options;
    options.curve.stiffness_N_per_m = setting.stiffness_N_per_m;
    options.curve.growth_m = setting.growth_m;
    options.curve.greatest_depth_m = 2.0 * setting.motion.depth_m;
    const scene::Tissue tissue = scene::ForceCurveTissue{options};
    tangible::World world;
    world.tissue = &tissue;
    const tangible::TangiblePlan plan = tangible::make_tangible_plan(model, world, {0.0, 0.0}, setting.loop);
    const tangible::Plant plant = tangible::make_plant(model, setting.plant, setting.loop);
    const tangible::PressFigures figures = tangible::run_press(plan, plant, setting.motion, 1);
    row.error_percent = figures.force_rms_percent;
    row.worst_error_percent = figures.force_worst_percent;
    Timing timing;
    timing.us = figures.tick_us;
    row.per_step_us = quantile_us(timing, 0.5);
    row.per_step_p99_us = quantile_us(timing, 0.99);
    row.steps = static_cast<int>(figures.tick_us.size());
    if (figures.failed_ticks > 0)
        row.note += (row.note.empty() ? "" : "; ") + std::to_string(figures.failed_ticks) + " ticks failed";
    return row;
}

Json strip_cells(int along, int across, int through, const char* element) {
    return {{"mesh", {{"box", {{"elements", {along, across, through}}}}}}, {"element", element}};
}

struct List {
    const Effort& effort;
    std::filesystem::path devices;
    std::vector<Measurement> out;

    void add(Setting setting, double expected_s) {
        const std::string what = setting.group + ": " + setting.choice;
        if (effort.quick) setting.motion.speed_m_per_s *= 4.0;  // fewer ticks
        out.push_back({what, expected_s, [setting](auto& rows) { rows.push_back(press_row(setting)); }});
    }
    Setting strip(const char* group, std::string choice) const {
        Setting setting;
        setting.group = group;
        setting.series = "strip";
        setting.choice = std::move(choice);
        setting.device = devices / "strip.json";
        return setting;
    }
};

void add_fidelities(List& list) {
    for (std::size_t i = 0; i < tangible::kFidelityNames.size(); ++i) {
        for (const bool stiffening : {false, true}) {
            Setting setting = list.strip("fidelity", std::string(tangible::kFidelityNames[i]) +
                                                         (stiffening ? ", stiffening tissue" : ", 0.1 N/mm"));
            setting.series = stiffening ? "strip, 0.02 N/mm d exp(d / 3 mm)" : "strip, 0.1 N/mm";
            setting.loop.inverse.fidelity = static_cast<tangible::Fidelity>(i);
            if (stiffening) {
                setting.stiffness_N_per_m = 20.0;
                setting.growth_m = 3e-3;
            }
            list.add(setting, 20.0);
        }
    }
}

void add_meshes(List& list) {
    struct Choice {
        int along, across, through;
        const char* element;
    };
    std::vector<Choice> choices{{25, 2, 1, "hex8-bbar"}, {50, 4, 2, "hex8-bbar"}, {50, 4, 2, "hex8"}};
    if (!list.effort.quick) choices.push_back({100, 4, 2, "hex8-bbar"});
    for (const Choice& c : choices) {
        Setting setting =
            list.strip("element and mesh", std::string(c.element) + ", " + std::to_string(c.along) + " x " +
                                               std::to_string(c.across) + " x " + std::to_string(c.through));
        setting.series = c.element;
        setting.note = "plant: hex8-bbar, 100 x 4 x 4";
        setting.model = strip_cells(c.along, c.across, c.through, c.element);
        setting.plant.device = strip_cells(100, 4, 4, "hex8-bbar");
        list.add(setting, 40.0);
    }
}

void add_laws(List& list) {
    for (const char* law : {"neo-hookean-split", "stable-neo-hookean"}) {
        Setting setting = list.strip("law", std::string("model ") + law);
        setting.note = "plant: neo-hookean (log form)";
        setting.model = {{"materials", {{"silicone", {{"law", law}}}}}};
        setting.plant.device = {{"materials", {{"silicone", {{"law", "neo-hookean"}}}}}};
        list.add(setting, 20.0);
    }
}

void add_bearings(List& list) {
    const Json bearings = files::read_json(list.devices / "strip.json")["bearings"];
    for (const bool by_nodes : {false, true}) {
        Setting setting = list.strip("bearings", by_nodes ? "model by nodes" : "model by faces");
        setting.note = "plant: by faces";
        Json of_model = bearings;
        if (by_nodes) {
            for (Json& bearing : of_model) bearing["by"] = "nodes";
        }
        setting.model = {{"bearings", of_model}};
        setting.plant.device = {{"bearings", bearings}};
        list.add(setting, 20.0);
    }
}

void add_commands(List& list) {
    for (const double factor : {1.02, 1.05, 1.1}) {
        for (const bool position : {false, true}) {
            Setting setting = list.strip("command", std::string(position ? "by position" : "by force") + ", modulus " +
                                                        files::short_number(100.0 * (factor - 1.0)) + " % off");
            setting.series = position ? "by position" : "by force";
            setting.loop.command = position ? tangible::CommandKind::position : tangible::CommandKind::force;
            setting.plant.modulus_factor = factor;
            list.add(setting, 20.0);
        }
    }
}

void add_sensors(List& list) {
    for (const double rate_Hz : {20.0, 50.0, 100.0}) {
        for (const bool predict : {false, true}) {
            Setting setting =
                list.strip("sensor", files::short_number(rate_Hz) + " Hz" + (predict ? ", extrapolated" : ""));
            setting.series = predict ? "extrapolated" : "as read";
            setting.loop.predict = predict;
            setting.plant.sensor.rate_Hz = rate_Hz;
            list.add(setting, 20.0);
        }
    }
}

void add_speeds(List& list) {
    for (const double mm_per_s : {2.0, 5.0, 10.0, 20.0, 50.0}) {
        for (const bool inertia : {false, true}) {
            Setting setting =
                list.strip("speed", files::short_number(mm_per_s) + " mm/s" + (inertia ? ", with its mass" : ""));
            setting.series = inertia ? "plant with mass" : "plant without mass";
            setting.motion.speed_m_per_s = 1e-3 * mm_per_s;
            setting.plant.inertia = inertia;
            setting.plant.sensor.delay_s = 5e-3;
            setting.plant.lag_s = 20e-3;
            setting.note = "sensor 5 ms late, drives lag 20 ms";
            list.add(setting, 100.0 / mm_per_s);
        }
    }
}

void add_accordion(List& list) {
    for (const double factor : {1.0, 1.1}) {
        Setting setting;
        setting.group = "accordion";
        setting.series = "2,688 linear tetrahedra";
        setting.choice = factor == 1.0 ? "exact plant" : "modulus 10 % off";
        setting.device = list.devices / "accordion.json";
        setting.plant.modulus_factor = factor;
        list.add(setting, 40.0);
    }
}

constexpr const char* kTangibleScript =
    R"gp(# gnuplot tangible.gp draws tangible.csv as tangible.png; gnuplot -e "kind='svg'" tangible.gp: or svg, pdf
if (!exists("kind")) kind = "png"
set datafile separator ","
set datafile missing NaN
f = "tangible.csv"
err(group) = strcol("group") eq group ? (column("error_percent") < 1e-4 ? 1e-4 : column("error_percent")) : NaN
if (kind eq "png") set terminal pngcairo size 1100,700 font "DejaVu Sans,12"
if (kind eq "svg") set terminal svg size 1100,700 font "DejaVu Sans,13" background rgb "white"
if (kind eq "pdf") set terminal pdfcairo size 11in,7in font "DejaVu Sans,12"
set output "tangible." . kind
set title "What accuracy costs in time: soft devices, simulated (down and left is better)\n{/*0.8 " . machine . "}"
set logscale xy
set grid xtics ytics lc rgb "#BBBBBB" dt 3
set tics nomirror
set border 3
set xlabel "one tick of the loop (us, median)"
set ylabel "rms error of the rendered force (% of the greatest; 10^{-4} and less at the edge)"
set yrange [5e-5 : *]
set xrange [* < 200 : 20000 < *]
set key outside right top
do for [t in "1000 3333 10000"] { set arrow from t, graph 0 to t, graph 1 nohead lc rgb "#888888" dt 2 }
set label "1,000 Hz" at 1000, graph 0.97 right rotate by 90 font ",9" offset -0.3,0
set label "300 Hz" at 3333, graph 0.97 right rotate by 90 font ",9" offset -0.3,0
set label "100 Hz" at 10000, graph 0.97 right rotate by 90 font ",9" offset -0.3,0
plot f using "per_step_us":(err("fidelity")) with points pt 7 ps 1.5 lc rgb "#0072B2" title "fidelity", \
     f using "per_step_us":(err("element and mesh")) with points pt 5 ps 1.5 lc rgb "#D55E00" title "element and mesh", \
     f using "per_step_us":(err("law")) with points pt 9 ps 1.5 lc rgb "#009E73" title "law", \
     f using "per_step_us":(err("bearings")) with points pt 12 ps 1.5 lc rgb "#666666" title "bearings", \
     f using "per_step_us":(err("command")) with points pt 13 ps 1.7 lc rgb "#CC79A7" title "modulus off", \
     f using "per_step_us":(err("sensor")) with points pt 11 ps 1.5 lc rgb "#E69F00" title "sensor", \
     f using "per_step_us":(err("speed")) with points pt 4 ps 1.4 lc rgb "#56B4E9" title "speed", \
     f using "per_step_us":(err("accordion")) with points pt 6 ps 1.5 lc rgb "#000000" title "accordion"
)gp";

}  // namespace

std::vector<Measurement> tangible_measurements(const Effort& effort, const std::filesystem::path& devices) {
    List list{effort, devices, {}};
    add_fidelities(list);
    add_meshes(list);
    add_laws(list);
    add_bearings(list);
    add_commands(list);
    add_sensors(list);
    add_speeds(list);
    add_accordion(list);
    return std::move(list.out);
}

std::string plot_tangible(const std::filesystem::path& folder, const Machine& machine) {
    return plot_list(folder, "tangible", kTangibleScript, machine);
}

}  // namespace palpa::accuracy
