#include "figures/stiffness_figure.h"

#include <algorithm>

#include "figures/gnuplot.h"
#include "files/text.h"

namespace palpa::figures {
namespace {

constexpr const char* kStiffnessHead =
    R"gp(# gnuplot stiffness.gp draws stiffness.png; gnuplot -e "kind='svg'" stiffness.gp: or svg, pdf
# Grey: readings of the force sensor over the arm's depth. Red: line through them. Blue: the stiffness that was wanted.
if (!exists("kind")) kind = "png"
set encoding utf8
)gp";

constexpr const char* kStiffnessStyle =
    R"gp(set output "stiffness." . kind
set border 3
set tics nomirror
set xlabel 'depth (mm)'
set ylabel 'force of the hand (N)'
set xrange [0:*]
set grid ytics lc rgb '#BBBBBB' dt 3
set key top left
)gp";

std::string one_panel(const StiffnessPanel& panel) {
    const std::string wanted = files::number_text(panel.wanted_N_per_mm);
    const std::string offset = files::number_text(panel.force_at_0_N);
    return "set title '" + files::short_number(panel.wanted_N_per_mm) + " N/mm wanted, " +
           files::short_number(panel.rendered_N_per_mm) + " rendered, +-" + files::short_number(panel.hysteresis_N) +
           " N'\nplot " + single_quoted(panel.table) +
           " using 1:2 with lines lc rgb '#AAAAAA' lw 0.7 title 'felt', x * " +
           files::number_text(panel.rendered_N_per_mm) + " + " + offset +
           " lc rgb '#D55E00' lw 2 title 'its line', x * " + wanted + " + " + offset +
           " lc rgb '#0072B2' lw 2 dt 2 title 'wanted'\n";
}

}  // namespace

std::string draw_stiffness(const std::vector<StiffnessPanel>& panels, bool simulated,
                           const std::filesystem::path& folder) {
    constexpr int kInRow = 2;
    const int columns = std::min(kInRow, static_cast<int>(panels.size()));
    if (columns == 0) return "";
    const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
    const int width_px = 560 * columns, height_px = 400 * rows + 40;
    const std::string px = std::to_string(width_px) + "," + std::to_string(height_px);
    const std::string inches =
        files::number_text(width_px / 100.0) + "in," + files::number_text(height_px / 100.0) + "in";
    std::string out = kStiffnessHead;
    out += "if (kind eq 'png') set terminal pngcairo size " + px + " font 'DejaVu Sans,11'\n";
    out += "if (kind eq 'svg') set terminal svg size " + px + " font 'DejaVu Sans,13' background rgb 'white'\n";
    out += "if (kind eq 'pdf') set terminal pdfcairo size " + inches + " font 'DejaVu Sans,13'\n";
    out += kStiffnessStyle;
    out += "set multiplot layout " + std::to_string(rows) + "," + std::to_string(columns) +
           (simulated ? " title 'SIMULATED arm and hand'\n" : "\n");
    for (const StiffnessPanel& panel : panels) out += one_panel(panel);
    files::write_text_atomically(folder / "stiffness.gp", out + "unset multiplot\n");
    return draw_script(folder / "stiffness.gp", "the tables are kept");
}

}  // namespace palpa::figures
