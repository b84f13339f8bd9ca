#include <doctest/doctest.h>

#include "calibration/profile_file.h"
#include "files/text.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::calibration;
using namespace palpa::test;

namespace {

std::string with(const std::string& from, const std::string& to) {
    std::string text = R"({"device": {"pen": "p"}, "model": "exponential", "parameters": {"a_N": 0.1, "b": 4.2},
                          "level": "pressure", "level_range": [0, 1]})";
    if (const auto at = text.find(from); !from.empty() && at != std::string::npos) text.replace(at, from.size(), to);
    return text;
}

std::string refusal_of_profile(const std::string& text) {
    const TemporaryFolder folder;
    write_text_atomically(folder / "p.json", text);
    return message_of([&] { read_profile(folder / "p.json"); });
}

}  // namespace

TEST_CASE("hard case 3: profiles that are no usable curve are refused by key") {
    CHECK(refusal_of_profile(with("", "")) == "");
    CHECK(contains(refusal_of_profile(with("0.1", "-0.1")), "p.json: parameters.a_N: found -0.1"));
    CHECK(contains(refusal_of_profile(with("4.2", "0")), "parameters.b: found 0"));
    CHECK(contains(refusal_of_profile(with("4.2", "null")), "parameters.b: found null"));
    CHECK(contains(refusal_of_profile(with("[0, 1]", "[1, 0]")), "expected the lower level first"));
    CHECK(contains(refusal_of_profile(with("[0, 1]", "[0, 0]")), "expected the lower level first"));
    CHECK(contains(refusal_of_profile(with("[0, 1]", "[0, 1023]")), "N at the highest level"));
    CHECK(contains(refusal_of_profile(with("exponential", "linear")), "model: found 'linear'"));
    CHECK(contains(refusal_of_profile(with("\"pressure\"", "\"force\"")), "level: found 'force'"));
    CHECK(
        contains(refusal_of_profile(with("\"pressure\"", "\"contact_area\"")), "full_contact_area_px2: found nothing"));
    CHECK(contains(refusal_of_profile(with("4.2}", "4.2")), "p.json"));
    CHECK(contains(refusal_of_profile(with("\"model\"", "\"modle\": 1, \"model\"")), "modle: found an unknown key"));
}

TEST_CASE("profile file: points need as many levels as forces") {
    const std::string points = R"("points": {"level": [0, 0.5], "force_N": [0.1]}, "model")";
    CHECK(contains(refusal_of_profile(with("\"model\"", points)),
                   "points.force_N: found an array of 1, expected an array of 2 numbers"));
}

namespace {

std::string of_model(const std::string& model, const std::string& parameters) {
    return R"({"device": {}, "model": ")" + model + R"(", "parameters": )" + parameters +
           R"(, "level": "pressure", "level_range": [0, 1]})";
}

}  // namespace

TEST_CASE("profile file: every model is written and read back to the last bit") {
    const TemporaryFolder folder;
    Profile profile;
    profile.device.pen = "pen \"x\"";
    profile.fitted_lowest = 0.01;
    profile.fitted_highest = 0.97;
    profile.points = {{0.1, 0.2}, {0.3, 0.4}};
    std::vector<Curve> curves(3);
    curves[0] = {CurveModel::exponential, 0.1 / 3.0, 4.2, 0.0, {}, {}, {}};
    curves[1] = {CurveModel::exponential_offset, -0.1 / 3.0, -4.2, 0.07, {}, {}, {}};
    curves[2] = {CurveModel::power, 1.0 / 3.0, 1.7, 0.0, {}, {}, {}};
    curves.push_back(monotone_cubic({0.0, 0.1, 1.0}, {1.0 / 30.0, 0.4, 2.0}));
    for (const Curve& curve : curves) {
        profile.curve = curve;
        write_profile(profile, {{"median_relative_error", 0.031}}, folder / "p.json");
        const Profile back = read_profile(folder / "p.json");
        CAPTURE(name_of(curve.model));
        CHECK(back.curve.model == curve.model);
        for (double x = 0.0; x <= 1.0; x += 0.01) CHECK(value_N(back.curve, x) == value_N(curve, x));
        CHECK(back.device.pen == profile.device.pen);
        CHECK(back.fitted_highest == 0.97);
        CHECK(back.median_relative_error == 0.031);
        CHECK(back.points.size() == 2);
    }
}

TEST_CASE("profile file: what no reader would take is not written") {
    const TemporaryFolder folder;
    Profile profile;
    profile.curve = {CurveModel::exponential_offset, 4.8e7, 1e-7, -4.8e7, {}, {}, {}};
    const std::string refusal = message_of([&] { write_profile(profile, Json::object(), folder / "p.json"); });
    CHECK(contains(refusal, "p.json: parameters.a_N: found 48000000"));
    CHECK_FALSE(std::filesystem::exists(folder / "p.json"));
}

TEST_CASE("profile file: parameters of every model are checked by key") {
    CHECK(contains(refusal_of_profile(of_model("power", R"({"a_N": 2, "b": -1})")), "parameters.b: found -1"));
    CHECK(contains(refusal_of_profile(of_model("power", R"({"a_N": 2})")), "parameters.b: found nothing"));
    CHECK(contains(refusal_of_profile(of_model("exponential_offset", R"({"a_N": -2, "b": 1, "offset_N": 3})")),
                   "the curve must rise"));
    CHECK(contains(refusal_of_profile(of_model("exponential_offset", R"({"a_N": 2, "b": 1, "offset_N": -30})")),
                   "a force that rises above 0"));
    CHECK(contains(refusal_of_profile(of_model("monotone_cubic", R"({"level": [0, 0], "force_N": [1, 2]})")),
                   "parameters.level: found 0 after 0"));
    CHECK(contains(refusal_of_profile(of_model("monotone_cubic", R"({"level": [0, 1], "force_N": [2, 1]})")),
                   "parameters.force_N: found 1 after 2"));
    CHECK(contains(refusal_of_profile(of_model("monotone_cubic", R"({"level": [0, 1], "force_N": [2]})")),
                   "an array of 2 numbers"));
    CHECK(
        contains(refusal_of_profile(of_model("monotone_cubic", R"({"level": [0], "force_N": [2]})")), "two at least"));
    CHECK(contains(refusal_of_profile(of_model("monotone_cubic", R"({"level": [0, 1], "force_N": [0, 1]})")), "> 0"));
    CHECK(refusal_of_profile(of_model("monotone_cubic", R"({"level": [0.1, 0.9], "force_N": [0.1, 1]})")) == "");
}
