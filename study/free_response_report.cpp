#include "study/free_response_report.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "files/text.h"
#include "study/comparisons.h"
#include "study/report.h"
#include "study/table_text.h"

namespace palpa::study {
namespace {

constexpr double kHalf = 0.5;  // false marks a case

PersonMerits merits_of_person(const FreeResponse& data, std::size_t i, std::size_t j) {
    PersonMerits out{data.conditions[i], data.participants[j]};
    for (std::size_t m = 0; m < kMerits.size(); ++m) out.merit[m] = merit_of(data, i, j, kMerits[m]).all;
    const std::vector<FrocPoint> curve = froc_curve(data, i, j);
    out.llf_at_half = llf_at(data, i, j, kHalf);
    const double none = std::isnan(out.llf_at_half) ? out.llf_at_half : 0.0;
    out.max_llf = curve.empty() ? none : curve.back().llf;
    out.max_nlf = curve.empty() ? 0.0 : curve.back().nlf;
    return out;
}

bool judged_anything(const FreeResponse& data, std::size_t i, std::size_t j) {
    for (std::size_t k = 0; k < data.cases.size(); ++k) {
        if (data.at(i, j, k)) return true;
    }
    return false;
}

// What this person did not judge first: "case c2 under B"; empty if everything is there.
std::string first_gap(const FreeResponse& data, std::size_t j) {
    for (std::size_t i = 0; i < data.conditions.size(); ++i) {
        for (std::size_t k = 0; k < data.cases.size(); ++k) {
            if (!data.at(i, j, k)) return "case " + data.cases[k].id + " under " + data.conditions[i];
        }
    }
    return "";
}

// The people who judged all cases under all conditions. The others are noted.
std::vector<std::size_t> complete_people(const FreeResponse& data, std::vector<std::string>& notes) {
    constexpr std::size_t kMostNamed = 10;
    std::vector<std::size_t> complete;
    std::string named;
    std::size_t others = 0;
    for (std::size_t j = 0; j < data.participants.size(); ++j) {
        const std::string gap = first_gap(data, j);
        if (gap.empty()) {
            complete.push_back(j);
        } else if (++others <= kMostNamed) {
            named += (named.empty() ? "" : ", ") + data.participants[j] + " (" + gap + ")";
        }
    }
    if (others > kMostNamed) named += " and " + std::to_string(others - kMostNamed) + " others";
    if (others > 0) {
        notes.push_back(
            "Incomplete crossing: the tests of free-response figures need people who judged every case under "
            "every condition, and leave out " +
            named);
    }
    return complete;
}

MeritResult test_of(const FreeResponse& data, const std::vector<std::size_t>& people, Merit merit, double level) {
    MeritTable table{data.conditions.size(), people.size(), {}, {}};
    for (std::size_t i = 0; i < data.conditions.size(); ++i) {
        for (const std::size_t j : people) {
            MeritFigure figure = merit_of(data, i, j, merit);
            table.theta.push_back(figure.all);
            table.without.push_back(std::move(figure.without));
        }
    }
    MeritResult out{merit, {}, {}};
    if (people.empty()) {
        out.test.f = out.test.ddf = out.test.p = std::nan("");
        out.test.status = "cannot be computed, because nobody judged every case under every condition";
        return out;
    }
    out.test = test_merits(table, level);
    std::vector<double> p;
    for (const MeritPair& pair : out.test.pairs) p.push_back(pair.p);
    out.p_holm = holm_of_known(p);
    return out;
}

void note_missing_cases(FreeResponseReport& out) {
    if (out.cases_with == 0) out.notes.push_back("No case has a lesion: there are no free-response figures of merit");
    if (out.cases_without == 0) {
        out.notes.push_back("No case is without lesions: wafroc, afroc and hr_auc need such cases; wafroc1 does not");
    }
}

// True if all marks have ratings; else notes the first that has none.
bool all_rated(const Observations& seen, FreeResponseReport& out) {
    const auto without = [](const JudgedCase& one) { return !one.rated; };
    const auto first = std::find_if(seen.judged.begin(), seen.judged.end(), without);
    if (first == seen.judged.end()) return true;
    const auto n = std::count_if(seen.judged.begin(), seen.judged.end(), without);
    out.notes.push_back(
        "Free-response figures are left out, because they need a rating of every mark: " + std::to_string(n) + " of " +
        std::to_string(seen.judged.size()) + " judged cases have marks without one, the first by " +
        seen.participants[static_cast<std::size_t>(first->participant)] + " under " +
        seen.conditions[static_cast<std::size_t>(first->condition)]);
    return false;
}

files::Json ci_json(const Interval& ci) { return {files::number_or_null(ci.low), files::number_or_null(ci.high)}; }

files::Json test_json(const FreeResponseReport& found, const MeritResult& result, const MeritPair* pair,
                      double p_holm) {
    const MeritTest& test = result.test;
    const bool two = found.conditions.size() == 2;
    files::Json json{{"figure", name_of(result.merit)}, {"a", nullptr}, {"b", nullptr}};
    if (pair) {
        json["a"] = found.conditions[pair->a];
        json["b"] = found.conditions[pair->b];
    }
    json["f"] = files::number_or_null(pair && !two ? pair->t * pair->t : test.f);
    json["ndf"] = pair ? 1.0 : test.ndf;
    json["ddf"] = files::number_or_null(test.ddf);
    json["p"] = files::number_or_null(pair ? pair->p : test.p);
    json["p_holm"] = pair ? files::number_or_null(p_holm) : files::Json(nullptr);
    json["difference"] = pair ? files::number_or_null(pair->difference) : files::Json(nullptr);
    json["se"] = pair ? files::number_or_null(pair->se) : files::Json(nullptr);
    json["ci"] = pair ? ci_json(pair->ci) : files::Json(nullptr);
    json["status"] = test.status.empty() ? "computed" : test.status;
    const MeritComponents& c = test.components;
    if (test.status.empty()) {
        json["components"] = {{"var", c.var},   {"cov1", c.cov1}, {"cov2", c.cov2},
                              {"cov3", c.cov3}, {"ms_t", c.ms_t}, {"ms_tr", c.ms_tr}};
    }
    return json;
}

// With three conditions and more the first test is that of all, without a difference.
files::Json tests_json(const FreeResponseReport& found) {
    files::Json json = files::Json::array();
    for (const MeritResult& result : found.tests) {
        if (found.conditions.size() != 2) json.push_back(test_json(found, result, nullptr, 1.0));
        for (std::size_t p = 0; p < result.test.pairs.size(); ++p)
            json.push_back(test_json(found, result, &result.test.pairs[p], result.p_holm[p]));
        if (found.conditions.size() == 2 && result.test.pairs.empty())
            json.push_back(test_json(found, result, nullptr, 1.0));
    }
    return json;
}

files::Json conditions_json(const FreeResponseReport& found) {
    files::Json json = files::Json::array();
    for (const MeritResult& result : found.tests) {
        for (std::size_t i = 0; i < result.test.conditions.size(); ++i) {
            const MeritOfCondition& one = result.test.conditions[i];
            json.push_back({{"figure", name_of(result.merit)},
                            {"condition", found.conditions[i]},
                            {"mean", files::number_or_null(one.mean)},
                            {"se", files::number_or_null(one.se)},
                            {"df", files::number_or_null(one.df)},
                            {"ci", ci_json(one.ci)}});
        }
    }
    return json;
}

ReportTable person_table(const FreeResponseReport& found) {
    ReportTable table{
        "free_response",
        "Free response: figures of merit of each person",
        {"condition", "participant", "wafroc", "wafroc1", "afroc", "hr_auc", "max_llf", "max_nlf", "llf_at_half"},
        {}};
    for (const PersonMerits& one : found.figures) {
        std::vector<std::string> row{one.condition, one.participant};
        for (const double x : one.merit) row.push_back(share_text(x));
        for (const double x : {one.max_llf, one.max_nlf, one.llf_at_half}) row.push_back(share_text(x));
        table.rows.push_back(row);
    }
    return table;
}

ReportTable condition_table(const FreeResponseReport& found) {
    ReportTable table{"free_response_conditions",
                      "Free response: conditions, over random people and cases",
                      {"figure", "condition", "mean", "se", "df", "low", "high"},
                      {}};
    for (const MeritResult& result : found.tests) {
        for (std::size_t i = 0; i < result.test.conditions.size(); ++i) {
            const MeritOfCondition& one = result.test.conditions[i];
            table.rows.push_back({name_of(result.merit), found.conditions[i], share_text(one.mean), share_text(one.se),
                                  fixed(one.df, 2), share_text(one.ci.low), share_text(one.ci.high)});
        }
    }
    return table;
}

ReportTable test_table(const FreeResponseReport& found) {
    ReportTable table{
        "free_response_tests",
        "Free response: tests by the method of Obuchowski and Rockette",
        {"figure", "a", "b", "difference", "se", "low", "high", "f", "ndf", "ddf", "p", "p_holm", "status"},
        {}};
    for (const files::Json& one : tests_json(found)) {
        const auto number = [&](const files::Json& x) { return x.is_number() ? x.get<double>() : std::nan(""); };
        const auto text = [&](const char* key) { return one[key].is_string() ? one[key].get<std::string>() : "all"; };
        const bool pair = one["ci"].is_array();
        table.rows.push_back({text("figure"), text("a"), text("b"), share_text(number(one["difference"])),
                              share_text(number(one["se"])), share_text(pair ? number(one["ci"][0]) : std::nan("")),
                              share_text(pair ? number(one["ci"][1]) : std::nan("")), fixed(number(one["f"]), 3),
                              fixed(number(one["ndf"]), 0), fixed(number(one["ddf"]), 2), p_text(number(one["p"])),
                              p_text(number(one["p_holm"])), text("status")});
    }
    return table;
}

ReportTable froc_table(const FreeResponseReport& found) {
    ReportTable table{"froc",
                      "FROC curves of all people: a picture, whose area is no figure of merit",
                      {"condition", "rating", "nlf", "llf"},
                      {}};
    for (const FrocCurve& curve : found.curves) {
        for (const FrocPoint& point : curve.points) {
            table.rows.push_back(
                {curve.condition, files::short_number(point.rating), share_text(point.nlf), share_text(point.llf)});
        }
    }
    return table;
}

// The cases for the tests: without the conditions under which nobody met a lesion, since they have no figure of merit, and
// the others could not be tested beside them. Those conditions are noted.
// Answers that are typed in say which nodules were found, but neither where the marks were nor how sure of them somebody was.
void note_typed_in(const Observations& seen, std::vector<std::string>& notes) {
    std::string names;
    for (const ConditionDisplay& one : seen.displays) {
        const auto found = std::find(seen.conditions.begin(), seen.conditions.end(), one.condition);
        const bool searched = std::any_of(seen.rows.begin(), seen.rows.end(), [&](const Observation& row) {
            return row.condition == static_cast<int>(found - seen.conditions.begin());
        });
        if (one.typed_in && searched) names += (names.empty() ? "" : ", ") + one.condition;
    }
    if (!names.empty())
        notes.push_back("Answers that were typed in have no marks, and no free-response figures: " + names);
}

std::vector<JudgedCase> cases_to_test(const Observations& seen, std::vector<std::string>& notes) {
    std::vector<bool> judged(seen.conditions.size(), false), lesions = judged;
    for (const JudgedCase& one : seen.judged) {
        const auto i = static_cast<std::size_t>(one.condition);
        judged[i] = true;
        if (!one.lesions.empty()) lesions[i] = true;
    }
    if (std::find(lesions.begin(), lesions.end(), true) == lesions.end()) return seen.judged;
    for (std::size_t i = 0; i < judged.size(); ++i) {
        if (judged[i] && !lesions[i])
            notes.push_back("No case under " + seen.conditions[i] +
                            " has a lesion: the tests of free-response figures leave this condition out");
    }
    std::vector<JudgedCase> out;
    std::copy_if(seen.judged.begin(), seen.judged.end(), std::back_inserter(out),
                 [&](const JudgedCase& one) { return lesions[static_cast<std::size_t>(one.condition)]; });
    return out;
}

bool has_cases_without_lesions(const FreeResponse& data) {
    return std::any_of(data.cases.begin(), data.cases.end(),
                       [](const FreeResponseCase& one) { return one.lesions.empty(); });
}

}  // namespace

FreeResponseReport free_response_report(const Observations& seen, double level) {
    FreeResponseReport out;
    note_typed_in(seen, out.notes);
    if (seen.judged.empty()) return out;
    if (!all_rated(seen, out)) return out;
    const FreeResponse data = free_response_of(seen.judged, seen.conditions, seen.participants);
    for (const FreeResponseCase& one : data.cases) ++(one.lesions.empty() ? out.cases_without : out.cases_with);
    for (std::size_t i = 0; i < data.conditions.size(); ++i) {
        for (std::size_t j = 0; j < data.participants.size(); ++j) {
            if (judged_anything(data, i, j)) out.figures.push_back(merits_of_person(data, i, j));
        }
        out.curves.push_back(
            {data.conditions[i], froc_curve(data, i, std::nullopt), llf_at(data, i, std::nullopt, kHalf)});
    }
    note_missing_cases(out);
    const FreeResponse tested = free_response_of(cases_to_test(seen, out.notes), seen.conditions, seen.participants);
    out.conditions = tested.conditions;
    const std::vector<std::size_t> people = complete_people(tested, out.notes);
    out.participants_tested = static_cast<int>(people.size());
    for (const Merit merit : kMerits) {
        const bool possible = out.cases_with > 0 && (has_cases_without_lesions(tested) || merit == Merit::wafroc1);
        if (possible) out.tests.push_back(test_of(tested, people, merit, level));
    }
    return out;
}

void add_free_response(const FreeResponseReport& found, files::Json& report) {
    if (found.empty()) return;
    files::Json& json = report["free_response"];
    json["cases_without_lesions"] = found.cases_without;
    json["cases_with_lesions"] = found.cases_with;
    json["participants_tested"] = found.participants_tested;
    json["figures"] = files::Json::array();
    for (const PersonMerits& one : found.figures) {
        files::Json figure{{"condition", one.condition}, {"participant", one.participant}};
        for (std::size_t m = 0; m < kMerits.size(); ++m)
            figure[name_of(kMerits[m])] = files::number_or_null(one.merit[m]);
        figure["max_llf"] = files::number_or_null(one.max_llf);
        figure["max_nlf"] = files::number_or_null(one.max_nlf);
        figure["llf_at_half"] = files::number_or_null(one.llf_at_half);
        json["figures"].push_back(std::move(figure));
    }
    json["curves"] = files::Json::array();
    for (const FrocCurve& curve : found.curves) {
        files::Json points = files::Json::array();
        for (const FrocPoint& p : curve.points) points.push_back({p.rating, p.nlf, files::number_or_null(p.llf)});
        json["curves"].push_back({{"condition", curve.condition},
                                  {"rating_nlf_llf", std::move(points)},
                                  {"llf_at_half", files::number_or_null(curve.llf_at_half)}});
    }
    json["conditions"] = conditions_json(found);
    json["tests"] = tests_json(found);
    json["notes"] = found.notes;
}

std::vector<ReportTable> free_response_tables(const FreeResponseReport& found) {
    return {person_table(found), condition_table(found), test_table(found), froc_table(found)};
}

std::string free_response_methods(const FreeResponseReport& found) {
    if (found.empty()) return "";
    std::string out;
    if (!found.figures.empty()) {
        out =
            "\nFree response: " + files::counted(found.cases_without, "case") + " without lesions, " +
            whole(found.cases_with) +
            " with. wafroc = probability that a lesion is rated above the highest false mark on a case without "
            "lesions, each case with lesions counting the same; wafroc1 takes the false marks of all cases; afroc "
            "counts each lesion the same; hr_auc = area under the ROC curve inferred from the highest rating of a "
            "case. Nobody's marks at all give 0.5, so 0.5 is not chance. max_llf = share of lesions marked, max_nlf = "
            "false marks a case, llf_at_half = share of lesions found at 0.5 false marks a case. Tests and intervals "
            "take people and cases as random (Obuchowski and Rockette, jackknife over cases), of " +
            whole(found.participants_tested) + " people who judged everything.\n";
    }
    for (const std::string& note : found.notes) out += "\n- " + note;
    return found.notes.empty() ? out : out + "\n";
}

}  // namespace palpa::study
