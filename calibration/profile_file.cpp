#include "calibration/profile_file.h"

#include <cmath>

#include "files/input_error.h"
#include "files/json.h"
#include "files/text.h"

namespace palpa {
namespace {

DeviceNames read_device(JsonReader json) {
    DeviceNames device;
    device.pen = json.text("pen", "n/a");
    device.tablet = json.text("tablet", "n/a");
    device.driver = json.text("driver", "n/a");
    device.os = json.text("os", "n/a");
    device.date = json.text("date", "n/a");
    json.finish();
    return device;
}

std::vector<CalibrationPoint> read_points(JsonReader json) {
    const auto level = json.numbers("level", 0, kAnyNumber);
    const auto force_N = json.numbers("force_N", level.size(), kAnyNumber);
    json.finish();
    std::vector<CalibrationPoint> points;
    for (std::size_t i = 0; i < level.size(); ++i) points.push_back({level[i], force_N[i]});
    return points;
}

}  // namespace

Profile read_profile(const std::filesystem::path& path) {
    const Json root = read_json(path);
    JsonReader json(root, path.string());
    Profile profile;
    profile.id = path.stem().string();
    profile.device = read_device(json.object("device"));
    json.choice("model", {"exponential"});
    JsonReader parameters = json.object("parameters");
    profile.curve.a_N = parameters.number("a_N", {0.0, 1e3, true});
    profile.curve.b = parameters.number("b", {0.0, 1e3, true});
    parameters.finish();
    profile.level = static_cast<LevelField>(json.choice("level", {"pressure", "pressure_raw", "contact_area"}));
    const auto range = json.numbers("level_range", 2, {0.0, 1e9});
    if (!(range[0] < range[1])) {
        json.fail("level_range", "[" + short_number(range[0]) + ", " + short_number(range[1]) + "]",
                  "the lower level first");
    }
    profile.level_lowest = range[0];
    profile.level_highest = range[1];
    if (profile.level == LevelField::contact_area) {
        profile.full_contact_area_px2 = json.number("full_contact_area_px2", {0.0, 1e9, true});
    }
    if (json.has("quality")) json.any("quality");  // how good the fit was: kept for people
    if (json.has("points")) profile.points = read_points(json.object("points"));
    json.finish();

    const double highest_N = profile.curve.a_N * std::exp(profile.curve.b * profile.level_highest);
    constexpr double kAbsurd_N = 1000.0;
    if (!(highest_N < kAbsurd_N)) {
        json.fail("parameters", short_number(highest_N) + " N at the highest level",
                  "less than 1000 N (is b per count where level_range is 0 ... 1, or the other way round?)");
    }
    return profile;
}

}  // namespace palpa
