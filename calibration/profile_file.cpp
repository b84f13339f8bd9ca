#include "calibration/profile_file.h"

#include <cmath>

#include "files/input_error.h"
#include "files/text.h"

namespace palpa::calibration {
namespace {

DeviceNames read_device(files::JsonReader json) {
    json.only({"pen", "tablet", "driver", "os", "date"});
    DeviceNames device;
    device.pen = json.text("pen", "n/a");
    device.tablet = json.text("tablet", "n/a");
    device.driver = json.text("driver", "n/a");
    device.os = json.text("os", "n/a");
    device.date = json.text("date", "n/a");
    json.finish();
    return device;
}

std::vector<CalibrationPoint> read_points(files::JsonReader json) {
    json.only({"level", "force_N"});
    const auto level = json.numbers("level", 0, files::kAnyNumber);
    const auto force_N = json.numbers("force_N", level.size(), files::kAnyNumber);
    json.finish();
    std::vector<CalibrationPoint> points;
    for (std::size_t i = 0; i < level.size(); ++i) points.push_back({level[i], force_N[i]});
    return points;
}

void must_rise(const files::JsonReader& json, std::string_view key, const std::vector<double>& values) {
    for (std::size_t i = 1; i < values.size(); ++i) {
        if (values[i] > values[i - 1]) continue;
        json.fail(key, files::short_number(values[i]) + " after " + files::short_number(values[i - 1]),
                  "numbers that rise");
    }
}

Curve read_cubic(files::JsonReader& json) {
    json.only({"level", "force_N"});
    std::vector<double> level = json.numbers("level", 0, {0.0, 1e9});
    if (level.size() < 2) json.fail("level", "one number", "two at least");
    std::vector<double> force_N = json.numbers("force_N", level.size(), {0.0, 1e3, true});
    must_rise(json, "level", level);
    must_rise(json, "force_N", force_N);
    return monotone_cubic(std::move(level), std::move(force_N));
}

Curve read_curve(CurveModel model, files::JsonReader json) {
    constexpr files::Bounds kUsable{0.0, 1e3, true};
    constexpr double kGreatest = 1e6;  // a nearly straight exponential_offset has a large a_N and offset_N
    Curve curve;
    switch (model) {
        case CurveModel::exponential:
            json.only({"a_N", "b"});
            curve.a_N = json.number("a_N", kUsable);
            curve.b = json.number("b", kUsable);
            break;
        case CurveModel::exponential_offset:
            json.only({"a_N", "b", "offset_N"});
            curve.a_N = json.number("a_N", {-kGreatest, kGreatest});
            curve.b = json.number("b", {-1e3, 1e3});
            curve.offset_N = json.number("offset_N", {-kGreatest, kGreatest});
            if (!(curve.a_N * curve.b > 0.0)) {
                json.fail("b", files::short_number(curve.b),
                          "not 0, and the sign of a_N (" + files::short_number(curve.a_N) + "): the curve must rise");
            }
            break;
        case CurveModel::power:
            json.only({"a_N", "b"});
            curve.a_N = json.number("a_N", {0.0, 1e300, true});  // N per level^b, tiny or huge if levels are counts
            curve.b = json.number("b", {0.0, 1e2, true});
            break;
        case CurveModel::monotone_cubic:
            curve = read_cubic(json);
            break;
    }
    curve.model = model;
    json.finish();
    return curve;
}

void read_range(files::JsonReader& json, std::string_view key, double& lowest, double& highest) {
    const auto range = json.numbers(key, 2, {0.0, 1e9});
    if (!(range[0] < range[1])) {
        json.fail(key, "[" + files::short_number(range[0]) + ", " + files::short_number(range[1]) + "]",
                  "the lower level first");
    }
    lowest = range[0];
    highest = range[1];
}

// Throws InputError for a curve of 1000 N or more, which is a mistake of units, and for one that does not rise above 0.
void check_values(const files::JsonReader& json, const Profile& profile) {
    constexpr double kAbsurd_N = 1000.0;
    const double lowest_N = value_N(profile.curve, profile.level_lowest);
    const double highest_N = value_N(profile.curve, profile.level_highest);
    if (!(highest_N < kAbsurd_N)) {
        json.fail("parameters", files::short_number(highest_N) + " N at the highest level",
                  "less than 1000 N (is b per count where level_range is 0 ... 1, or the other way round?)");
    }
    if (!(highest_N > std::max(lowest_N, 0.0))) {
        json.fail("parameters",
                  files::short_number(lowest_N) + " N at the lowest and " + files::short_number(highest_N) +
                      " N at the highest level",
                  "a force that rises above 0");
    }
}

Profile parse_profile(const files::Json& root, const std::filesystem::path& path) {
    files::JsonReader json(root, path.string());
    json.only({"device", "model", "parameters", "level", "level_range", "fitted_range", "full_contact_area_px2",
               "quality", "points"});
    Profile profile;
    profile.id = path.stem().string();
    profile.device = read_device(json.object("device"));
    const auto model = json.choice("model", {"exponential", "exponential_offset", "power", "monotone_cubic"});
    profile.curve = read_curve(static_cast<CurveModel>(model), json.object("parameters"));
    profile.level = static_cast<LevelField>(json.choice("level", {"pressure", "pressure_raw", "contact_area"}));
    read_range(json, "level_range", profile.level_lowest, profile.level_highest);
    if (json.has("fitted_range")) read_range(json, "fitted_range", profile.fitted_lowest, profile.fitted_highest);
    if (profile.level == LevelField::contact_area) {
        profile.full_contact_area_px2 = json.number("full_contact_area_px2", {0.0, 1e9, true});
    }
    if (json.has("quality")) {
        const files::Json& quality = json.any("quality");
        if (quality.is_object() && quality.contains("median_relative_error") &&
            quality["median_relative_error"].is_number()) {
            profile.median_relative_error = quality["median_relative_error"].get<double>();
        }
    }
    if (json.has("points")) profile.points = read_points(json.object("points"));
    json.finish();
    check_values(json, profile);
    return profile;
}

}  // namespace

Profile read_profile(const std::filesystem::path& path) { return parse_profile(files::read_json(path), path); }

files::Json parameters_json(const Curve& curve) {
    switch (curve.model) {
        case CurveModel::exponential:
        case CurveModel::power:
            return {{"a_N", curve.a_N}, {"b", curve.b}};
        case CurveModel::exponential_offset:
            return {{"a_N", curve.a_N}, {"b", curve.b}, {"offset_N", curve.offset_N}};
        case CurveModel::monotone_cubic:
            return {{"level", curve.knot_level}, {"force_N", curve.knot_N}};
    }
    return {};
}

files::Json profile_json(const Profile& profile, const files::Json& quality) {
    const DeviceNames& device = profile.device;
    files::Json json;
    json["device"] = {{"pen", device.pen},
                      {"tablet", device.tablet},
                      {"driver", device.driver},
                      {"os", device.os},
                      {"date", device.date}};
    json["model"] = name_of(profile.curve.model);
    json["parameters"] = parameters_json(profile.curve);
    json["level"] = name_of(profile.level);
    if (profile.level == LevelField::contact_area) json["full_contact_area_px2"] = profile.full_contact_area_px2;
    json["level_range"] = {profile.level_lowest, profile.level_highest};
    if (!std::isnan(profile.fitted_lowest)) json["fitted_range"] = {profile.fitted_lowest, profile.fitted_highest};
    json["quality"] = quality;
    if (!profile.points.empty()) {
        files::Json level = files::Json::array();
        files::Json force_N = files::Json::array();
        for (const CalibrationPoint& point : profile.points) {
            level.push_back(point.level);
            force_N.push_back(point.force_N);
        }
        json["points"] = {{"level", level}, {"force_N", force_N}};
    }
    return json;
}

void write_profile(const Profile& profile, const files::Json& quality, const std::filesystem::path& path) {
    const files::Json json = profile_json(profile, quality);
    parse_profile(json, path);  // what no reader takes is not written
    files::write_text_atomically(path, files::json_text(json));
}

}  // namespace palpa::calibration
