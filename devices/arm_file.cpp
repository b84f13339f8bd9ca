// Device files of force arms.

#include "devices/device_json.h"
#include "files/text.h"

namespace palpa::devices {
namespace {

constexpr double kMm = 1e-3;

NetFtOptions read_sensor(files::JsonReader reader) {
    reader.only({"host", "port", "counts_per_N", "axis", "sign", "rate_Hz"});
    NetFtOptions sensor;
    sensor.host = reader.text("host", sensor.host);
    sensor.port = reader.integer("port", 1, 65535, sensor.port);
    sensor.counts_per_N = reader.number("counts_per_N", files::kPositive, sensor.counts_per_N);
    sensor.axis = static_cast<int>(reader.has("axis") ? reader.choice("axis", {"x", "y", "z"}) : 2);
    sensor.sign = reader.integer("sign", -1, 1, static_cast<int>(sensor.sign));
    if (sensor.sign == 0.0) reader.fail("sign", "0", "1 or -1: the sign of the axis that makes pressing positive");
    sensor.rate_Hz = reader.number("rate_Hz", {1.0, 20000.0}, sensor.rate_Hz);
    reader.finish();
    return sensor;
}

}  // namespace

ArmDevice read_arm_device(const std::filesystem::path& path) { return parse_arm_device(files::read_json(path), path); }

ArmDevice parse_arm_device(const files::Json& json, const std::filesystem::path& path) {
    files::JsonReader reader(json, path.string());
    reader.only({"kind", "name", "host", "port", "impedance", "range_mm", "force_N", "feedforward_N",
                 "force_slew_N_per_s", "depth_slew_mm_per_s", "speed_mm_per_s", "silence_ms", "sensor",
                 "compensation"});
    reader.choice("kind", {"arm"});
    ArmDevice arm;
    arm.name = reader.text("name", path.stem().string());
    arm.host = reader.text("host", arm.host);
    arm.port = reader.integer("port", 1, 65535, arm.port);
    if (reader.has("impedance"))
        arm.impedance = reader.choice("impedance", {"low", "high"}) == 0 ? ArmImpedance::low : ArmImpedance::high;
    if (reader.has("range_mm")) {
        const std::vector<double> range_mm = reader.numbers("range_mm", 2, {-1000.0, 1000.0});
        if (range_mm[0] > 0.0 || range_mm[1] <= 0.0)
            reader.fail("range_mm", files::short_number(range_mm[0]) + ", " + files::short_number(range_mm[1]),
                        "a range of the depth around 0, the tissue's surface");
        arm.lowest_m = kMm * range_mm[0];
        arm.deepest_m = kMm * range_mm[1];
    }
    arm.force_N = reader.number("force_N", {0.01, 100.0}, arm.force_N);
    arm.feedforward_N = reader.number("feedforward_N", {0.0, 100.0}, arm.feedforward_N);
    arm.force_slew_N_per_s = reader.number("force_slew_N_per_s", {1.0, 1e5}, arm.force_slew_N_per_s);
    arm.depth_slew_m_per_s = kMm * reader.number("depth_slew_mm_per_s", {1.0, 1e4}, arm.depth_slew_m_per_s / kMm);
    arm.speed_m_per_s = kMm * reader.number("speed_mm_per_s", {10.0, 1e4}, arm.speed_m_per_s / kMm);
    arm.silence_s = 1e-3 * reader.number("silence_ms", {10.0, 1000.0}, 1e3 * arm.silence_s);
    if (auto sensor = reader.optional_object("sensor")) arm.sensor = read_sensor(*sensor);
    if (const std::string file = reader.text("compensation", ""); !file.empty())
        arm.compensation = path.parent_path() / file;
    reader.finish();
    return arm;
}

files::Json arm_device_json(const ArmDevice& arm) {
    files::Json json{{"kind", "arm"},
                     {"name", arm.name},
                     {"host", arm.host},
                     {"port", arm.port},
                     {"impedance", arm.impedance == ArmImpedance::low ? "low" : "high"},
                     {"range_mm", {arm.lowest_m / kMm, arm.deepest_m / kMm}},
                     {"force_N", arm.force_N},
                     {"feedforward_N", arm.feedforward_N},
                     {"force_slew_N_per_s", arm.force_slew_N_per_s},
                     {"depth_slew_mm_per_s", arm.depth_slew_m_per_s / kMm},
                     {"speed_mm_per_s", arm.speed_m_per_s / kMm},
                     {"silence_ms", 1e3 * arm.silence_s}};
    if (arm.sensor) {
        constexpr const char* kAxes[]{"x", "y", "z"};
        json["sensor"] = {{"host", arm.sensor->host},
                          {"port", arm.sensor->port},
                          {"counts_per_N", arm.sensor->counts_per_N},
                          {"axis", kAxes[arm.sensor->axis]},
                          {"sign", arm.sensor->sign > 0.0 ? 1 : -1},
                          {"rate_Hz", arm.sensor->rate_Hz}};
    }
    return json;
}

std::string delay_warning(double stiffness_N_per_m, double loop_delay_s) {
    if (!(stiffness_N_per_m * loop_delay_s > kMostStiffnessDelay_N_s_per_m)) return {};
    return "a stiffness of " + files::short_number(1e-3 * stiffness_N_per_m) + " N/mm times a loop delay of " +
           files::short_number(1e3 * loop_delay_s) + " ms is " + files::short_number(stiffness_N_per_m * loop_delay_s) +
           " N s/m: above 8 the arm may oscillate under a soft hand";
}

}  // namespace palpa::devices
