#include "figures/froc_figure.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "figures/gnuplot.h"
#include "files/text.h"

namespace palpa::figures {
namespace {

constexpr std::size_t kMostCurves = 12;  // more cannot be told apart

constexpr const char* kFrocHead =
    R"gp(# gnuplot froc.gp draws froc.png; gnuplot -e "kind='svg'" froc.gp: or svg, pdf
# Each point is one rating: the marks with that rating or a higher one, of all people pooled. The line before the highest
# rating goes to 0. The area under such a curve is no figure of merit, because it grows with the number of false marks.
if (!exists("kind")) kind = "png"
set encoding utf8
if (kind eq 'png') set terminal pngcairo size 700,500 font 'DejaVu Sans,12'
if (kind eq 'svg') set terminal svg size 700,500 font 'DejaVu Sans,14' background rgb 'white'
if (kind eq 'pdf') set terminal pdfcairo size 7in,5in font 'DejaVu Sans,14'
set output "froc." . kind
set border 3
set tics nomirror
set grid lc rgb "#BBBBBB" dt 3
set yrange [0:1.02]
set ytics 0.25
set xlabel 'false marks per case'
set ylabel 'share of lesions found'
set key outside right top
colours = "#0072B2 #D55E00 #009E73 #CC79A7 #E69F00 #56B4E9"
colour(i) = word(colours, (i - 1) % words(colours) + 1)
)gp";

// Curves with lesions; the others have no share to draw.
std::vector<const study::FrocCurve*> drawn_curves(const study::Report& report) {
    std::vector<const study::FrocCurve*> curves;
    for (const study::FrocCurve& curve : report.free_response.curves) {
        const bool drawn = !curve.points.empty() && std::isfinite(curve.points.back().llf);
        if (drawn && curves.size() < kMostCurves) curves.push_back(&curve);
    }
    return curves;
}

}  // namespace

std::string froc_script(const study::Report& report) {
    const std::vector<const study::FrocCurve*> curves = drawn_curves(report);
    std::string out = kFrocHead, plot;
    double last = 0.0;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const std::string number = std::to_string(i + 1), block = "$froc_" + number;
        out += block + " << EOD\n0 0\n";
        for (const study::FrocPoint& point : curves[i]->points) {
            out += files::number_text(point.nlf) + " " + files::number_text(point.llf) + "\n";
            last = std::max(last, point.nlf);
        }
        out += "EOD\n";
        plot += (plot.empty() ? "" : ", \\\n    ") + block + " using 1:2 with linespoints pt " + std::to_string(4 + i) +
                " dt " + std::to_string(1 + i % 5) + " lw 2 lc rgb colour(" + number + ") title " +
                single_quoted(curves[i]->condition) + " noenhanced";
    }
    if (report.simulated) out += "set title 'SIMULATED participants'\n";
    return out + "plot [0:" + files::number_text(last > 0.0 ? 1.05 * last : 1.0) + "] " + plot + "\n";
}

std::string draw_froc_figure(const study::Report& report, const std::filesystem::path& folder) {
    if (drawn_curves(report).empty()) return "";
    files::write_text_atomically(folder / "froc.gp", froc_script(report));
    return draw_script(folder / "froc.gp", "the tables are kept");
}

}  // namespace palpa::figures
