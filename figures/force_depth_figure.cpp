#include "figures/force_depth_figure.h"

#include <algorithm>

#include "figures/gnuplot.h"
#include "files/text.h"

namespace palpa::figures {
namespace {

constexpr const char* kForceDepthHead =
    R"gp(# gnuplot force-depth.gp draws force-depth.png; gnuplot -e "kind='svg'" force-depth.gp: or svg, pdf
# Red: the force that the plant gave the finger, there and back. Blue: the force of the virtual tissue at that depth.
if (!exists("kind")) kind = "png"
set encoding utf8
)gp";

constexpr const char* kForceDepthStyle =
    R"gp(set output "force-depth." . kind
set datafile missing "n/a"
set border 3
set tics nomirror
set xlabel 'depth of the finger (mm)'
set ylabel 'force on the finger (N)'
set xrange [0:*]
set yrange [0:*]
set grid ytics lc rgb '#BBBBBB' dt 3
set key top left
)gp";

}  // namespace

std::string draw_force_depth(const std::vector<ForceDepthPanel>& panels, const std::filesystem::path& folder) {
    constexpr int kAcross = 3;
    const int columns = std::min(kAcross, static_cast<int>(panels.size()));
    if (columns == 0) return "";
    const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
    const int width_px = 460 * columns, height_px = 380 * rows + 40;
    const std::string px = std::to_string(width_px) + "," + std::to_string(height_px);
    const std::string inches =
        files::number_text(width_px / 100.0) + "in," + files::number_text(height_px / 100.0) + "in";
    std::string out = kForceDepthHead;
    out += "if (kind eq 'png') set terminal pngcairo size " + px + " font 'DejaVu Sans,11'\n";
    out += "if (kind eq 'svg') set terminal svg size " + px + " font 'DejaVu Sans,13' background rgb 'white'\n";
    out += "if (kind eq 'pdf') set terminal pdfcairo size " + inches + " font 'DejaVu Sans,13'\n";
    out += kForceDepthStyle;
    out +=
        "set multiplot layout " + std::to_string(rows) + "," + std::to_string(columns) + " title 'SIMULATED device'\n";
    for (const ForceDepthPanel& panel : panels)
        out += "set title " + single_quoted(panel.title) + "\nplot " + single_quoted(panel.table) +
               " using 'depth_mm':'force_N' with lines lc rgb '#D55E00' lw 2 title 'rendered', '' using "
               "'depth_mm':'wanted_N' with lines lc rgb '#0072B2' lw 2 dt 2 title 'wanted'\n";
    files::write_text_atomically(folder / "force-depth.gp", out + "unset multiplot\n");
    return draw_script(folder / "force-depth.gp", "the tables are kept");
}

}  // namespace palpa::figures
