#include <chrono>
#include <cmath>
#include <doctest/doctest.h>
#include <random>
#include <thread>

#include "mechanics/error.h"
#include "tactile/table.h"
#include "tests/close_to.h"
#include "tests/mechanics/allocation_count.h"
#include "tests/tactile/finger_block.h"

using namespace palpa;
using namespace palpa::tactile;
using namespace palpa::test;

namespace {

mechanics::PinShape six_by_six() {
    mechanics::PinShapeOptions options;
    options.sheet = mechanics::Sheet::free;
    return mechanics::make_pin_shape({}, options);
}

Renderer block_renderer(FingerContact contact) {
    // nodes that join the contact of a sphere make its force jump: a large one jumps less
    const double diameter_m = contact == FingerContact::parabola ? 14e-3 : 50e-3;
    return make_renderer(finger_block().tissue, {contact, diameter_m, {}}, 1.0, 1.0, observation_of(six_by_six()));
}

TableOptions wide_options(FingerContact contact) {
    TableOptions options;
    if (contact != FingerContact::parabola) {
        options.error = 0.05;
        options.shape_error_m = 0.3e-3;
    }
    return options;
}

}  // namespace

TEST_CASE("table: force and shape are live ones to what was asked for, at places and forces of chance") {
    for (const FingerContact contact : {FingerContact::parabola, FingerContact::pad}) {
        CAPTURE(static_cast<int>(contact));
        const Renderer renderer = block_renderer(contact);
        const TableOptions options = wide_options(contact);
        const Table table = make_table(renderer, options, {});
        INFO(table.note);
        REQUIRE(table.good);
        CHECK(table.error <= options.error);
        MESSAGE(table.count[0] << " x " << table.count[1] << " places, " << table.force_N.size() << " forces, error "
                               << 100.0 * table.error << " %, " << 1e3 * table.shape_error_m << " mm");
        RendererWork live = make_work(renderer);
        RendererWork fast = make_work(renderer);
        adopt(&table, fast);
        Eigen::VectorXd live_m(36), fast_m(36);
        const unsigned seed = 21;
        CAPTURE(seed);
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> place(0.0255, 0.0345);
        std::uniform_real_distribution<double> share(0.02, 1.0);
        for (int k = 0; k < 150; ++k) {
            const Eigen::Vector2d at_m(place(random), place(random));
            const Press truth = press_with_force(renderer, at_m, share(random), live);
            const Press answer = press_to_depth(renderer, at_m, truth.depth_m, fast);
            CHECK(fast.from_table);
            // the estimate is a sample's worst; chance places may lie a little beyond
            CHECK(std::abs(answer.force_N - truth.force_N) < 1.5 * options.error);
            shape_m(renderer, live, live_m);
            shape_m(renderer, fast, fast_m);
            CHECK((live_m - fast_m).cwiseAbs().maxCoeff() < 1.5 * options.shape_error_m);
            const Press back = press_with_force(renderer, at_m, answer.force_N, fast);
            CHECK(back.depth_m == close_to(truth.depth_m).epsilon(1e-6));
        }
    }
}

TEST_CASE("table: finger over the edge is answered live, the limit holds alike, and no touch is no force") {
    const Renderer renderer = block_renderer(FingerContact::parabola);
    const Table table = make_table(renderer, {}, {});
    REQUIRE(table.good);
    RendererWork live = make_work(renderer);
    RendererWork fast = make_work(renderer);
    adopt(&table, fast);
    const Press edge = press_to_depth(renderer, {0.004, 0.03}, 1e-3, fast);
    CHECK_FALSE(fast.from_table);
    CHECK(edge.over_edge);
    CHECK(edge.force_N == press_to_depth(renderer, {0.004, 0.03}, 1e-3, live).force_N);
    for (const double depth_m : {8e-3, 8.9e-3, 15e-3, 1.0}) {
        const Press held = press_to_depth(renderer, {0.03, 0.03}, depth_m, fast);
        const Press truth = press_to_depth(renderer, {0.03, 0.03}, depth_m, live);
        CHECK(held.capped == truth.capped);
        CHECK(held.force_N == close_to(truth.force_N).epsilon(0.006));
        CHECK(held.depth_m == close_to(truth.depth_m).epsilon(0.006));
    }
    CHECK(press_to_depth(renderer, {0.03, 0.03}, -1e-3, fast).force_N == 0.0);
    CHECK(press_to_depth(renderer, {0.03, std::nan("")}, 1e-3, fast).held);
}

TEST_CASE("table: the force is smooth along a slide, across the table's own places too") {
    const Renderer renderer = block_renderer(FingerContact::parabola);
    const Table table = make_table(renderer, {}, {});
    REQUIRE(table.good);
    RendererWork fast = make_work(renderer);
    adopt(&table, fast);
    double last_N = 0.0;
    double last_change_N = 0.0;
    double worst_N = 0.0;
    for (int k = 0; k < 4000; ++k) {
        const double force_N = press_to_depth(renderer, {0.008 + 1e-5 * k, 0.0301}, 1e-3, fast).force_N;
        const double change_N = force_N - last_N;
        if (k > 1) worst_N = std::max(worst_N, std::abs(change_N - last_change_N));
        last_N = force_N;
        last_change_N = change_N;
    }
    // over a step of 10 um; a jump of the slope would show as a jump of the change
    CHECK(worst_N < 2e-6);
}

TEST_CASE("table: is read back from the cache, and only for the same question") {
    TemporaryFolder folder;
    const Renderer renderer = block_renderer(FingerContact::parabola);
    const Table made = make_table(renderer, {}, folder / "cache");
    REQUIRE(made.good);
    CHECK_FALSE(made.from_cache);
    const Table again = make_table(renderer, {}, folder / "cache");
    CHECK(again.from_cache);
    CHECK(again.good);
    CHECK(again.depth_m == made.depth_m);
    CHECK(again.value_m == made.value_m);
    CHECK(again.count[0] == made.count[0]);
    Renderer larger = renderer;
    larger.finger.diameter_m = 15e-3;
    CHECK_FALSE(make_table(larger, {}, folder / "cache").from_cache);
    Renderer other = renderer;
    other.content += 1;
    CHECK_FALSE(make_table(other, {}, folder / "cache").from_cache);
}

TEST_CASE("table: what cannot be reached is said, and no table then answers") {
    const Renderer renderer = block_renderer(FingerContact::parabola);
    TableOptions options;
    options.error = 1e-9;
    options.most_MB = 0.5;
    const Table table = make_table(renderer, options, {});
    CHECK_FALSE(table.good);
    CHECK(table.note.find("stays live") != std::string::npos);
    Renderer wide = renderer;
    wide.finger.diameter_m = 0.07;
    CHECK_FALSE(make_table(wide, {}, {}).good);
    const Renderer curve = make_renderer({{1e-3}, {0.1}}, 1.0, 3.0);
    CHECK_FALSE(make_table(curve, {}, {}).good);
}

TEST_CASE("table: a worker makes it while the answer is live, and ends when told to") {
    const Renderer renderer = block_renderer(FingerContact::parabola);
    RendererWork work = make_work(renderer);
    {
        TableInProgress making(renderer, {}, {});
        bool live = false;
        bool by_table = false;
        for (int k = 0; k < 100000 && !by_table; ++k) {
            if (const Table* table = making.ready(); table && !work.table) adopt(table, work);
            press_to_depth(renderer, {0.03, 0.03}, 1e-3, work);
            (work.from_table ? by_table : live) = true;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        CHECK(live);
        CHECK(by_table);
        CHECK(making.finished());
        CHECK(making.note().empty());
        adopt(nullptr, work);
    }
    TableOptions endless;
    endless.error = 1e-12;
    endless.most_MB = 1e6;
    endless.spacing_m = 3e-4;
    TableInProgress cancelled(renderer, endless, {});
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    // the destructor does not wait for the table
}

TEST_CASE("table: its look-up allocates nothing") {
    const Renderer renderer = block_renderer(FingerContact::parabola);
    const Table table = make_table(renderer, {}, {});
    REQUIRE(table.good);
    RendererWork work = make_work(renderer);
    adopt(&table, work);
    Eigen::VectorXd sink_m(36);
    const long before = allocation_count();
    for (int k = 0; k < 100; ++k) {
        press_to_depth(renderer, {0.01 + 0.0004 * k, 0.03}, 1e-5 * k, work);
        shape_m(renderer, work, sink_m);
        press_with_force(renderer, {0.01 + 0.0004 * k, 0.03}, 0.01 * k, work);
    }
    CHECK(allocation_count() == before);
}
