#include "figures/study_figures.h"

#include <algorithm>
#include <set>

#include "figures/gnuplot.h"
#include "files/text.h"

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
set tics nomirror
set style fill pattern 1 border lc rgb "#000000"
set yrange [0:105]
set ytics 20
set grid ytics lc rgb "#BBBBBB" dt 3
set bmargin 5
percent(column_name) = 100 * column(column_name)

unset key
set ylabel "Sensitivity (%)"
set title "Sensitivity by condition, with Wilson intervals at " . level . ", which ignore clustering" . subtitle
set output "sensitivity." . kind
set style fill solid 0.45 border lc rgb "#000000"
set boxwidth 0.6
set xrange [-0.5:rows - 0.5]
plot "sensitivity.tsv" every ::0::(rows - 1) using 0:(percent("share")):xtic(1) with boxes lc rgb "#0072B2", \
     "" every ::0::(rows - 1) using 0:(percent("share")):(percent("wilson_low")):(percent("wilson_high")) with yerrorbars lc rgb "#000000" lw 2 pt 7 ps 0.5

set ylabel "Positive predictive value (%)"
set title "Positive predictive value by condition, with Wilson intervals at " . level . ", which ignore clustering" . subtitle
set output "ppv." . kind
plot "ppv.tsv" every ::0::(rows - 1) using 0:(percent("share")):xtic(1) with boxes lc rgb "#009E73", \
     "" every ::0::(rows - 1) using 0:(percent("share")):(percent("wilson_low")):(percent("wilson_high")) with yerrorbars lc rgb "#000000" lw 2 pt 7 ps 0.5
)gp";

// One cluster of bars for each condition with named nodules, one bar for each nodule in it.
constexpr const char* kNodules =
    R"gp(
set ylabel "Sensitivity (%)"
set title "Sensitivity by nodule, with Wilson intervals at " . level . ", which ignore clustering" . subtitle
set output "nodules." . kind
set key outside right top title "nodule"
set style fill pattern border lc rgb "#000000"
set xrange [-0.5:words(conditions) - 0.5]
set boxwidth 0.8 / words(nodules)
word_at(list, name) = sum [i = 1:words(list)] (word(list, i) eq name ? i : 0)
place(condition, nodule) = word_at(conditions, condition) - 1 + 0.8 * (word_at(nodules, nodule) - 0.5 * (words(nodules) + 1)) / words(nodules)
mine(i) = strcol("nodule") eq word(nodules, i) ? place(strcol("condition"), strcol("nodule")) : NaN
colours = "#0072B2 #E69F00 #009E73 #CC79A7 #D55E00 #56B4E9"
colour(i) = word(colours, (i - 1) % words(colours) + 1)
unset xtics
set xtics nomirror
do for [i = 1:words(conditions)] { set xtics add (word(conditions, i) i - 1) }
plot for [i = 1:words(nodules)] "nodules.tsv" every ::0::(nodule_rows - 1) using (mine(i)):(percent("share")) with boxes fs pattern i + 2 lc rgb colour(i) title word(nodules, i), \
     "" every ::0::(nodule_rows - 1) using (place(strcol("condition"), strcol("nodule"))):(percent("share")):(percent("wilson_low")):(percent("wilson_high")) with yerrorbars lc rgb "#000000" lw 2 pt 7 ps 0.5 notitle
)gp";

// gnuplot's word() takes several words as one if they are in quotes.
void add_word(const std::string& word, std::string& list) {
    std::string plain;
    for (const char c : word) plain += c == '"' || c == '\'' || c == '\\' || c == '`' ? '_' : c;
    const std::string entry = "'" + plain + "'";
    if (list.find(entry) == std::string::npos) list += (list.empty() ? "" : " ") + entry;
}

std::string script_of(const study::Report& report) {
    std::string conditions, nodules, out;
    std::size_t nodule_rows = 0;
    for (const study::ConditionResult& condition : report.conditions) {
        nodule_rows += condition.nodules.size();
        if (!condition.nodules.empty()) add_word(condition.name, conditions);
        for (const study::NoduleResult& nodule : condition.nodules) add_word(nodule.nodule, nodules);
    }
    // below these rows stand those of the groups
    out +=
        "rows = " + std::to_string(report.conditions.size()) + "\nnodule_rows = " + std::to_string(nodule_rows) + "\n";
    out += "level = \"" + files::short_number(100.0 * report.options.bootstrap.level) + " %\"\n";
    out += "subtitle = " + std::string(report.simulated ? R"("\n{/*0.8 SIMULATED participants}")" : "''") + "\n";
    out += kScript;
    if (!nodules.empty()) out += "\nconditions = \"" + conditions + "\"\nnodules = \"" + nodules + "\"" + kNodules;
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
