#include "app/live.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "app/load.h"
#include "app/log.h"
#include "app/prepare.h"
#include "app/replay.h"
#include "app/screenshot.h"
#include "files/text.h"
#include "platform/trace.h"
#include "platform/window.h"
#include "render/gl.h"

namespace palpa {
namespace {

constexpr double kFrame_s = 1.0 / 60.0;  // of our own: software rendering has no vertical sync

// Everything that one run has open.
struct Live {
    Scene scene;
    Plan plan;
    State state;
    std::optional<Trace> trace;         // replayed
    std::size_t next_row = 0;
    double trace_shift_s = 0.0;         // window's clock - trace's clock
    std::optional<RunFiles> files;
    std::optional<SampleLog> log;
    std::optional<TraceWriter> record;
    FrameTimes times;
    std::int64_t frames = 0;
    std::vector<double> waiting_s;      // host times of the samples that no frame has shown yet
};

// Everything that bad input can refuse, before a window is there.
void load(const RunOptions& options, Live& live) {
    live.scene = load_scene(options.scene);
    if (!live.scene.linear) live.plan = make_plan(live.scene);
    if (!options.trace.empty()) live.trace = read_trace(options.trace);
}

// A tissue that has to be computed is, while the window shows how far. False if the window was closed meanwhile.
bool prepare(Window& window, Gui& gui, Live& live) {
    PlanInProgress work(live.scene);
    std::vector<Sample> ignored;
    while (!work.wait(1.0 / 60.0)) {
        window.poll(0.0, ignored);
        if (window.close_requested()) return false;
        gui.begin_frame(1.0 / 60.0);
        draw_progress("Preparing the tissue (once; later starts are quick)", work.share());
        gui.end_frame();
        clear_screen(window.width_px(), window.height_px());
        gui.draw();
        window.present();
    }
    live.plan = work.take();
    return true;
}

std::string device_names(const Window& window) {
    std::string names;
    for (const PointerDevice& device : window.devices()) names += (names.empty() ? "" : ", ") + device.name;
    return names.empty() ? "mouse" : names;
}

void open(const RunOptions& options, const Window& window, Live& live) {
    double width_px = window.width_px();
    double height_px = window.height_px();
    if (live.trace) {
        width_px = live.trace->info.screen_width_px;
        height_px = live.trace->info.screen_height_px;
    }
    live.state = start(live.scene, live.plan, width_px, height_px);
    live.state.time_every = 16;
    if (!options.record.empty()) {
        TraceInfo info;
        info.screen_width_px = width_px;
        info.screen_height_px = height_px;
        info.device = live.trace ? live.trace->info.device : device_names(window);
        live.record.emplace(options.record, info);
    }
    if (!options.log.empty()) {
        live.files = next_run(options.log, options.participant);
        live.log.emplace(*live.files);
    }
    live.waiting_s.reserve(4096);
}

// Rows of the trace that are due, with the trace's own times.
void take_due_rows(Live& live, double now_s, std::vector<Sample>& out) {
    const auto& rows = live.trace->samples;
    while (live.next_row < rows.size() && rows[live.next_row].t_host_s + live.trace_shift_s <= now_s) {
        out.push_back(rows[live.next_row++]);
    }
}

void take_sample(Live& live, const Sample& sample) {
    if (live.record) live.record->write(sample);
    advance(live.scene, live.plan, sample, live.state);
    if (live.log) live.log->write(row_of(sample, live.plan, live.state));
    if (live.waiting_s.size() < live.waiting_s.capacity()) live.waiting_s.push_back(sample.t_host_s + live.trace_shift_s);
}

std::vector<std::string> device_messages(const Window& window) {
    std::vector<std::string> messages;
    bool pen = false;
    for (const PointerDevice& device : window.devices()) pen = pen || device.has_pressure;
    if (!window.input_note().empty()) messages.push_back(window.input_note());
    if (!pen) messages.push_back("No pen or finger with a pressure sensor here. Press with the mouse: hold the button, or turn the wheel.");
    return messages;
}

// A window that changed its size is input too: a replay must map positions alike.
void note_resize(const Window& window, Live& live) {
    if (live.trace) return;
    if (window.width_px() == static_cast<int>(live.state.screen_width_px) &&
        window.height_px() == static_cast<int>(live.state.screen_height_px)) {
        return;
    }
    Sample resize;
    resize.t_host_s = window.now_s();
    resize.phase = Phase::ui;
    resize.action = Action::resize;
    resize.x_px = window.width_px();
    resize.y_px = window.height_px();
    take_sample(live, resize);
}

void show(Window& window, Live& live, TissueDrawer& tissue, Gui& gui, PanelOptions& panel, double dt_s) {
    const double now_s = window.now_s() - live.trace_shift_s;
    draw_frame(live.scene, live.plan, now_s, dt_s, tissue, gui, panel, live.state, live.times);
    window.present();
    ++live.frames;
    const double shown_s = window.now_s();
    for (const double t_s : live.waiting_s) live.times.latency.add_ns(1e9 * (shown_s - t_s));
    live.waiting_s.clear();
    live.times.frames_per_s += 0.05 * (1.0 / std::max(dt_s, 1e-3) - live.times.frames_per_s);
}

void finish(const RunOptions& options, Live& live, const Json& result) {
    bool good = true;
    if (live.record) good = live.record->sync() && good;
    if (live.log) good = live.log->sync() && good;
    if (live.log && good) {
        const std::string settings = json_text(settings_json(live.scene, live.plan, live.state));
        write_text_atomically(live.files->file("_settings.json"), settings);
        write_text_atomically(live.files->file("_performance.json"), json_text(result));
    }
    if (!good) throw std::runtime_error((live.log ? options.log : options.record) + ": can no longer be written; stopped (is the disk full?)");
}

}  // namespace

std::optional<Json> run_live(const RunOptions& options) {
    WindowOptions window_options;
    window_options.width_px = options.width_px;
    window_options.height_px = options.height_px;
    const double asked_s = 1e-9 * static_cast<double>(steady_ns());
    Live live;
    load(options, live);
    Window window(window_options);
    Gui gui(window);
    if (live.scene.linear && !prepare(window, gui, live)) return std::nullopt;
    open(options, window, live);
    TissueDrawer tissue;
    PanelOptions panel;
    panel.messages = live.trace ? std::vector<std::string>{"replay of " + options.trace} : device_messages(window);

    const double began_s = window.now_s();
    if (live.trace) live.trace_shift_s = began_s - live.trace->samples.front().t_host_s;
    double frame_s = began_s;
    double first_frame_s = 0.0;
    std::vector<Sample> samples;
    while (!window.close_requested()) {
        samples.clear();
        window.poll(std::max(0.0, frame_s + kFrame_s - window.now_s()), samples);  // 1. read
        if (live.trace) {
            samples.clear();
            take_due_rows(live, window.now_s(), samples);
        }
        note_resize(window, live);
        for (const Sample& sample : samples) take_sample(live, sample);            // 2. simulate, 3. log
        const double now_s = window.now_s();
        if (live.frames % 60 == 0 && !live.trace) panel.messages = device_messages(window);
        if (now_s - frame_s >= kFrame_s || live.frames == 0) {
            show(window, live, tissue, gui, panel, now_s - frame_s);               // 4. show
            frame_s = now_s;
            if (live.frames == 1) first_frame_s = 1e-9 * static_cast<double>(steady_ns()) - asked_s;
        }
        const bool failed = (live.log && live.log->failed()) || (live.record && live.record->failed());
        if (failed) break;  // finish() says so, after it has saved what it can
        if (live.trace && live.next_row == live.trace->samples.size()) break;
        if (options.quit_after_s > 0.0 && now_s - began_s > options.quit_after_s) break;
    }
    if (!options.screenshot.empty()) save_screen(window, options.screenshot);
    Json result = run_json(live.scene, live.plan, live.state, live.frames, live.times.latency);
    result["frame_cpu_ms"] = {{"p50", 1e-6 * live.times.cpu.quantile_ns(0.5)}, {"p99", 1e-6 * live.times.cpu.quantile_ns(0.99)}};
    result["frame_gl_ms"] = {{"p50", 1e-6 * live.times.gl.quantile_ns(0.5)}, {"p99", 1e-6 * live.times.gl.quantile_ns(0.99)}};
    result["start_to_first_frame_s"] = first_frame_s;
    finish(options, live, result);
    return result;
}

}  // namespace palpa
