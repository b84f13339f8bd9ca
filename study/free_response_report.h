#pragma once
// The free-response analysis of a study: figures of each person under each condition, FROC curves, and the tests of
// conditions over people and cases.

#include <optional>
#include <string>
#include <vector>

#include "files/json.h"
#include "study/judged_cases.h"
#include "study/obuchowski_rockette.h"

namespace palpa::study {

struct PersonMerits {
    std::string condition;
    std::string participant;
    std::array<double, 4> merit{};  // in the order of kMerits; NaN: it needs cases that are not there
    double max_llf = 0.0;           // share of the lesions with a mark; NaN without lesions
    double max_nlf = 0.0;           // false marks per case
    double llf_at_half = 0.0;       // share of the lesions found at 0.5 false marks a case; NaN without lesions
};

struct MeritResult {
    Merit merit = Merit::wafroc;
    MeritTest test;              // of the people who judged everything
    std::vector<double> p_holm;  // by pair, over the pairs of this figure
};

struct FrocCurve {
    std::string condition;
    std::vector<FrocPoint> points;  // of all people pooled
    double llf_at_half = 0.0;
};

struct FreeResponseReport {
    std::vector<std::string> conditions;  // that are tested
    std::vector<PersonMerits> figures;
    std::vector<FrocCurve> curves;
    std::vector<MeritResult> tests;
    int cases_without = 0;
    int cases_with = 0;
    int participants_tested = 0;
    std::vector<std::string> notes;  // who is not in the tests, and why figures are missing
    bool empty() const { return figures.empty() && notes.empty(); }
};

struct ReportTable;
struct Observations;

// Without marks of named people in cases, and with marks that have no rating, there are no figures; the latter are noted.
FreeResponseReport free_response_report(const Observations& seen, double level);

void add_free_response(const FreeResponseReport& found, files::Json& report);  // `free_response`, if there is any
std::vector<ReportTable> free_response_tables(const FreeResponseReport& found);
std::string free_response_methods(const FreeResponseReport& found);  // a paragraph; empty without figures

}  // namespace palpa::study
