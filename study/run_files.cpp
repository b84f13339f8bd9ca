#include "study/run_files.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "files/input_error.h"
#include "files/json.h"
#include "files/table.h"
#include "files/text.h"
#include "study/count.h"
#include "study/names.h"
#include "study/run_log.h"
#include "study/score.h"

namespace palpa::study {
namespace {

constexpr int kMostPeople = 1'000'000;

// How many of the marks without a hit are on no nodule: from `least` to `most`, since a mark at the very edge of a nodule
// that was found may have been rounded to either side.
struct FalseMarks {
    std::int64_t least = 0;
    std::int64_t most = 0;
};

FalseMarks false_marks(const RunSettings& settings, const std::vector<LoggedMark>& marks) {
    constexpr double kRounding_mm = 1e-6;
    std::set<std::string> found;
    for (const LoggedMark& mark : marks) {
        if (mark.hit) found.insert(mark.nodule);
    }
    FalseMarks out;
    for (const LoggedMark& mark : marks) {
        if (mark.hit) continue;
        const auto it = std::find_if(settings.nodules.begin(), settings.nodules.end(),
                                     [&](const RunSettings::Nodule& nodule) { return nodule.id == mark.nodule; });
        Target target;
        if (it != settings.nodules.end()) target.diameter_m = 1e-3 * it->diameter_mm;
        const double reach_mm = 1e3 * acceptance_radius_m(target);
        const bool known = it != settings.nodules.end() && found.count(mark.nodule) > 0;
        if (!(known && mark.distance_mm <= reach_mm - kRounding_mm)) ++out.most;
        if (!(known && mark.distance_mm <= reach_mm + kRounding_mm)) ++out.least;
    }
    return out;
}

std::string number_and(std::int64_t n, const char* what) { return std::to_string(n) + " " + what; }

}  // namespace

RunSettings read_run_settings(const std::filesystem::path& file) {
    RunSettings out;
    if (!std::filesystem::exists(file)) return out;
    out.there = true;
    const files::Json root = files::read_json(file);
    files::JsonReader json(root, file.string());
    if (auto study = json.optional_object("study")) {
        out.sha256 = study->text("sha256", "");
        out.simulated = study->boolean("simulated", false);
        if (study->has("interval")) out.interval = study->integer("interval", 1, 2);
        if (study->has("participant_number")) out.number = study->integer("participant_number", 1, kMostPeople);
    }
    out.typed = json.has("answers");
    if (root.contains("tissue") && root["tissue"].is_object()) {
        const files::Json& tissue = root["tissue"];
        if (tissue.contains("name") && tissue["name"].is_string()) out.tissue = tissue["name"].get<std::string>();
    }
    std::set<std::string> ids;
    for (files::JsonReader& nodule : json.objects("nodules")) {
        out.nodules.push_back({nodule.text("id"), nodule.number("diameter_mm", files::kNotNegative, 0.0)});
        const std::string& id = out.nodules.back().id;
        if (!is_name(id)) nodule.fail("id", files::shown(id), kNameRule);
        if (!ids.insert(id).second) nodule.fail("id", files::shown(id) + " a second time", "each nodule once");
    }
    return out;
}

std::string began_utc(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file)) return "";  // written last, so an interrupted trial has none
    const files::Json json = files::read_json(file);
    return json.contains("began_utc") && json["began_utc"].is_string() ? json["began_utc"].get<std::string>() : "";
}

std::optional<std::vector<LoggedMark>> read_marks_left(const std::filesystem::path& file,
                                                       std::vector<std::string>& notes) {
    if (!std::filesystem::exists(file)) return std::nullopt;
    const std::string text = files::read_text(file);
    files::Table table(std::string(whole_lines(text, file.string(), notes)), file.string(), '\t');
    const std::size_t nodule = table.column("nodule"), hit = table.column("hit");
    const bool has_distance = table.has_column("distance_mm");
    const std::size_t distance = has_distance ? table.column("distance_mm") : 0;
    const bool has_confidence = table.has_column("confidence");
    const std::size_t confidence = has_confidence ? table.column("confidence") : 0;
    std::vector<LoggedMark> marks;
    std::set<std::string> found;
    while (table.next()) {
        LoggedMark mark{std::string(table.field(nodule)), has_distance ? table.number(distance) : std::nan(""),
                        whole_number(table, hit, 0, 1) == 1};
        if (has_confidence && !std::isnan(table.number(confidence)))
            mark.confidence = static_cast<double>(whole_number(table, confidence, 1, 5));
        if (mark.hit && !found.insert(mark.nodule).second)
            table.fail(nodule, "each nodule found by one mark (the others have hit 0)");
        marks.push_back(std::move(mark));
    }
    return marks;
}

JudgedCase judged_case(const RunSettings& settings, const std::vector<LoggedMark>& marks) {
    constexpr double kRounding_mm = 1e-6;
    JudgedCase out;
    out.id = settings.tissue;
    for (const RunSettings::Nodule& nodule : settings.nodules) {
        out.lesions.push_back(nodule.id);
        out.reading.ll.push_back(kUnmarked);
    }
    for (const LoggedMark& mark : marks) {
        const auto found = [&](const LoggedMark& other) { return other.hit && other.nodule == mark.nodule; };
        const auto it = std::find(out.lesions.begin(), out.lesions.end(), mark.nodule);
        const auto l = static_cast<std::size_t>(it - out.lesions.begin());
        bool on = it != out.lesions.end() && mark.hit;
        if (it != out.lesions.end() && !mark.hit && std::any_of(marks.begin(), marks.end(), found)) {
            Target target;
            target.diameter_m = 1e-3 * settings.nodules[l].diameter_mm;
            on = mark.distance_mm <= 1e3 * acceptance_radius_m(target) + kRounding_mm;
        }
        if (std::isnan(mark.confidence)) {
            out.rated = false;
        } else if (on) {
            out.reading.ll[l] = std::max(out.reading.ll[l], mark.confidence);
        } else {
            out.reading.nl.push_back(mark.confidence);
        }
    }
    return out;
}

void check_counts(const RunLog& run, const RunSettings& settings, const std::vector<LoggedMark>& marks) {
    const std::string file = run.events.string();
    const auto standing = static_cast<std::int64_t>(marks.size());
    const auto hits = std::count_if(marks.begin(), marks.end(), [](const LoggedMark& mark) { return mark.hit; });
    const auto n = static_cast<std::int64_t>(settings.nodules.size());
    std::int64_t found = 0;
    for (const RunSettings::Nodule& nodule : settings.nodules) {
        found += std::any_of(marks.begin(), marks.end(),
                             [&](const LoggedMark& mark) { return mark.hit && mark.nodule == nodule.id; });
    }
    if (n > 0 && (found != run.tp || n != run.tp + run.fn || hits != found)) {
        throw files::bad_input(
            file, "finish", number_and(run.tp, "found and ") + number_and(run.fn, "missed"),
            std::to_string(found) + " of " + std::to_string(n) + " as the marks and the settings beside it say");
    }
    const FalseMarks expected = false_marks(settings, marks);
    const bool possible = run.fp >= expected.least && run.fp <= expected.most;
    const bool unnamed = n == 0 && settings.typed;  // a sum that was typed in: its false marks stand in the table
    if (!possible || (unnamed && run.fp != standing - hits)) {
        throw files::bad_input(file, "finish, fp", std::to_string(run.fp),
                               std::to_string(expected.most) + ", as the marks beside it say");
    }
    if (run.marks_left && !settings.typed && *run.marks_left != standing) {
        throw files::bad_input(file, "mark, undo", number_and(*run.marks_left, "marks left"),
                               number_and(standing, "marks as in ..._marks.tsv beside it"));
    }
}

}  // namespace palpa::study
