// palpa bench visibility: which nodules can be seen, by the pixels of the app's own frames.

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "accuracy/image_motion.h"
#include "accuracy/visibility.h"
#include "app/commands/command_line.h"
#include "app/commands/option_checks.h"
#include "app/scene_choices.h"
#include "app/screens/frame.h"
#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "render/png.h"
#include "scene/tissue.h"
#include "session/plan_in_progress.h"

namespace palpa::app {
namespace {

struct SeeOptions {
    std::string scene;
    accuracy::VisibilityOptions visibility;
    double speed_mm_per_s = 30.0;
    double distance_cm = 40.0;
    double px_per_mm = 0.0;  // 0: true size
    int width_px = 1280;
    int height_px = 800;
    bool finger = false;
    std::string pictures;
    bool json = false;
};

// One of the two tissues that are compared.
struct Side {
    session::Session session;
    ViewState view;
};

struct Observer {
    explicit Observer(const SeeOptions& given) : options(given), screen(given.width_px, given.height_px) {}

    const SeeOptions& options;
    OffScreen screen;
    std::array<Side, 2> sides;  // with the nodules, and without
    Settings settings;
    Notices notices;
    Doing doing;
    std::optional<Wishes> asked;
};

void put_tissue(const scene::Scene& scene, Side& side) {
    auto plan = std::make_shared<const scene::Plan>(session::make_plan_here(scene));
    session::change_tissue(scene, std::move(plan), {}, side.session);
}

// In a test, so that the nodules themselves are not drawn.
void begin_stroke(Observer& observer, Side& side) {
    const platform::Window& window = observer.screen.window();
    platform::TraceInfo info;
    info.screen_width_px = window.width_px();
    info.screen_height_px = window.height_px();
    session::begin_trial({}, info, session::TrialMode::test, side.session);
    session::take_sample(resize_sample(window, observer.screen.gui(), observer.settings, 0.0), side.session);
}

// Returns the part of the frame that the tissue has.
accuracy::Pixels tissue_pixels(const scene::ScreenArea& area, const OffScreen& screen) {
    const auto width_px = static_cast<std::size_t>(screen.window().width_px());
    const auto x0 = static_cast<std::size_t>(std::lround(area.x_px));
    const auto y0 = static_cast<std::size_t>(std::lround(area.y_px));
    accuracy::Pixels out;
    out.width_px = static_cast<int>(area.width_px);
    out.height_px = static_cast<int>(area.height_px);
    const std::vector<unsigned char> rgb = screen.pixels();
    for (std::size_t y = y0; y < y0 + static_cast<std::size_t>(out.height_px); ++y) {
        const auto row = rgb.begin() + static_cast<std::ptrdiff_t>(3 * (y * width_px + x0));
        out.rgb.insert(out.rgb.end(), row, row + static_cast<std::ptrdiff_t>(3) * out.width_px);
    }
    return out;
}

accuracy::Pixels frame_after(const std::vector<platform::Sample>& samples, std::size_t last, Observer& observer,
                             Side& side) {
    begin_stroke(observer, side);
    for (std::size_t i = 0; i <= last; ++i) session::take_sample(samples[i], side.session);
    session::Session& session = side.session;
    const ToShow what{session.scene,    *session.plan,  session.trial,  observer.settings,
                      observer.notices, observer.doing, observer.asked, session.state.timeline.now_s};
    observer.screen.draw(what, side.view, session.state);
    return tissue_pixels(session.state.screen, observer.screen);
}

void save(const accuracy::Pixels& pixels, const std::string& name, const Observer& observer) {
    if (observer.options.pictures.empty()) return;
    files::write_text_whole(std::filesystem::path(observer.options.pictures) / (name + ".png"),
                            render::png_bytes(pixels.width_px, pixels.height_px, pixels.rgb));
}

constexpr double kSlack_px = 2.0;  // of a match, beyond what moved

accuracy::Seen see(const accuracy::Stroke& stroke, Observer& observer) {
    const session::Session& with = observer.sides[0].session;
    const accuracy::VisibilityOptions& options = observer.options.visibility;
    const auto samples = samples_of(stroke, with.scene, *with.plan, with.state.view, options);
    accuracy::Seen seen;
    seen.stroke = stroke;
    seen.difference =
        accuracy::difference_of(samples, with.scene, *with.plan, *observer.sides[1].session.plan, with.state.screen);
    const double longest_px = longest_motion_m(seen.difference) * with.state.view.px_per_m + kSlack_px;
    for (const std::size_t at : {seen.difference.apart_at, seen.difference.depth_at}) {
        if (at == 0) continue;
        const accuracy::Pixels without = frame_after(samples, at, observer, observer.sides[1]);
        const accuracy::Pixels shown = frame_after(samples, at, observer, observer.sides[0]);
        const double motion_px = greatest_motion(without, shown, longest_px).length_px();
        if (motion_px < seen.motion_px) continue;
        seen.motion_px = motion_px;
        if (stroke.nodule.empty()) continue;
        save(without, stroke.nodule + "-without", observer);
        save(shown, stroke.nodule + "-with", observer);
    }
    const double px_per_m =
        observer.options.px_per_mm > 0.0 ? 1e3 * observer.options.px_per_mm : with.state.view.px_per_m;
    seen.motion_arcmin = accuracy::arcmin_of(seen.motion_px / px_per_m, options.distance_m);
    return seen;
}

void run_visibility(SeeOptions options) {
    options.visibility.speed_m_per_s = 1e-3 * options.speed_mm_per_s;
    options.visibility.distance_m = 1e-2 * options.distance_cm;
    if (options.finger) options.visibility.tool = platform::Tool::finger;
    if (!options.pictures.empty()) {
        files::check_output_folder(options.pictures);
        std::filesystem::create_directories(options.pictures);
    }
    Observer observer(options);
    const scene::Scene scene = load_scene(options.scene);
    scene::Scene plain = scene;
    leave_out_nodules(plain.tissue);
    put_tissue(scene, observer.sides[0]);
    const scene::Plan& plan = *observer.sides[0].session.plan;
    check_force_N(options.visibility.force_N, scene, plan.profile);
    if (plan.nodules.empty())
        throw files::bad_input(scene.name, "", "a tissue without nodules", "one with nodules, to be seen or not");
    put_tissue(plain, observer.sides[1]);
    for (Side& side : observer.sides) begin_stroke(observer, side);
    std::vector<accuracy::Seen> seen;
    for (const accuracy::Stroke& stroke : accuracy::strokes_over(plan)) seen.push_back(see(stroke, observer));
    const std::vector<std::string> left_out = nodules_left_out(plan, seen);
    if (options.json) {
        files::Json json = visibility_json(seen, left_out, options.visibility);
        json["scene"] = scene.name;
        std::fputs(files::json_text(json).c_str(), stdout);
    } else {
        std::printf("%s, %g N\n%s", scene.name.c_str(), options.visibility.force_N,
                    visibility_table(seen, left_out, options.visibility).c_str());
    }
}

}  // namespace

void add_bench_visibility(CLI::App& bench) {
    auto options = std::make_shared<SeeOptions>();
    CLI::App* command = bench.add_subcommand(
        "visibility", "Which nodules can be seen: compares frames of the app with and without them, pixel by pixel");
    command->add_option("SCENE", options->scene,
                        "scene JSON, map folder or the name of a shipped one (default: the default scene)");
    command->add_option("--force-N", options->visibility.force_N, "force of the simulated stroke (default 2)")
        ->check(CLI::Range(0.01, 1e3));
    command->add_option("--speed-mm-per-s", options->speed_mm_per_s, "speed of the stroke (default 30)")
        ->check(CLI::Range(0.1, 1e3));
    command
        ->add_option("--distance-cm", options->distance_cm,
                     "from the eye to the screen (default 40): turns lengths into angles, thresholds too, so that no "
                     "verdict depends on it")
        ->check(CLI::Range(1.0, 1e3));
    command->add_option("--px-per-mm", options->px_per_mm, "of the screen (default: the tissue is shown in true size)")
        ->check(CLI::Range(1.0, 100.0));
    command->add_option("--width-px", options->width_px, "width of the frame (default 1280)")
        ->check(CLI::Range(300, 16384));
    command->add_option("--height-px", options->height_px, "height of the frame (default 800)")
        ->check(CLI::Range(300, 16384));
    command->add_option("--pictures", options->pictures, "folder for the frames that were compared over each nodule");
    command->add_flag("--finger", options->finger, "stroke with a finger instead of a pen");
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->callback([options] { run_visibility(*options); });
}

}  // namespace palpa::app
