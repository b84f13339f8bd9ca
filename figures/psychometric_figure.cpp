#include "figures/psychometric_figure.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "figures/gnuplot.h"
#include "files/text.h"

namespace palpa::figures {
namespace {

using study::PsychometricResult;

constexpr int kPanelsInRow = 3;
constexpr std::size_t kMostPanels = 24;  // more cannot be read on one page

constexpr const char* kPsychometricHead =
    R"gp(# gnuplot psychometric.gp draws psychometric.png; gnuplot -e "kind='svg'" psychometric.gp: or svg, pdf
# Points: answers of all people, their area in proportion to the number of answers. Thick: curve of all, thin: of each person.
if (!exists("kind")) kind = "png"
)gp";

constexpr const char* kPsychometricStyle =
    R"gp(set output "psychometric." . kind
set border 3
set tics nomirror
set yrange [-0.02:1.02]
set ytics 0.25
set xtics ("1/4" -log(4.0), "1/2" -log(2.0), "1/1.5" -log(1.5), "1" 0, "1.5" log(1.5), "2" log(2.0), "4" log(4.0))
set lmargin 9
set rmargin 3
set grid ytics lc rgb "#BBBBBB" dt 3
unset key
curve(x, pse, sd, lapse) = lapse + (1 - 2 * lapse) * norm((x - pse) / sd)
)gp";

// Returns text that gnuplot shows as it is.
std::string plain_title(const std::string& text) { return single_quoted(text) + " noenhanced"; }

bool is_drawn(const PsychometricResult& curve) { return curve.fit.pse && curve.fit.sd; }

std::string formula(const PsychometricResult& curve) {
    return "curve(x, " + files::number_text(*curve.fit.pse) + ", " + files::number_text(*curve.fit.sd) + ", " +
           files::number_text(curve.fit.lapse) + ")";
}

// One panel: `all` with the people of the same condition and axis.
std::string panel(const PsychometricResult& all, const std::vector<PsychometricResult>& curves, std::size_t number,
                  double from, double to) {
    const std::string block = "$answers_" + std::to_string(number);
    std::string out = "\n" + block + " << EOD\n";
    std::int64_t most = 1;
    for (const study::LevelAnswers& level : all.levels) most = std::max(most, level.n);
    for (const study::LevelAnswers& level : all.levels) {
        const auto n = static_cast<double>(level.n);
        out += files::number_text(level.x) + " " + files::number_text(static_cast<double>(level.stiffer) / n) + " " +
               files::number_text(0.5 + std::sqrt(n / static_cast<double>(most))) + "\n";
    }
    out += "EOD\nset title " + plain_title(all.condition) + "\n";
    const bool second = all.axis == study::StiffnessAxis::second_first;
    out += std::string("set xlabel '") + (second ? "second / first" : "comparison / reference") + "'\n";
    out += std::string("set ylabel '") + (second ? "second" : "comparison") + " called stiffer'\n";
    out += "plot [" + files::number_text(from) + ":" + files::number_text(to) + "] ";
    for (const PsychometricResult& curve : curves) {
        const bool mine = curve.condition == all.condition && curve.axis == all.axis && !curve.participant.empty();
        if (mine && is_drawn(curve)) out += formula(curve) + " with lines lc rgb '#AAAAAA' lw 0.7, ";
    }
    if (is_drawn(all)) out += formula(all) + " with lines lc rgb '#0072B2' lw 3, ";
    return out + block + " using 1:2:3 with points pt 7 ps variable lc rgb '#D55E00'\n";
}

}  // namespace

std::string psychometric_script(const study::Report& report) {
    const std::vector<PsychometricResult>& curves = report.psychometrics.curves;
    std::vector<const PsychometricResult*> panels;
    double from = 0.0, to = 0.0;
    for (const PsychometricResult& curve : curves) {
        if (!curve.participant.empty() || panels.size() == kMostPanels) continue;
        panels.push_back(&curve);
        from = std::min(from, curve.levels.front().x);
        to = std::max(to, curve.levels.back().x);
    }
    const double margin = 0.08 * (to - from) + 1e-3;
    const int columns = std::min(kPanelsInRow, static_cast<int>(panels.size()));
    const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
    const int width_px = columns == 1 ? 700 : 450 * columns, height_px = columns == 1 ? 500 : 380 * rows + 40;
    const std::string px = std::to_string(width_px) + "," + std::to_string(height_px);
    const std::string inches =
        files::number_text(width_px / 100.0) + "in," + files::number_text(height_px / 100.0) + "in";
    std::string out = kPsychometricHead;
    out += "set encoding utf8\n";
    out += "if (kind eq 'png') set terminal pngcairo size " + px + " font 'DejaVu Sans,12'\n";
    out += "if (kind eq 'svg') set terminal svg size " + px + " font 'DejaVu Sans,14' background rgb 'white'\n";
    out += "if (kind eq 'pdf') set terminal pdfcairo size " + inches + " font 'DejaVu Sans,14'\n";
    out += kPsychometricStyle;
    out += "set multiplot layout " + std::to_string(rows) + "," + std::to_string(columns) +
           (report.simulated ? " title 'SIMULATED participants'\n" : "\n");
    for (std::size_t i = 0; i < panels.size(); ++i) out += panel(*panels[i], curves, i, from - margin, to + margin);
    return out + "unset multiplot\n";
}

std::string draw_psychometric_figure(const study::Report& report, const std::filesystem::path& folder) {
    if (report.psychometrics.curves.empty()) return "";
    files::write_text_atomically(folder / "psychometric.gp", psychometric_script(report));
    return draw_script(folder / "psychometric.gp", "the tables are kept");
}

}  // namespace palpa::figures
