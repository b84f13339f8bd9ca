#include <algorithm>
#include <cstdlib>
#include <doctest/doctest.h>

#include "files/text.h"
#include "scene/advance.h"
#include "scene/tissue.h"
#include "stiffnessmaps/noise.h"
#include "tests/assets.h"
#include "tests/close_to.h"
#include "tests/scene/block_phantom.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::platform;
using namespace palpa::avatar;
using namespace palpa::stiffnessmaps;
using namespace palpa::scene;
using namespace palpa::test;

namespace {

Scene map_scene() {
    Scene scene = read_scene(kAssets / "scenes/default.json", kAssets);
    scene.delay = delay_clear();
    return scene;
}

Scene linear_scene(const TemporaryFolder& folder, std::optional<double> friction) {
    write_text_atomically(folder / "block.json", kBlockPhantom);
    ::setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
    Scene scene;
    scene.tissue = LinearOptions{folder / "block.json", 4e-3, friction};
    scene.profile = kAssets / "profiles/s-pen.json";
    scene.display_ratio = display_ratio_clear();
    scene.delay = delay_clear();
    return scene;
}

// The tissue with every force in its matrices multiplied.
Plan with_scaled_matrices(Plan plan, double scale) {
    if (auto* map = std::get_if<MapTissue>(&plan.tissue)) {
        for (std::vector<float>* forces_N : {&map->map.normal_N, &map->map.tangential_x_N, &map->map.tangential_y_N}) {
            for (float& force_N : *forces_N) force_N *= static_cast<float>(scale);
        }
        map->field = make_field(map->map, map->field.options);
    }
    if (auto* linear = std::get_if<LinearTissue>(&plan.tissue)) {
        linear->compliance.revision = mechanics::new_revision();
        linear->compliance.normal_m_per_N /= scale;
        linear->compliance.full_m_per_N /= scale;
    }
    return plan;
}

// The n-th sample of a stroke over the middle, ever deeper.
Sample stroke(const Scene& scene, const Plan& plan, const State& state, int n) {
    Sample sample;
    sample.t_host_s = sample.t_device_s = n / 120.0;
    sample.phase = n == 0 ? Phase::down : Phase::move;
    const Eigen::Vector2d along = 0.25 * (n / 100.0 - 0.5) * plan.area.size_m;
    const Eigen::Vector2d px = px_of_tissue(state.view, plan.area.centre_m + along);
    sample.x_px = px.x();
    sample.y_px = px.y();
    sample.pressure = (0.02 + 0.0002 * n) * scene.force_scale;
    return sample;
}

}  // namespace

TEST_CASE("tissue: a scale where forces are answered equals scaled matrices, to rounding") {
    const TemporaryFolder folder;
    Scene scene;
    double rounding = 1e-9;
    SUBCASE("a map, whose matrices are single precision") {
        scene = map_scene();
        rounding = 1e-5;
    }
    SUBCASE("linear") { scene = linear_scene(folder, {}); }
    SUBCASE("linear, rough") { scene = linear_scene(folder, 0.3); }
    const Plan plan = make_plan(scene);
    for (const double scale : {0.3, 2.5}) {
        CAPTURE(scale);
        const Plan harder = with_scaled_matrices(plan, scale);
        Scene scaled = scene;
        scaled.stiffness_scale = scale;
        REQUIRE(serves(plan, scaled));
        State a = start(scaled, plan, {600, 600});
        State b = start(scene, harder, {600, 600});
        double greatest_N = 0.0;
        for (int n = 0; n <= 100; ++n) {
            advance(scaled, plan, stroke(scene, plan, a, n), a);
            advance(scene, harder, stroke(scene, plan, b, n), b);
            REQUIRE(a.contact.depth_m > 0.0);
            CHECK(a.contact.normal_N == b.contact.normal_N);
            CHECK(a.contact.depth_m == close_to(b.contact.depth_m).epsilon(rounding));
            CHECK(std::abs(a.contact.tangential_N - b.contact.tangential_N) <= rounding * b.contact.normal_N);
            CHECK((a.avatar.lag_m - b.avatar.lag_m).norm() <= 10.0 * rounding * path_of(scene).reference_m);
            greatest_N = std::max(greatest_N, b.contact.tangential_N);
        }
        CHECK(greatest_N > 0.0);
    }
}

TEST_CASE("tissue: the surface sinks by the depth where it is pressed, and is flat once nothing touches") {
    const TemporaryFolder folder;
    Scene scene;
    SUBCASE("a map") { scene = map_scene(); }
    SUBCASE("linear") { scene = linear_scene(folder, {}); }
    scene.surface = SurfaceEffect{};
    scene.cues = {};
    const Plan plan = make_plan(scene);
    CHECK(plan.frame_stages.size() == 1);
    State state = start(scene, plan, {600, 600});
    for (int n = 0; n <= 50; ++n) advance(scene, plan, stroke(scene, plan, state, n), state);
    SurfaceShape shape;
    surface_now(scene, plan, state, shape);
    const double sink_m = sink_at_m(shape, state.contact.p_m);
    // linear: the nodes are 4 mm apart, and the middle of the stroke lies between four of them, which sink less
    CHECK(sink_m > (shape.curve ? 0.9 : 0.5) * state.contact.depth_m);
    CHECK(sink_m < (shape.curve ? 1.1 : 1.0) * state.contact.depth_m);
    const Eigen::Vector2d beside_m = state.contact.p_m + Eigen::Vector2d(0.02, 0.0);
    CHECK(sink_at_m(shape, beside_m) < 0.5 * state.contact.depth_m);
    Sample lift = stroke(scene, plan, state, 51);
    lift.phase = Phase::up;
    advance(scene, plan, lift, state);
    surface_now(scene, plan, state, shape);
    CHECK(sink_at_m(shape, state.contact.p_m) == 0.0);
}

TEST_CASE("tissue: logs and settings name what it is made from") {
    const TemporaryFolder folder;
    const Scene map = map_scene();
    const Scene linear = linear_scene(folder, {});
    CHECK(file_hashes(map.tissue)["map_sha256"]["normal_N.npy"].get<std::string>().size() == 64);
    CHECK(file_hashes(linear.tissue)["phantom_sha256"].get<std::string>().size() == 64);
    CHECK(file_hashes(LinearOptions{"none.json", 1e-3, {}})["phantom_sha256"] == "n/a");
    CHECK(file_hashes(MapOptions{"none.map"}).empty());
    CHECK(input_files(linear.tissue) == std::vector<std::filesystem::path>{folder / "block.json"});
    CHECK(map_folder(linear.tissue).empty());
    CHECK(takes_seconds(linear.tissue));
    CHECK_FALSE(takes_seconds(map.tissue));
    const Plan plan = make_plan(map);
    CHECK(identity(plan.tissue)["count"].size() == 2);
    CHECK(identity(plan.tissue)["smoothing_mm"] == 0.0);
    CHECK(identity(make_plan(linear).tissue).empty());
}

TEST_CASE("tissue: what is scaled stands in the notes, in the scene's words and not in the plan's") {
    Scene scene = map_scene();
    const Plan plan = make_plan(scene);
    CHECK(notes_of(scene, plan) == plan.notes);
    scene.stiffness_scale = 2.0;
    scene.force_scale = 3.0;
    const std::vector<std::string> notes = notes_of(scene, plan);
    REQUIRE(notes.size() == plan.notes.size() + 2);
    CHECK(notes[plan.notes.size()] == "the tissue's forces are multiplied by 2");
    CHECK(notes.back() == "phantom force: the pen's newtons are multiplied by 3");
}

TEST_CASE("tissue: a recorded map whose noise was estimated is smoothed for one stiffness") {
    Scene scene = map_scene();
    Plan plan = make_plan(scene);
    MapTissue& tissue = std::get<MapTissue>(plan.tissue);
    tissue.map.source.kind = SourceKind::recorded;
    tissue.noise_N = 0.01;
    CHECK_FALSE(serves(plan, scene));  // it has been smoothed for no noise
    tissue.smoothing_m = default_smoothing_m(tissue.map, 0.01, path_of(scene).reference_m, scene.display_ratio->gate_N);
    CHECK(serves(plan, scene));
    scene.stiffness_scale = 2.0;
    CHECK_FALSE(serves(plan, scene));
    scene.tangential.smoothing_m = tissue.smoothing_m;  // asked for, whatever the noise
    CHECK(serves(plan, scene));
}

TEST_CASE("tissue: without its nodules a map answers everywhere the same, a block nowhere stiffer") {
    const TemporaryFolder folder;
    Scene map = read_scene(kAssets / "scenes/default.json", kAssets);
    Scene linear = linear_scene(folder, std::nullopt);
    for (Scene* scene : {&map, &linear}) {
        const Plan with = make_plan(*scene);
        leave_out_nodules(scene->tissue);
        const Plan without = make_plan(*scene);
        CHECK_FALSE(with.nodules.empty());
        CHECK(without.nodules.empty());
        const stiffnessmaps::Nodule& nodule = with.nodules.front();
        const auto depth_m = [](const Plan& plan, const Eigen::Vector2d& p_m) {
            TissueWork work = make_work(plan.tissue);
            Contact contact;
            answer(plan.tissue, StageId::depth, {p_m, 0.5, {1, 0}, true, 1.0}, work, contact);
            return contact.depth_m;
        };
        const Eigen::Vector2d there(nodule.x_m, nodule.y_m);
        CHECK(depth_m(with, there) < 0.98 * depth_m(without, there));
        if (scene != &map) continue;
        const Eigen::Vector2d plain(0.1, 0.1);
        CHECK(depth_m(without, there) == depth_m(without, plain));
        CHECK(depth_m(without, plain) == close_to(depth_m(with, plain)).epsilon(0.02));
    }
}
