#include "study/staircase_report.h"

#include <cstdio>

namespace palpa::study {
namespace {

std::string tenth(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", value);
    return text;
}

}  // namespace

files::Json staircase_json(const StaircaseResult& result) {
    const StaircaseEstimate& e = result.estimate;
    files::Json json{{"condition", result.condition},
                     {"participant", result.participant},
                     {"method", name_of(result.method)},
                     {"trials", e.trials},
                     {"reversals", e.reversals},
                     {"target", e.target ? files::Json(*e.target) : files::Json(nullptr)},
                     {"threshold_percent", e.threshold ? files::Json(percent_of(*e.threshold)) : files::Json(nullptr)},
                     {"jnd_percent", percent_of(e.jnd)},
                     {"jnd_percent_credible", {percent_of(e.jnd_low), percent_of(e.jnd_high)}},
                     {"status", e.status}};
    return json;
}

ReportTable staircase_table(const Report& report) {
    ReportTable table{"staircases",
                      "Staircases: the difference that a participant feels, in per cent of the reference, with 95 % "
                      "credible intervals",
                      {"condition", "participant", "method", "trials", "reversals", "target", "threshold_percent",
                       "jnd_percent", "jnd_low", "jnd_high", "status"},
                      {}};
    for (const StaircaseResult& result : report.staircases) {
        const StaircaseEstimate& e = result.estimate;
        table.rows.push_back({result.condition, result.participant, name_of(result.method), std::to_string(e.trials),
                              std::to_string(e.reversals), e.target ? tenth(100.0 * *e.target) + " %" : "n/a",
                              e.threshold ? tenth(percent_of(*e.threshold)) : "n/a", tenth(percent_of(e.jnd)),
                              tenth(percent_of(e.jnd_low)), tenth(percent_of(e.jnd_high)), e.status});
    }
    return table;
}

}  // namespace palpa::study
