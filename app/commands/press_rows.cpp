#include "app/commands/press_rows.h"

#include <algorithm>

#include "files/text.h"

namespace palpa::app {

std::string rows_beside(const std::vector<devices::PressRow>& press, const scene::TissueArea& area) {
    const auto beside = [&](const devices::PressRow& row) {
        const Eigen::Vector2d off_m = (Eigen::Vector2d(row.x_m, row.y_m) - area.centre_m).cwiseAbs();
        return (off_m.array() > 0.5 * area.size_m.array()).any();
    };
    const auto count = std::count_if(press.begin(), press.end(), beside);
    if (count == 0) return "";
    const Eigen::Vector2d low_mm = 1e3 * (area.centre_m - 0.5 * area.size_m);
    const Eigen::Vector2d high_mm = 1e3 * (area.centre_m + 0.5 * area.size_m);
    return std::to_string(count) + " of " + std::to_string(press.size()) + " rows are beside the tissue (x " +
           files::short_number(low_mm.x()) + " to " + files::short_number(high_mm.x()) + ", y " +
           files::short_number(low_mm.y()) + " to " + files::short_number(high_mm.y()) + " mm)";
}

}  // namespace palpa::app
