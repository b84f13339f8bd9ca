#include "app/commands/detect_report.h"

#include <cmath>

#include "files/text.h"

namespace palpa::app {
namespace {

// Returns the placed nodule that a region covers, if any: its centre lies within half the length of the region.
std::string placed_at(const stiffnessmaps::Map& map, const stiffnessmaps::StiffRegion& region) {
    for (const stiffnessmaps::Nodule& nodule : map.nodules) {
        const double away_m = std::hypot(nodule.x_m - region.x_m, nodule.y_m - region.y_m);
        if (nodule.placed && away_m <= 0.5 * region.length_m) return nodule.id;
    }
    return "";
}

std::string mm(double metres) { return files::short_number(1e3 * metres); }

files::Json region_json(const stiffnessmaps::Map& map, const stiffnessmaps::StiffRegion& r) {
    const std::string placed = placed_at(map, r);
    return {{"id", r.id},
            {"sure", r.sure},
            {"x_mm", 1e3 * r.x_m},
            {"y_mm", 1e3 * r.y_m},
            {"length_mm", 1e3 * r.length_m},
            {"width_mm", 1e3 * r.width_m},
            {"angle_deg", r.angle_deg},
            {"area_mm2", 1e6 * r.area_m2},
            {"cells", r.cells.size()},
            {"peak_x_mm", 1e3 * r.peak_x_m},
            {"peak_y_mm", 1e3 * r.peak_y_m},
            {"peak_N_per_mm", 1e-3 * r.peak_N_per_m},
            {"background_N_per_mm", 1e-3 * r.background_N_per_m},
            {"contrast", files::number_or_null(r.contrast)},
            {"mean_excess_N_per_mm", 1e-3 * r.mean_excess_N_per_m},
            {"noise_N_per_mm", files::number_or_null(1e-3 * r.noise_N_per_m)},
            {"noise_from", r.against_edge ? "edge" : "all"},
            {"contrast_to_noise", files::number_or_null(r.contrast_to_noise)},
            {"contrast_to_noise_needed", r.needed},
            {"independent_areas", r.areas},
            {"at_edge", r.at_edge},
            {"look", r.look},
            {"placed", placed.empty() ? files::Json(nullptr) : files::Json(placed)},
            {"warnings", r.warnings}};
}

std::string region_text(const stiffnessmaps::Map& map, const stiffnessmaps::StiffRegion& r) {
    const std::string placed = placed_at(map, r);
    std::string out = "  " + r.id + (r.sure ? "" : " UNSURE") + "  at (" + mm(r.x_m) + ", " + mm(r.y_m) + ") mm, " +
                      mm(r.length_m) + " x " + mm(r.width_m) + " mm, long side at " + files::short_number(r.angle_deg) +
                      " deg, " + files::short_number(1e6 * r.area_m2) + " mm2";
    if (r.at_edge) out += ", at the edge of what was measured: its size is a lower bound";
    out += placed.empty() ? "\n" : "; placed nodule " + placed + "\n";
    out += "      " + files::short_number(1e-3 * r.peak_N_per_m) + " N/mm at (" + mm(r.peak_x_m) + ", " +
           mm(r.peak_y_m) + ") mm over " + files::short_number(1e-3 * r.background_N_per_m) + " around it: ";
    out += std::isfinite(r.contrast) ? files::short_number(r.contrast) + " times" : "no ratio";
    if (std::isfinite(r.contrast_to_noise))
        out += "; " + files::short_number(r.contrast_to_noise) + " times the variation of areas of its size" +
               (r.against_edge ? " at the edge (" : " (") + files::short_number(r.needed) + " needed)";
    if (r.look > 1) out += "; found once the sure ones above were set aside";
    return out + "\n";
}

}  // namespace

files::Json detection_json(const stiffnessmaps::Map& map, const stiffnessmaps::Detection& d) {
    files::Json json;
    json["map"] = map.name;
    json["rule"] = {
        {"threshold", files::number_or_null(d.threshold)}, {"threshold_from", d.options.threshold ? "given" : "spread"},
        {"spread_N_per_mm", 1e-3 * d.spread_N_per_m},      {"window_mm", 1e3 * d.options.window_m},
        {"smoothing_mm", 1e3 * *d.options.smoothing_m},    {"smallest_mm", 1e3 * *d.options.smallest_m},
        {"deepest_mm", 1e3 * *d.options.deepest_m},        {"least_independent_areas", stiffnessmaps::kLeastAreas}};
    json["sure"] = d.sure();
    json["regions"] = files::Json::array();
    for (const stiffnessmaps::StiffRegion& region : d.regions) json["regions"].push_back(region_json(map, region));
    json["warnings"] = detection_warnings(d);
    return json;
}

std::string detection_text(const stiffnessmaps::Map& map, const stiffnessmaps::Detection& d) {
    const std::size_t n = d.regions.size();
    std::string out = map.name + ": " +
                      (n == 0 ? "no stiff region" : std::to_string(n) + (n == 1 ? " stiff region" : " stiff regions"));
    if (n > d.sure()) out += ", " + std::to_string(n - d.sure()) + " of them unsure";
    out += "\n  rule: smoothed by " + mm(*d.options.smoothing_m) + " mm, background by medians within " +
           mm(d.options.window_m) + " mm; from " + files::short_number(d.threshold) + " times the background (" +
           (d.options.threshold ? "given" : "3 spreads, at least 1.03") + "), down to half of the peak; a disc of " +
           mm(*d.options.smallest_m) + " mm at least\n";
    for (const stiffnessmaps::StiffRegion& region : d.regions) out += region_text(map, region);
    return out;
}

std::vector<std::string> detection_warnings(const stiffnessmaps::Detection& d) {
    std::vector<std::string> out = d.warnings;
    for (const stiffnessmaps::StiffRegion& region : d.regions) {
        for (const std::string& warning : region.warnings) out.push_back("region " + region.id + " " + warning);
    }
    return out;
}

}  // namespace palpa::app
