#include <algorithm>
#include <cmath>

#include "calibration/calibrate.h"
#include "files/text.h"

namespace palpa::calibration {
namespace {

std::string percent(double share) { return files::short_number(std::round(1000.0 * share) / 10.0) + " %"; }

struct Words {
    std::string device;  // this pen, this touch surface
    std::string level;   // pressure, contact area
    double lowest;
    double width;
    std::string at(double value) const { return percent((value - lowest) / width); }
};

void about_ends(const Calibration& calibration, const Words& words, std::vector<std::string>& out) {
    const Ends& ends = calibration.ends;
    const Profile& profile = calibration.profile;
    if (!std::isnan(ends.saturation_N)) {
        const std::string above = "above " + files::short_number(ends.saturation_N) + " N " + words.device;
        std::string text = profile.level == LevelField::contact_area
                               ? "above " + files::short_number(ends.saturation_N) + " N the contact area grows no more"
                           : ends.saturation_level < profile.level_highest
                               ? above + " reports no more than " + words.at(profile.fitted_highest) + " " + words.level
                               : above + " reports full " + words.level;
        out.push_back(text + ": greater forces cannot be told from it");
        if (!std::isnan(ends.before_saturation_N)) {
            out.push_back("full " + words.level + " begins somewhere between " +
                          files::short_number(ends.before_saturation_N) + " and " +
                          files::short_number(ends.saturation_N) + " N, where there is no point: the curve above " +
                          words.at(profile.fitted_highest) + " " + words.level + " is extrapolated");
        }
    } else if (profile.fitted_highest < words.lowest + 0.97 * words.width) {
        out.push_back("the points end at " + words.at(profile.fitted_highest) + " " + words.level + ": forces above " +
                      files::short_number(value_N(profile.curve, profile.fitted_highest)) + " N are extrapolated");
    }
    if (profile.fitted_lowest > words.lowest + 0.05 * words.width) {
        out.push_back("the points begin at " + words.at(profile.fitted_lowest) + " " + words.level +
                      ": light touch below " + files::short_number(value_N(profile.curve, profile.fitted_lowest)) +
                      " N is extrapolated");
    }
    // A law that begins at 0 N is fitted to some rounding error of it.
    const double lightest_N = value_N(profile.curve, profile.level_lowest);
    if (!(lightest_N >= -2e-3 * value_N(profile.curve, profile.level_highest))) {
        out.push_back("the curve falls to " + files::short_number(lightest_N) +
                      " N at the lightest touch, which is taken as 0 N: compare another model");
    }
}

// Two readings of a level that differ do not tell which of them is right, and three do.
std::string about_slips(const Calibration& calibration, const Words& words) {
    const std::vector<double>& followed = calibration.slips.followed_levels;
    const std::string are = calibration.slips.count == 1 ? " points is" : " points are";
    const FitOptions& fit = calibration.chosen.options;
    if (followed.empty() || (fit.robust == Robust::none && fit.model != CurveModel::monotone_cubic))
        return are + " far off the curve (slips?) and count " +
               (fit.robust == Robust::none ? "in full, as robust weights are off" : "little");
    constexpr std::size_t kMostNamed = 5;
    std::vector<std::string> places;
    for (const double level : followed) {
        const std::string place = words.at(level);
        if (places.empty() || places.back() != place) places.push_back(place);
    }
    std::string text;
    for (std::size_t i = 0; i < std::min(places.size(), kMostNamed); ++i) text += (i > 0 ? ", " : "") + places[i];
    return are + " far off what the others tell (slips?), and the curve follows them at " + text +
           (places.size() > kMostNamed ? " and elsewhere " : " ") + words.level +
           ": press these levels again, until each has three readings";
}

void about_errors(const Calibration& calibration, const Words& words, std::vector<std::string>& out) {
    for (const ErrorBand& band : calibration.bands) {
        if (!(band.median > 0.1)) continue;
        out.push_back("between " + words.at(band.from) + " and " + words.at(band.to) + " " + words.level +
                      " the force is off by " + percent(band.median) + " (median over points left out of the fit)");
    }
    const Drift* drift = calibration.drift ? &*calibration.drift : nullptr;
    if (drift != nullptr && drift->spread > 0.05) {
        out.push_back("repeats differ by " + percent(drift->spread) + " of the force, and drift by " +
                      percent(drift->per_repeat) + " from one to the next");
    }
    if (calibration.hysteresis && std::abs(calibration.hysteresis->median_relative) > 0.05) {
        const double half = 0.5 * calibration.hysteresis->median_relative;  // of the curve between the two
        out.push_back("at one " + words.level + " pressing takes " + percent((1.0 + half) / (1.0 - half) - 1.0) +
                      " more force than releasing: the curve lies between the two");
    }
    if (calibration.slips.count > 0) {
        out.push_back(std::to_string(calibration.slips.count) + " of " +
                      std::to_string(calibration.points.level.size()) + about_slips(calibration, words));
    }
}

void about_data(const Calibration& calibration, const Words& words, std::vector<std::string>& out) {
    const LevelsDelivered& levels = calibration.levels;
    if (levels.widest_gap > 0.15 * words.width) {
        const std::string others =
            levels.equal_gaps < 2 ? "" : ", nor in " + files::counted(levels.equal_gaps - 1, "other gap") + " as wide";
        out.push_back("no point between " + words.at(levels.gap_from) + " and " +
                      words.at(levels.gap_from + levels.widest_gap) + " " + words.level + others +
                      ": the curve is a guess there");
    }
    constexpr std::size_t kFew = 12;
    if (levels.distinct < kFew) {
        out.push_back("only " + std::to_string(levels.distinct) + " distinct levels: " + std::to_string(kFew) +
                      " or more show what the curve does between them");
    }
    if (calibration.bootstrap.over_repeats && calibration.drift && calibration.drift->repeat_offset.size() < 5) {
        out.push_back("intervals from " + std::to_string(calibration.drift->repeat_offset.size()) +
                      " repeats are wide and rough: 5 or more tell better");
    }
}

}  // namespace

std::vector<std::string> warnings_of(const Calibration& calibration, const std::vector<std::string>& notes) {
    const Profile& profile = calibration.profile;
    const bool area = profile.level == LevelField::contact_area;
    const Words words{area ? "this touch surface" : "this pen", area ? "contact area" : "pressure",
                      profile.level_lowest, profile.level_highest - profile.level_lowest};
    std::vector<std::string> out = notes;
    about_ends(calibration, words, out);
    about_errors(calibration, words, out);
    about_data(calibration, words, out);
    return out;
}

}  // namespace palpa::calibration
