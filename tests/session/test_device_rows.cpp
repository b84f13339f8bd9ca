#include <bit>
#include <doctest/doctest.h>

#include "files/text.h"
#include "platform/trace.h"
#include "tests/error_message.h"
#include "tests/session/spring_device.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::session;
using namespace palpa::test;

namespace {

const std::vector<std::string> kFields = field_names<SpringDevice::Feedback>();

std::vector<DeviceRow> two_rows() {
    return {device_row(DeviceRowKind::hand_over, 12.5, PenContact{12.25, 0.06, -0.0, 1.0 / 3.0, 1e-300, 1e300, 1.0}),
            device_row(DeviceRowKind::feedback, 12.75, SpringDevice::Feedback{-2.0 / 3.0})};
}

void write_rows(const std::filesystem::path& tsv) {
    DeviceRowWriter writer(tsv, kFields);
    for (const DeviceRow& row : two_rows()) writer.write(row);
    CHECK(writer.sync());
}

// The rows, written and then changed as text.
std::string said(const std::string& from, const std::string& to) {
    const TemporaryFolder folder;
    write_rows(folder / "t.spring.tsv");
    std::string text = read_text(folder / "t.spring.tsv");
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    write_text_atomically(folder / "t.spring.tsv", text.replace(at, from.size(), to));
    return message_of([&] { read_device_rows(folder / "t.spring.tsv", kFields); });
}

}  // namespace

TEST_CASE("device rows: what is written reads back to the last bit") {
    const TemporaryFolder folder;
    const auto file = device_rows_of(folder / "t.tsv", "spring");
    CHECK(file == folder / "t.spring.tsv");
    write_rows(file);
    const std::vector<DeviceRow> rows = read_device_rows(file, kFields);
    REQUIRE(rows.size() == 2);
    for (std::size_t k = 0; k < 2; ++k) {
        CHECK(rows[k].kind == two_rows()[k].kind);
        CHECK(rows[k].time_s == two_rows()[k].time_s);
        for (std::size_t i = 0; i < kDeviceFields; ++i) {
            CAPTURE(i);
            CHECK(std::bit_cast<std::uint64_t>(rows[k].value[i]) ==
                  std::bit_cast<std::uint64_t>(two_rows()[k].value[i]));
        }
    }
    CHECK_THROWS_AS(DeviceRowWriter(file, kFields), std::runtime_error);  // nothing is overwritten
}

TEST_CASE("device rows: wrong kinds, numbers, columns and times are refused") {
    CHECK(said("feedback", "feedback") == "");
    CHECK(contains(said("feedback", "answer"),
                   "t.spring.tsv: line 3, row: found 'answer', expected feedback or hand_over"));
    CHECK(contains(said("0.06", "0,06"), "line 2, pen_x_m: found '0,06'"));
    CHECK(contains(said("0.06", "n/a"), "line 2, pen_x_m: found 'n/a'"));
    CHECK(contains(said("12.75", "12.25"), "line 3, time_s: found '12.25', expected a time not before the row above"));
    CHECK(contains(said("position_m", "place_m"), "expected a column 'position_m'"));
}

TEST_CASE("device rows: a trace's sidecar lists the loops, and refuses names that are no files beside it") {
    const TemporaryFolder folder;
    platform::TraceInfo info{1280, 800, platform::kMissing, platform::kMissing, "pen"};
    info.device_loops = {"spring", "arm-2"};
    {
        platform::TraceWriter writer(folder / "t.tsv", info);
        writer.write({});
    }
    const std::string sidecar = read_text(folder / "t.json");
    CHECK(platform::read_trace(folder / "t.tsv").info.device_loops == info.device_loops);
    for (const char* wrong : {"\"../arm\"", "\"\"", "\"spring\"", "3"}) {
        CAPTURE(wrong);
        std::string text = sidecar;
        text.replace(text.find("\"arm-2\""), 7, wrong);
        write_text_atomically(folder / "t.json", text);
        CHECK(contains(message_of([&] { platform::read_trace(folder / "t.tsv"); }), "t.json: device_loops: found"));
    }
}
