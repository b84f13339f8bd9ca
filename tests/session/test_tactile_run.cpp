#include <algorithm>
#include <chrono>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <thread>

#include "files/table.h"
#include "session/tactile_run.h"
#include "session/tactile_run_sink.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/mechanics/allocation_count.h"
#include "tests/tactile/tactile_scene.h"

using namespace palpa;
using namespace palpa::session;
using namespace palpa::test;

namespace {

// Presses of 4 mm at up to 20 mm/s, and one beyond the force limit.
std::vector<devices::PressRow> a_press(bool by_force = false) {
    std::vector<devices::PressRow> rows;
    for (int k = 0; k <= 200; ++k) {
        devices::PressRow row;
        row.t_s = 0.01 * k;
        row.x_m = 0.02 + 1e-5 * k;
        row.y_m = 0.02;
        const double share = 0.5 - 0.5 * std::cos(10.0 * std::max(0.0, row.t_s - 0.3));  // 0.3 s without touch
        if (by_force)
            row.force_N = 3.0 * share;
        else
            row.depth_m = (k < 155 ? 4e-3 : 9e-3) * share;
        rows.push_back(row);
    }
    return rows;
}

std::string file_text(const std::filesystem::path& file) { return files::read_text(file); }

const char* const kArmLeads =
    R"({"arm": {"device": "arm.json"}, "display": {"device": "pins-6x6.json"}, "leads": "arm"})";

}  // namespace

TEST_CASE("tactile run: where the touch leads, the log is a function of the press") {
    const TactileScene slab;
    const TemporaryFolder folder;
    std::vector<std::string> steps, pins;
    for (const std::uint64_t seed : {1u, 2u}) {  // another simulated arm and other pins: the same log
        const auto log = folder / std::to_string(seed);
        std::filesystem::create_directories(log);
        const TactileResult result = run_virtual(slab.tactile_plan(), {a_press(), log, seed});
        CHECK(result.logged);
        CHECK(result.steps.steps == 2001);
        CHECK(result.steps.held_steps > 0);
        CHECK(result.steps.max_force_N <= 2.5);
        CHECK(result.devices.guard.fault == devices::Fault::none);
        steps.push_back(file_text(log / "steps.tsv"));
        pins.push_back(file_text(log / "pins.tsv"));
    }
    CHECK(steps[0] == steps[1]);
    CHECK(pins[0] == pins[1]);
    auto another = a_press();
    another[100].depth_m += 1e-5;
    run_virtual(slab.tactile_plan(), {another, folder.path(), 1});
    CHECK(file_text(folder / "steps.tsv") != steps[0]);
}

TEST_CASE("tactile run: where the arm leads, replaying the recorded rows gives the same log") {
    const TactileScene slab(kArmLeads);
    const TemporaryFolder folder;
    const auto live = folder / "live", again = folder / "again";
    std::filesystem::create_directories(live);
    std::filesystem::create_directories(again);
    const TactileResult result = run_virtual(slab.tactile_plan(), {a_press(), live, 3});
    CHECK(result.steps.max_depth_m > 1e-3);  // the hand moved the arm
    const auto rows = read_device_rows(live / "press.tactile.tsv", field_names<tactile::LoopFeedback>());
    const TactileResult replayed = replay_rows(slab.tactile_plan(), rows, {{}, again, 1});
    CHECK(replayed.steps.steps == result.steps.steps);
    CHECK(file_text(again / "steps.tsv") == file_text(live / "steps.tsv"));
    CHECK(file_text(again / "pins.tsv") == file_text(live / "pins.tsv"));
    // another arm moves otherwise
    const auto other = folder / "other";
    std::filesystem::create_directories(other);
    run_virtual(slab.tactile_plan(), {a_press(), other, 4});
    CHECK(file_text(other / "steps.tsv") != file_text(live / "steps.tsv"));
}

TEST_CASE("tactile run: lead halves the mismatch of free at 20 mm/s") {
    const TactileScene slab;
    double rms_m[2] = {0.0, 0.0};
    for (const auto schedule : {scene::PinSchedule::free, scene::PinSchedule::lead}) {
        auto plan = slab.tactile_plan();
        plan->options.display->schedule = schedule;
        std::vector<devices::PressRow> press = a_press();
        press.resize(155);  // those of 20 mm/s
        const TactileResult result = run_virtual(plan, {press, {}, 1});
        rms_m[schedule == scene::PinSchedule::lead ? 1 : 0] = tactile::rms_m(result.mismatch);
        CHECK(std::string(result.devices.reached_by) == "simulator");
    }
    CAPTURE(rms_m[0]);
    CAPTURE(rms_m[1]);
    CHECK(rms_m[1] <= 0.5 * rms_m[0]);
    CHECK(rms_m[1] > 0.0);
}

TEST_CASE("tactile run: the time at which a press begins, also one before 0, changes nothing that the pins do") {
    const TactileScene slab;
    double rms_m[2] = {0.0, 0.0};
    for (const double begins_s : {0.0, -5.0}) {
        std::vector<devices::PressRow> press = a_press();
        for (devices::PressRow& row : press) row.t_s += begins_s;
        rms_m[begins_s < 0.0 ? 1 : 0] = tactile::rms_m(run_virtual(slab.tactile_plan(), {press, {}, 1}).mismatch);
    }
    CHECK(rms_m[0] > 0.0);
    CHECK(rms_m[1] == close_to(rms_m[0]).epsilon(1e-6));
}

TEST_CASE("tactile run: a press by force is pressed by force") {
    const TactileScene slab;
    auto plan = slab.tactile_plan();
    const auto press = a_press(true);
    choose_input(press, *plan);
    CHECK(plan->input == tactile::InputKind::force);
    const TemporaryFolder folder;
    const auto log = folder / "log", again = folder / "again";
    for (const auto& one : {log, again}) std::filesystem::create_directories(one);
    const TactileResult result = run_virtual(plan, {press, log, 1});
    CHECK(result.steps.max_force_N == close_to(2.5));
    CHECK(result.steps.held_steps > 0);
    CHECK(result.steps.held_steps < result.steps.steps / 2);

    // nothing but its rows says so when it is replayed
    const auto rows = read_device_rows(log / "press.tactile.tsv", field_names<tactile::LoopFeedback>());
    auto replays = slab.tactile_plan();
    choose_input(rows, *replays);
    CHECK(replay_rows(replays, rows, {{}, again, 1}).steps.max_force_N == close_to(2.5));
    CHECK(file_text(again / "steps.tsv") == file_text(log / "steps.tsv"));
    run_virtual(slab.tactile_plan(), {a_press(), folder.path(), 1});
    choose_input(read_device_rows(folder / "press.tactile.tsv", field_names<tactile::LoopFeedback>()), *replays);
    CHECK(replays->input == tactile::InputKind::depth);
}

TEST_CASE("tactile run: a press for a simulated participant: force, depth and true heights, every ms") {
    const TactileScene slab(kArmLeads);
    const auto press = a_press();
    const TactileRecord record = run_press(slab.scene, *slab.plan, press, {});
    CHECK(record.pins == 36);
    CHECK(record.time_s.size() == 2001);
    CHECK(record.force_N.size() == record.time_s.size());
    CHECK(record.height_m.size() == 36 * record.time_s.size());
    // the arm's own weight is not compensated here, so that the hand has to carry it
    const auto [least_N, most_N] = std::minmax_element(record.force_N.begin(), record.force_N.end());
    CHECK(*most_N - *least_N > 0.5);
    CHECK(*std::max_element(record.depth_m.begin(), record.depth_m.end()) > 5e-3);
    for (const double height_m : record.height_m) {
        CHECK(height_m >= -1e-9);
        CHECK(height_m <= 2e-3 + 1e-9);
    }
    const TactileRecord locked = run_press(slab.scene, *slab.plan, press, {1, scene::PinSchedule::locked});
    CHECK(locked.height_m.back() == close_to(2e-3).epsilon(1e-3));
}

// A port that says what a test wants.
struct ScriptedPort {
    tactile::LoopFeedback next;
    bool read(tactile::LoopFeedback& out) noexcept {
        out = next;
        return true;
    }
};

TEST_CASE("tactile run: NaN from the arm is neither run nor recorded, and no command follows") {
    const TactileScene slab(kArmLeads);
    const auto loop = make_tactile_loop(slab.tactile_plan());
    ScriptedPort port;
    tactile::LoopCommand command;
    CHECK(tactile_step(0.0, nullptr, port, *loop, command));
    port.next.arm.depth_m = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(tactile_step(1e-3, nullptr, port, *loop, command));
    CHECK(loop->report.not_numbers == 1);
    PenContact contact;
    contact.depth_m = std::numeric_limits<double>::infinity();
    port.next.arm.depth_m = 0.0;
    CHECK(tactile_step(2e-3, &contact, port, *loop, command));
    CHECK(loop->report.not_numbers == 2);
    CHECK(loop->report.hand_overs == 0);
    int rows = 0;
    for (DeviceRow row; loop->recorded.take(row);) ++rows;
    CHECK(rows == 2);
}

TEST_CASE("tactile run: link silent: after 100 ms the force is zero and the pins rest, and both come back") {
    const TactileScene slab(kArmLeads);
    const auto plan = slab.tactile_plan();
    tactile::Guarded guarded = tactile::guarded_of(*plan);
    devices::ArmFeedback arm;
    tactile::LoopCommand wanted;
    wanted.pins = 36;
    wanted.arm.mode = static_cast<double>(devices::ArmMode::force);
    wanted.arm.force_N = 1.0;
    wanted.pins_m.fill(1e-3);
    tactile::LoopCommand sent;
    const auto run = [&](double from_s, double to_s, bool heard) {
        for (double t_s = from_s; t_s < to_s; t_s += 1e-3) {
            sent = wanted;
            tactile::guard_command(t_s, heard, &arm, devices::Fault::none, sent, guarded);
        }
    };
    run(0.0, 0.5, true);
    CHECK(sent.arm.force_N == close_to(1.0));
    CHECK(sent.pins_m[0] == close_to(1e-3));
    run(0.5, 0.55, false);
    CHECK(sent.arm.force_N == close_to(1.0));  // not yet
    run(0.55, 0.62, false);
    CHECK(sent.arm.force_N == 0.0);
    CHECK(sent.pins_m[0] == plan->pin_rest_m);
    CHECK(guarded.guard.fault == devices::Fault::silence);
    run(0.62, 1.2, true);
    CHECK(sent.arm.force_N == close_to(1.0));
    CHECK(sent.pins_m[0] == close_to(1e-3));
}

TEST_CASE("tactile run: user faster than everything: what is sent stays within limits and slews") {
    const TactileScene slab(kArmLeads);
    const auto plan = slab.tactile_plan();
    auto loop = make_tactile_loop(plan);
    tactile::Guarded guarded = tactile::guarded_of(*plan);
    ScriptedPort port;
    tactile::LoopCommand command;
    double last_N = 0.0;
    for (int k = 0; k < 3000; ++k) {
        const double time_s = 1e-3 * k;
        port.next.arm.depth_m = 0.03 * std::sin(60.0 * time_s);  // 1.8 m/s
        port.next.arm.x_m = 0.02 + 0.5 * std::sin(31.0 * time_s);
        port.next.arm.y_m = 0.02;
        port.next.arm.velocity_m_per_s = 1.8 * std::cos(60.0 * time_s);
        if (!tactile_step(time_s, nullptr, port, *loop, command)) continue;
        tactile::guard_command(time_s, true, &port.next.arm, devices::Fault::none, command, guarded);
        CHECK(command.arm.force_N >= 0.0);
        CHECK(command.arm.force_N <= 2.5);
        CHECK(command.arm.force_N - last_N <= plan->arm->force_slew_N_per_s * 1e-3 + 1e-9);
        last_N = command.arm.force_N;
        for (std::size_t i = 0; i < 36; ++i) {
            CHECK(command.pins_m[i] >= 0.0);
            CHECK(command.pins_m[i] <= 2e-3);
        }
    }
}

TEST_CASE("tactile run: missing ports are named") {
    TactileScene slab;
    const auto missing = missing_ports(*slab.scene.tactile);
    bool pins = false;
    for (const std::string& line : missing) pins = pins || contains(line, "/dev/ttyUSB0");
    CHECK(pins);
    CHECK(missing_ports(*TactileScene(R"({"display": {}})").scene.tactile).empty());
}

TEST_CASE("tactile run: when a fault began and ended stands in a file of its own") {
    const TactileScene slab;
    const TemporaryFolder folder;
    const auto plan = slab.tactile_plan();
    {
        TactileSink sink(*plan, folder.path(), {});
        StepRecord record;
        for (int k = 0; k < 100; ++k) {
            record.command.time_s = 1e-3 * k;
            record.fault = k >= 20 && k < 60 ? devices::Fault::stopped : devices::Fault::none;
            if (k >= 80) record.fault = devices::Fault::silence;
            record.fault_words = k >= 80 ? "nothing comes from the pins" : "";
            sink.take(record, {});
        }
        sink.finish({});
        CHECK(sink.result.logged);
        CHECK(sink.result.steps.relaxed_steps == 62);  // and each one before, whose command the guard had replaced
    }
    const std::string began = "time_s\tfault\n0.02\t" + std::string(devices::text(devices::Fault::stopped));
    CHECK(file_text(folder / "faults.tsv") == began + "\n0.06\tnone\n0.08\tnothing comes from the pins\n");
}

TEST_CASE(
    "tactile run: a press beyond the arm's range in virtual time rests from its fault on, and nothing of that counts") {
    const TactileScene slab(kArmLeads);
    const TemporaryFolder folder;
    const auto row = [](double t_s, double depth_m) {
        devices::PressRow out;
        out.t_s = t_s;
        out.x_m = out.y_m = 0.02;
        out.depth_m = depth_m;
        return out;
    };
    const std::vector<devices::PressRow> press{row(0.0, 0.0), row(1.0, 0.1), row(2.0, 0.1)};  // as if 100 mm were meant
    const TactileResult result = run_virtual(slab.tactile_plan(), {press, folder.path(), 1});
    CHECK(result.devices.guard.fault == devices::Fault::out_of_range);
    CHECK(result.steps.relaxed_steps > 1000);
    CHECK(result.steps.held_steps < 1000);
    CHECK(contains(file_text(folder / "faults.tsv"), "\tthe arm reports a depth outside of its range\n"));
}

TEST_CASE("tactile run: a step with its guard allocates nothing") {
    const TactileScene slab;
    const auto loop = make_tactile_loop(slab.tactile_plan());
    tactile::Guarded guarded = tactile::guarded_of(*loop->plan);
    ScriptedPort port;
    tactile::LoopCommand command;
    const auto press = a_press();
    std::size_t at = 0;
    long before = 0;
    for (int k = 0; k < 2000; ++k) {
        if (k == 10) before = allocation_count();
        PenContact contact = contact_of(devices::press_at(press, 1e-3 * k, at));
        contact.time_s = 1e-3 * k;
        if (tactile_step(contact.time_s, &contact, port, *loop, command))
            tactile::guard_command(contact.time_s, true, &port.next.arm, devices::Fault::none, command, guarded);
    }
    CHECK(allocation_count() == before);
}

TEST_CASE("tactile run: a pressure display is logged, and its pressures add up to the force") {
    const TactileScene slab(R"({"finger": {"contact": "rigid"}, "display": {"kind": "pressure"}})");
    const TemporaryFolder folder;
    const TactileResult result = run_virtual(slab.tactile_plan(), {a_press(), folder.path(), 1});
    CHECK(result.steps.steps == 2001);
    CHECK_FALSE(std::filesystem::exists(folder / "pins.tsv"));
    files::Table steps = files::read_tsv(folder / "steps.tsv");
    files::Table pressures = files::read_tsv(folder / "pressures.tsv");
    double most_N = 0.0, most_Pa = 0.0;
    while (steps.next()) most_N = std::max(most_N, steps.finite_number(steps.column("force_N")));
    while (pressures.next()) {
        for (std::size_t i = 1; i <= 36; ++i) most_Pa = std::max(most_Pa, pressures.finite_number(i));
    }
    CHECK(most_N > 1.0);
    CHECK(most_Pa > 1e3);
    CHECK(most_Pa < 1e6);
}

TEST_CASE("tactile run: a table that becomes ready during a run is a row of the input, and replays") {
    const TactileScene slab(R"({"display": {"device": "pins-6x6.json"}, "table": {"spacing_mm": 4, "error": 0.02}})");
    auto plan = slab.tactile_plan();
    tactile::make_table_now({}, {}, *plan);
    REQUIRE(plan->table);
    const auto press = a_press();
    DeviceMemory<TactileLoop> memory;
    memory.state = tactile::make_loop_state(*plan);
    std::vector<DeviceRow> rows;
    std::vector<double> force_N;
    std::size_t at = 0;
    for (int k = 0; k < 1000; ++k) {
        PenContact contact = contact_of(devices::press_at(press, 1e-3 * k, at));
        contact.time_s = 1e-3 * k;
        rows.push_back(device_row(DeviceRowKind::hand_over, contact.time_s, contact));
        tactile::LoopFeedback feedback;
        feedback.by_table = k < 500 ? 0.0 : 1.0;
        rows.push_back(device_row(DeviceRowKind::feedback, contact.time_s, feedback));
    }
    for (const bool again : {false, true}) {
        std::size_t k = 0;
        memory = {};
        memory.state = tactile::make_loop_state(*plan);
        replay_device<TactileLoop>(plan, rows, memory, [&](const tactile::LoopCommand& command, double) {
            if (again)
                CHECK(command.force_N == force_N[k++]);
            else
                force_N.push_back(command.force_N);
        });
        CHECK(memory.state.now.table == plan->table.get());
    }
    CHECK(force_N.size() == 1000);
}

TEST_CASE("tactile live: the loop goes over to a table that a worker makes meanwhile") {
    const TactileScene slab(R"({"arm": {"device": "arm.json"}, "table": {"spacing_mm": 10, "error": 0.5}})");
    const auto plan = slab.tactile_plan();
    tactile::make_table_meanwhile({}, *plan);
    const auto loop = make_tactile_loop(plan);
    ScriptedPort port;
    tactile::LoopCommand command;
    bool by_table = false;
    for (int k = 0; k < 60000 && !by_table; ++k) {
        const PenContact contact{1e-3 * k, 0.02, 0.02, 1e-3, 0.0, 0.0, 1.0};
        tactile_step(contact.time_s, &contact, port, *loop, command);
        by_table = loop->memory.state.now.table != nullptr;
        CHECK(std::isfinite(command.force_N));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    CHECK(by_table);
}

TEST_CASE("tactile live: a silence names the device that does not answer") {
    using devices::Fault;
    const auto words = [](Fault fault, const Silent& silent) { return std::string(fault_words(fault, silent)); };
    CHECK(words(Fault::none, {true, false, true}).empty());
    CHECK(words(Fault::silence, {}) == "nothing comes from a device");
    CHECK(words(Fault::silence, {true, true, false}) == "nothing comes from the arm");
    CHECK(words(Fault::silence, {false, true, false}) == "nothing comes from the force sensor");
    CHECK(words(Fault::silence, {false, false, true}) == "nothing comes from the pins");
    CHECK(words(Fault::silence, {true, false, true}) == "nothing comes from the arm, nor from the pins");
    CHECK(words(Fault::silence, {false, true, true}) == "nothing comes from the force sensor, nor from the pins");
    CHECK(words(Fault::stopped, {true, false, false}) == "stopped");
}

TEST_CASE("tactile live: a pen presses by force; F12 holds until a person goes on; rows are recorded") {
    const TactileScene slab(R"({"display": {}})");  // pins that are only drawn: nothing to open
    const TemporaryFolder folder;
    TactileLiveOptions options;
    options.rows = folder / "t.tactile.tsv";
    TactileLive live(slab.scene, slab.plan, options);
    TactileMoment moment;
    // Presses until the loop says what is expected; on a busy machine that takes longer.
    const auto press_until = [&](double force_N, auto&& expected) {
        for (int k = 0; k < 6000 && !expected(); ++k) {
            live.hand_over({5e-3 * k, 0.02, 0.02, 0.0, force_N, 0.0, 1.0});
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            live.latest(moment);
        }
    };
    press_until(1.0, [&] { return moment.force_N == close_to(1.0); });
    CHECK(moment.force_N == close_to(1.0));
    CHECK(moment.rows == 6);
    CHECK(moment.reached == ReachedBy::estimate);
    CHECK(std::string(moment.fault) == "");
    press_until(9.0, [&] { return moment.held && moment.force_N == close_to(2.5); });
    CHECK(moment.held);
    CHECK(moment.force_N == close_to(2.5));
    live.stop();
    press_until(1.0, [&] { return moment.stopped && moment.force_N == 0.0; });
    CHECK(moment.force_N == 0.0);
    CHECK(moment.stopped);
    CHECK(std::string(moment.fault) == "stopped");
    live.restart();
    press_until(1.0, [&] { return !moment.stopped && moment.force_N == close_to(1.0); });
    CHECK(moment.force_N == close_to(1.0));
    CHECK_FALSE(moment.stopped);
    const files::Json report = live.report();
    CHECK(report["held_steps"].get<int>() > 0);
    CHECK(report["faults"][0]["fault"] == "stopped");
    CHECK(live.devices().empty());
    const auto rows = read_device_rows(folder / "t.tactile.tsv", field_names<tactile::LoopFeedback>());
    CHECK(rows.size() >= 4);  // one for each force, at least
}
