#include <doctest/doctest.h>
#include <limits>

#include "devices/limits.h"
#include "files/input_error.h"
#include "files/text.h"
#include "scene/plan.h"
#include "session/tangible_body.h"
#include "session/tangible_run.h"
#include "session/tangible_run_sink.h"
#include "tests/mechanics/allocation_count.h"
#include "tests/tangible/small_strip.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::session;
using namespace palpa::test;

namespace {

struct SmallRun {
    SmallRun()
        : plan(std::make_shared<const tangible::TangiblePlan>(
              tangible::make_tangible_plan(small_strip(), known.world, {0.0, 0.0}, {}))),
          plant(tangible::make_plant(plan->model, noisy(), plan->loop)) {
        options.finger.motion = {3e-3, 10e-3};
    }
    static tangible::PlantOptions noisy() {
        tangible::PlantOptions plant = small_plant();
        plant.sensor = {80.0, 1e-5, 2e-3};
        return plant;
    }

    KnownTissue known{0.1};
    std::shared_ptr<const tangible::TangiblePlan> plan;
    tangible::Plant plant;
    TangibleRunOptions options;
};

}  // namespace

TEST_CASE("tangible run: screens are told of each drive whether it is told a length") {
    const SmallRun run;
    CHECK_FALSE(body_of(*run.plan, "model").actuators.at(0).by_length);
    tangible::TangiblePlan plan = *run.plan;
    plan.loop.command = tangible::CommandKind::position;
    CHECK(body_of(plan, "model").actuators.at(0).by_length);
}

TEST_CASE("tangible run: on virtual time a seed gives the same log byte for byte, another seed another") {
    SmallRun run;
    const TemporaryFolder folder;
    std::vector<std::string> ticks, rows;
    for (const std::uint64_t seed : {1u, 1u, 2u}) {
        run.options.log = folder / std::to_string(ticks.size());
        run.options.seed = seed;
        std::filesystem::create_directories(run.options.log);
        const TangibleResult result = run_tangible_virtual(run.plan, run.plant, run.options);
        CHECK(result.logged);
        CHECK(result.ticks.ticks == 61);
        CHECK(tangible::force_rms_percent(result.ticks) < 3.0);
        ticks.push_back(files::read_text(run.options.log / "ticks.tsv"));
        rows.push_back(files::read_text(run.options.log / "press.tangible.tsv"));
    }
    CHECK(ticks[0] == ticks[1]);
    CHECK(rows[0] == rows[1]);
    CHECK(ticks[0] != ticks[2]);
}

TEST_CASE("tangible run: the devices are the soft device, its lines and its sensor") {
    const SmallRun run;
    for (const bool simulated : {true, false}) {
        std::string roles;
        for (const TactileDevice& device : devices_of(*run.plan, simulated)) {
            roles += device.role + " ";
            CHECK(device.port.empty() == (simulated || device.role == "soft device"));
        }
        CHECK(roles == "soft device motors sensor ");
    }
}

TEST_CASE("tangible run: a port that is named twice, or a path for two ports, is refused") {
    const SmallRun run;
    CHECK(tangible_rig(*run.plan->model, {"motors=/dev/pts/7"}).ports.front().path == "/dev/pts/7");
    CHECK_THROWS_WITH_AS(tangible_rig(*run.plan->model, {"motors=/dev/pts/7", "motors=/dev/pts/8"}),
                         doctest::Contains("--port: found 'motors' twice, expected each port once"), files::InputError);
    CHECK_THROWS_WITH_AS(tangible_rig(*run.plan->model, {"sensor=/dev/pts/7", "motors=/dev/pts/7"}),
                         doctest::Contains("--port: found '/dev/pts/7' for two ports of the device"),
                         files::InputError);
}

TEST_CASE("tangible live: a stop of the guard is named by its reason") {
    const SmallRun run;
    const TangibleSink sink(*run.plan, {}, {});
    TickRecord record;
    TangibleMoment moment;
    record.command.fault = tangible::TickFault::stopped;
    for (const devices::Fault guard : {devices::Fault::none, devices::Fault::stopped, devices::Fault::silence}) {
        record.guard = guard;
        fill_moment(record, sink, 100.0, moment);
        CHECK(moment.stopped);
        CHECK(moment.fault == devices::text(guard == devices::Fault::none ? devices::Fault::stopped : guard));
    }
}

TEST_CASE("tangible run: recorded rows give the same commands to the last bit") {
    SmallRun run;
    const TemporaryFolder folder;
    run.options.log = folder / "first";
    std::filesystem::create_directories(run.options.log);
    run_tangible_virtual(run.plan, run.plant, run.options);
    const auto rows =
        read_device_rows(run.options.log / "press.tangible.tsv", field_names<tangible::TangibleFeedback>());
    TangibleRunOptions again;
    again.log = folder / "again";
    std::filesystem::create_directories(again.log);
    const TangibleResult replayed = replay_tangible_rows(run.plan, rows, again);
    CHECK(replayed.ticks.ticks == 61);
    // all but the force that the plant gave
    const auto without_force = [](const std::string& text) {
        std::string out;
        std::size_t column = 0;
        for (const char c : text) {
            if (c == '\t') ++column;
            if (c == '\n') column = 0;
            if (column != 3) out.push_back(c);
        }
        return out;
    };
    CHECK(without_force(files::read_text(run.options.log / "ticks.tsv")) ==
          without_force(files::read_text(again.log / "ticks.tsv")));
}

TEST_CASE("tangible run: live on a plant in this process, without an allocation in the loop") {
    SmallRun run;
    run.options.finger.seconds = 0.5;
    const TangibleResult result = run_tangible_live(run.plan, run.plant, {}, run.options);
    CHECK(result.ticks.ticks > 3);
    CHECK(result.loop.refused_commands == 0);
    CHECK(result.loop.not_numbers == 0);
    CHECK_FALSE(result.cut);
    run.options.ends = [] { return true; };  // a person's Ctrl-C
    CHECK(run_tangible_live(run.plan, run.plant, {}, run.options).cut);
    if (!allocation_count_works()) return;
    PlantPort port(*run.plan, run.plant, run.options.finger, 1);
    auto loop = make_tangible_loop(run.plan);
    tangible::TangibleCommand command;
    for (int k = 0; k < 20; ++k) {
        const long before = allocation_count();
        const double time_s = 0.01 * k;
        tangible_step(time_s, nullptr, port.read(time_s), *loop, command);
        port.send(time_s, command);
        if (k > 3) CHECK(allocation_count() == before);
    }
}
