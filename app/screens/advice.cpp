// One sentence after a trial: what to do better.

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "app/screens/screens.h"
#include "app/screens/words.h"
#include "files/text.h"

namespace palpa::app {
namespace {

constexpr int kRegionCount = 9;  // thirds of the tissue as it lies on the screen, row by row from the upper left

int region_of(const scene::View& view, const Eigen::Vector2d& p_m) {
    const Eigen::Vector2d off_px = scene::px_of_tissue(view, p_m) - view.centre_px;
    const Eigen::Vector2d size_px = view.px_per_m * (view.axes * view.area.size_m).cwiseAbs();
    const auto third = [](double off, double size) {
        return std::clamp(static_cast<int>(std::floor(3.0 * (off / size + 0.5))), 0, 2);
    };
    return 3 * third(off_px.y(), size_px.y()) + third(off_px.x(), size_px.x());
}

const char* name_of_region(int region) {
    constexpr std::array<const char*, kRegionCount> kNames{words::kUpperLeft,  words::kUpperMiddle, words::kUpperRight,
                                                           words::kMiddleLeft, words::kMiddle,      words::kMiddleRight,
                                                           words::kLowerLeft,  words::kLowerMiddle, words::kLowerRight};
    return kNames[static_cast<std::size_t>(region)];
}

struct Examined {
    std::array<double, kRegionCount> regions{};  // the share of each that was pressed
    double whole = 0.0;                          // and of all
};

Examined examined(const study::Coverage& c, const scene::View& view) {
    std::array<double, kRegionCount> cells{};
    std::array<double, kRegionCount> pressed{};
    for (int j = 0; j < c.n_y; ++j) {
        for (int i = 0; i < c.n_x; ++i) {
            const Eigen::Vector2d p_m(c.x_m + (i + 0.5) * c.cell_m, c.y_m + (j + 0.5) * c.cell_m);
            const auto region = static_cast<std::size_t>(region_of(view, p_m));
            cells[region] += 1.0;
            if (c.depth_m[static_cast<std::size_t>(j * c.n_x + i)] > 0.0f) pressed[region] += 1.0;
        }
    }
    Examined out;
    for (std::size_t i = 0; i < pressed.size(); ++i) out.regions[i] = pressed[i] / std::max(1.0, cells[i]);
    out.whole = std::accumulate(pressed.begin(), pressed.end(), 0.0) /
                std::max(1.0, std::accumulate(cells.begin(), cells.end(), 0.0));
    return out;
}

// Below this share of the whole tissue, one region's name would say too little.
constexpr double kHardly = 0.25;

std::string percent_left(const Examined& shares) {
    if (shares.whole > 0.0 && shares.whole <= 0.005) return "nearly 100";
    return files::short_number(std::round(100.0 * (1.0 - shares.whole)));
}

// The reason that comes first also helps most: tissue that was never touched, then too little force, then judgement.
const session::Finding kReasons[] = {session::Finding::not_touched, session::Finding::too_light,
                                     session::Finding::not_marked};

std::string advice_on_missed(const stiffnessmaps::Nodule& nodule, session::Finding finding, const Examined& shares,
                             const scene::View& view) {
    if (finding == session::Finding::too_light) return words::filled(words::kAdviceTooLight, {nodule.id});
    if (finding == session::Finding::not_marked) return words::filled(words::kAdviceNotMarked, {nodule.id});
    if (shares.whole < kHardly) return words::filled(words::kAdviceMostMissed, {nodule.id, percent_left(shares)});
    const int region = region_of(view, {nodule.x_m, nodule.y_m});
    const bool hardly = shares.regions[static_cast<std::size_t>(region)] < kHardly;
    return words::filled(hardly ? words::kAdviceNotTouched : words::kAdvicePassed, {nodule.id, name_of_region(region)});
}

}  // namespace

Reviewing review_of(const scene::Plan& plan, const session::Trial& trial, const scene::View& view, bool guided) {
    Reviewing out{session::debrief(plan, trial), false, guided};
    out.advice = advice_for(plan, trial, out.debrief, view);
    return out;
}

std::string advice_for(const scene::Plan& plan, const session::Trial& trial, const session::Debrief& debrief,
                       const scene::View& view) {
    if (!debrief.scored) return words::kAdviceNotScored;
    const Examined shares = examined(trial.coverage, view);
    for (const session::Finding reason : kReasons) {
        for (std::size_t i = 0; i < plan.nodules.size(); ++i) {
            if (debrief.findings[i] == reason) return advice_on_missed(plan.nodules[i], reason, shares, view);
        }
    }
    const int wrong = debrief.score.false_positives;
    if (wrong > 0)
        return words::filled(words::kAdviceFalse, {std::to_string(wrong), std::to_string(trial.marks.size())});
    if (plan.nodules.empty()) return words::kAdviceNoNodules;
    constexpr double kUnexamined = 0.1;
    if (shares.whole < kHardly) return words::filled(words::kAdviceMostUnexamined, {percent_left(shares)});
    const auto least = std::min_element(shares.regions.begin(), shares.regions.end());
    if (*least < kUnexamined)
        return words::filled(words::kAdviceUnexamined,
                             {name_of_region(static_cast<int>(least - shares.regions.begin()))});
    return words::kAdviceGood;
}

}  // namespace palpa::app
