#include "figures/study_figures.h"

#include <algorithm>
#include <set>
#include <vector>

#include "figures/gnuplot.h"
#include "files/text.h"
#include "study/observations.h"

namespace palpa::figures {
namespace {

// Colours by Okabe and Ito, which colour-blind people can distinguish; hatching repeats the distinction.
constexpr const char* kScript =
    R"gp(# gnuplot figures.gp draws sensitivity.tsv, nodules.tsv and ppv.tsv; gnuplot -e "kind='svg'" figures.gp: or svg, pdf
if (!exists("kind")) kind = "png"
set datafile separator tab
set datafile missing "n/a"
set datafile columnheaders
if (kind eq "png") set terminal pngcairo size 1100,700 font "DejaVu Sans,14"
if (kind eq "svg") set terminal svg size 1100,700 font "DejaVu Sans,16" background rgb "white"
if (kind eq "pdf") set terminal pdfcairo size 11in,7in font "DejaVu Sans,16"
set border 3
set tics nomirror noenhanced
set style fill pattern 1 border lc rgb "#000000"
set yrange [0:105]
set ytics 20
set grid ytics lc rgb "#BBBBBB" dt 3
set bmargin 5
percent(column_name) = 100 * column(column_name)

unset key
set ylabel "Sensitivity (%)"
set title "Sensitivity by condition, with Wilson intervals at " . level . sensitivity_wilson . subtitle
set output "sensitivity." . kind
set style fill solid 0.45 border lc rgb "#000000"
set boxwidth 0.6
set xrange [-0.5:rows - 0.5]
set xtics nomirror noenhanced ()
do for [i = 1:rows] { set xtics add (every_condition[i] i - 1) }
plot "sensitivity.tsv" every ::0::(rows - 1) using 0:(percent("share")) with boxes lc rgb "#0072B2", \
     "" every ::0::(rows - 1) using 0:(percent("share")):(percent("wilson_low")):(percent("wilson_high")) with yerrorbars lc rgb "#000000" lw 2 pt 7 ps 0.5

set ylabel "Positive predictive value (%)"
set title "Positive predictive value by condition, with Wilson intervals at " . level . ppv_wilson . subtitle
set output "ppv." . kind
plot "ppv.tsv" every ::0::(rows - 1) using 0:(percent("share")) with boxes lc rgb "#009E73", \
     "" every ::0::(rows - 1) using 0:(percent("share")):(percent("wilson_low")):(percent("wilson_high")) with yerrorbars lc rgb "#000000" lw 2 pt 7 ps 0.5
)gp";

// One cluster of bars for each condition with named nodules, one bar for each nodule in it.
constexpr const char* kNodules =
    R"gp(
set ylabel "Sensitivity (%)"
set title "Sensitivity by nodule, with Wilson intervals at " . level . nodules_wilson . subtitle
set output "nodules." . kind
set key outside right top title "nodule" noenhanced
set style fill pattern border lc rgb "#000000"
set xrange [-0.5:|conditions| - 0.5]
set boxwidth 0.8 / |nodules|
place(row) = condition_of[row] - 1 + 0.8 * (nodule_of[row] - 0.5 * (|nodules| + 1)) / |nodules|
mine(i, row) = nodule_of[row] == i ? place(row) : NaN
colours = "#0072B2 #E69F00 #009E73 #CC79A7 #D55E00 #56B4E9"
colour(i) = word(colours, (i - 1) % words(colours) + 1)
set xtics nomirror noenhanced ()
do for [i = 1:|conditions|] { set xtics add (conditions[i] i - 1) }
plot for [i = 1:|nodules|] "nodules.tsv" every ::0::(nodule_rows - 1) using (mine(i, int($0) + 1)):(percent("share")) with boxes fs pattern i + 2 lc rgb colour(i) title nodules[i] noenhanced, \
     "" every ::0::(nodule_rows - 1) using (place(int($0) + 1)):(percent("share")):(percent("wilson_low")):(percent("wilson_high")) with yerrorbars lc rgb "#000000" lw 2 pt 7 ps 0.5 notitle
)gp";

std::string array_of(const std::string& name, const std::vector<std::string>& entries) {
    std::string list;
    for (const std::string& entry : entries) list += (list.empty() ? "" : ", ") + entry;
    return "array " + name + "[" + std::to_string(entries.size()) + "] = [" + list + "]\n";
}

// gnuplot takes labels of tics for formats of numbers.
std::string tic_label(const std::string& text) {
    std::string out;
    for (const char c : single_quoted(text)) out += c == '%' ? std::string("%%") : std::string(1, c);
    return out;
}

// What a title says of the intervals of these shares.
std::string wilson_title(const std::vector<study::Share>& shares) {
    const auto n =
        std::count_if(shares.begin(), shares.end(), [](const study::Share& share) { return share.one_each; });
    if (n == 0) return "\", which ignore clustering\"";
    const bool all = static_cast<std::size_t>(n) == shares.size();
    return all ? "\" over participants\"" : "\", some of which ignore clustering\"";
}

std::string script_of(const study::Report& report) {
    // rows of tables are known by their number, since gnuplot reads names with a backslash as others
    std::vector<std::string> every, conditions, labels, nodules, titles, condition_of, nodule_of;
    std::vector<study::Share> se, ppv, se_of_nodule;
    for (const study::ConditionResult& condition : report.conditions) {
        every.push_back(tic_label(condition.name));
        if (condition.se) se.push_back(*condition.se);
        if (condition.ppv) ppv.push_back(*condition.ppv);
        for (const study::NoduleResult& nodule : condition.nodules) {
            se_of_nodule.push_back(nodule.se);
            condition_of.push_back(std::to_string(1 + study::index_of(condition.name, conditions)));
            nodule_of.push_back(std::to_string(1 + study::index_of(nodule.nodule, nodules)));
        }
    }
    for (const std::string& name : conditions) labels.push_back(tic_label(name));
    for (const std::string& name : nodules) titles.push_back(single_quoted(name));
    // below these rows stand those of the groups
    std::string out =
        "rows = " + std::to_string(every.size()) + "\nnodule_rows = " + std::to_string(nodule_of.size()) + "\n";
    out += "level = \"" + files::short_number(100.0 * report.options.bootstrap.level) + " %\"\n";
    out += "sensitivity_wilson = " + wilson_title(se) + "\nppv_wilson = " + wilson_title(ppv) +
           "\nnodules_wilson = " + wilson_title(se_of_nodule) + "\n";
    out += "subtitle = " + std::string(report.simulated ? R"("\n{/*0.8 SIMULATED participants}")" : "''") + "\n";
    out += array_of("every_condition", every) + kScript;
    if (!nodules.empty())
        out += "\n" + array_of("conditions", labels) + array_of("nodules", titles) +
               array_of("condition_of", condition_of) + array_of("nodule_of", nodule_of) + kNodules;
    return out;
}

// Returns why figures of so many bars are not drawn; empty if they are.
std::string too_many(const study::Report& report) {
    constexpr std::size_t kMostBars = 200;
    std::set<std::string> nodules;
    for (const study::ConditionResult& condition : report.conditions) {
        for (const study::NoduleResult& nodule : condition.nodules) nodules.insert(nodule.nodule);
    }
    const std::size_t bars = report.conditions.size() * std::max<std::size_t>(1, nodules.size());
    if (bars <= kMostBars) return "";
    return "no figures: " + std::to_string(report.conditions.size()) + " conditions of " +
           std::to_string(nodules.size()) + " nodules make more than " + std::to_string(kMostBars) +
           " bars; the tables are kept";
}

}  // namespace

std::string draw_figures(const study::Report& report, const std::filesystem::path& folder) {
    if (report.conditions.empty()) return "";
    if (const std::string why = too_many(report); !why.empty()) return why;
    files::write_text_atomically(folder / "figures.gp", script_of(report));
    return draw_script(folder / "figures.gp", "the tables are kept");
}

}  // namespace palpa::figures
