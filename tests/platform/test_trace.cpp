#include <cmath>
#include <doctest/doctest.h>

#include "files/text.h"
#include "platform/keyboard.h"
#include "platform/trace.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::platform;
using namespace palpa::test;

namespace {

Sample full() {
    Sample s;
    s.t_host_s = 1.0 / 3.0;
    s.t_device_s = 1e-9;
    s.pointer_id = -12;
    s.tool = Tool::finger;
    s.phase = Phase::cancel;
    s.x_px = 640.125;
    s.y_px = -0.5;
    s.pressure = 1.25;
    s.pressure_raw = 2047;
    s.tilt_x_deg = -30;
    s.height_px = 12.5;
    return s;
}

// A trace of one row, written and then changed as text.
std::string said(const std::string& from, const std::string& to, const char* file = "t.tsv") {
    const TemporaryFolder folder;
    {
        TraceWriter writer(folder / "t.tsv", {1280, 800, kMissing, kMissing, "d"});
        writer.write(full());
    }
    std::string text = read_text(folder / file);
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    write_text_atomically(folder / file, text.replace(at, from.size(), to));
    return message_of([&] { read_trace(folder / "t.tsv"); });
}

}  // namespace

TEST_CASE("trace: what is written reads back to the last bit, missing values stay missing") {
    const TemporaryFolder folder;
    {
        TraceWriter writer(folder / "t.tsv", {1280, 800, 276.5, 172.5, "pen \"x\""});
        writer.write(full());
        Sample ui;
        ui.phase = Phase::ui;
        ui.action = Action::resize;
        writer.write(ui);
        CHECK(writer.sync());
    }
    const Trace trace = read_trace(folder / "t.tsv");
    REQUIRE(trace.samples.size() == 2);
    const Sample& s = trace.samples[0];
    CHECK(s.t_host_s == 1.0 / 3.0);
    CHECK(s.t_device_s == 1e-9);
    CHECK(s.pointer_id == -12);
    CHECK(s.tool == Tool::finger);
    CHECK(s.phase == Phase::cancel);
    CHECK(s.pressure == 1.25);
    CHECK(std::isnan(s.width_px));
    CHECK(trace.samples[1].action == Action::resize);
    CHECK(trace.info.device == "pen \"x\"");
    CHECK(trace.info.screen_width_mm == 276.5);
    CHECK_THROWS_AS(TraceWriter(folder / "t.tsv", trace.info), InputError);  // nothing is overwritten
    write_text_atomically(folder / "scene.json", "{}");
    CHECK_THROWS_AS(TraceWriter(folder / "scene.tsv", trace.info), InputError);
    CHECK(read_text(folder / "scene.json") == "{}");
    CHECK_FALSE(std::filesystem::exists(folder / "scene.tsv"));
    CHECK_THROWS_AS(TraceWriter(folder / "only.json", trace.info), InputError);
}

TEST_CASE("trace: what the recorded trial was reads back; a trace without it says nothing") {
    const TemporaryFolder folder;
    TraceInfo info{1280, 800, kMissing, kMissing, "d"};
    const auto written = [&](const char* name) {
        TraceWriter(folder / name, info).write(full());
        return read_trace(folder / name).info;
    };
    const TraceInfo none = written("none.tsv");
    CHECK(none.mode.empty());
    CHECK(none.finger_offset_mm == 0.0);
    CHECK_FALSE(none.turn);
    CHECK(read_text(folder / "none.json").find("mode") == std::string::npos);
    info.mode = "test";
    info.finger_offset_mm = 15.0;
    info.turn = TissueTurn{270, true};
    info.parts = {{"a-edited.json", std::string(64, '0')}, {"b.json", std::string(64, 'f')}};
    const TraceInfo trial = written("trial.tsv");
    CHECK(trial.mode == "test");
    CHECK(trial.finger_offset_mm == 15.0);
    REQUIRE(trial.turn);
    CHECK(trial.turn->rotate_deg == 270);
    CHECK(trial.turn->flip);
    REQUIRE(trial.parts.size() == 2);
    CHECK(trial.parts[0].file == "a-edited.json");
    CHECK(trial.parts[1].sha256 == std::string(64, 'f'));
    const auto told = [&](const std::string& keys) {
        write_text_atomically(folder / "trial.json", R"({"screen_px": [1280, 800], )" + keys + "}");
        return message_of([&] { read_trace(folder / "trial.tsv"); });
    };
    CHECK(told(R"("mode": "practice")") == "");
    CHECK(contains(told(R"("mode": "tets")"), "trial.json: mode: found 'tets', expected"));
    CHECK(contains(told(R"("finger_offset_mm": -1)"), "trial.json: finger_offset_mm: found -1"));
    CHECK(contains(told(R"("mapping": {"rotate_deg": 45})"), "rotate_deg: found 45, expected 0, 90, 180 or 270"));
    CHECK(contains(told(R"("mapping": {"rotate_deg": 90, "kind": "direct"})"), "kind"));
}

TEST_CASE("hard case 31: a trace with wrong names, numbers, columns or no sidecar is refused") {
    CHECK(said("n/a", "n/a") == "");
    CHECK(contains(said("finger", "toe"), "t.tsv: line 2, tool: found 'toe'"));
    CHECK(contains(said("cancel", "fell"), "line 2, phase: found 'fell'"));
    CHECK(contains(said("-12", "1.5"), "line 2, pointer_id: found '1.5', expected a whole number"));
    CHECK(
        contains(said("640.125", "640,125"), "line 2, x_px: found '640,125', expected a number with a decimal point"));
    CHECK(contains(said("0.3333333333333333", "n/a"), "expected a time on every row"));
    CHECK(contains(said("0.3333333333333333", "1e18"), "below 1e9 s"));
    CHECK(contains(said("tilt_x_deg", "tilt"), "expected a column 'tilt_x_deg'"));
    CHECK(contains(said("\tfinger", ""), "line 2: found 13 fields, expected 14"));
    CHECK(contains(said("1280.0", "0.5", "t.json"), "t.json: screen_px: found 0.5"));
    CHECK(contains(said("screen_px", "screen", "t.json"), "t.json: screen: found an unknown key"));
    const TemporaryFolder folder;
    TraceWriter(folder / "whole.tsv", {}).write(full());
    std::filesystem::remove(folder / "whole.json");
    CHECK(contains(message_of([&] { read_trace(folder / "whole.tsv"); }), "whole.json: cannot be read"));
    write_text_atomically(folder / "t.tsv", "t_host_s\n");  // a table of another kind
    CHECK(contains(message_of([&] { read_trace(folder / "t.tsv"); }), "t.tsv: line 1: found"));
}

TEST_CASE("trace: the keyboard has a small number, and that of older traces is read as it") {
    const TemporaryFolder folder;
    Sample pressed = full();
    pressed.tool = Tool::keyboard;
    pressed.pointer_id = kKeyboardPointerId;
    {
        TraceWriter writer(folder / "t.tsv", {1280, 800, kMissing, kMissing, "d"});
        writer.write(pressed);
    }
    std::string text = read_text(folder / "t.tsv");
    const std::string now = "\t-1\tkeyboard";
    const auto at = text.find(now);
    REQUIRE(at != std::string::npos);
    CHECK(read_trace(folder / "t.tsv").samples[0].pointer_id == kKeyboardPointerId);
    write_text_atomically(folder / "t.tsv", text.replace(at, now.size(), "\t-9223372036854775808\tkeyboard"));
    CHECK(read_trace(folder / "t.tsv").samples[0].pointer_id == kKeyboardPointerId);
}
