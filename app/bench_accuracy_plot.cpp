// The work-precision figure, by gnuplot.

#include <cstdlib>

#include "app/bench_accuracy.h"
#include "files/text.h"

namespace palpa {
namespace {

// Colours by Okabe and Ito, which colour-blind people can tell apart; the marker says the same again.
constexpr const char* kScript =
    R"gp(# gnuplot mechanics.gp: draws mechanics.csv as mechanics.png, .svg and .pdf
set datafile separator ","
set datafile missing "n/a"
f = "mechanics.csv"
# an exact zero is drawn at the lower edge
floored(e) = abs(e) < 1e-13 ? 1e-13 : abs(e)
error_of(group, line, what) = (strcol(1) eq group && strcol(2) eq line) ? floored(column(what)) : NaN
set style line 1 lc rgb "#D55E00" lw 2 pt 9 ps 1.1
set style line 2 lc rgb "#0072B2" lw 2 pt 5 ps 1.0
set style line 3 lc rgb "#009E73" lw 2 pt 7 ps 1.1
set style line 4 lc rgb "#CC79A7" lw 2 pt 13 ps 1.3
set style line 5 lc rgb "#E69F00" lw 2 pt 11 ps 1.1
set style line 6 lc rgb "#000000" lw 2 pt 4 ps 1.1
set style line 9 lc rgb "#999999" lw 1
set logscale xy
set grid xtics ytics ls 9 dt 3
set tics nomirror
set border 3
set format x "10^{%L}"
set format y "10^{%L}"
set key samplen 2 spacing 1.1

do for [kind in "png svg pdf"] {
    if (kind eq "png") { set terminal pngcairo size 1650,1060 font "DejaVu Sans,13" }
    if (kind eq "svg") { set terminal svg size 1650,1060 font "DejaVu Sans,15" background rgb "white" }
    if (kind eq "pdf") { set terminal pdfcairo size 16.5in,10.6in font "DejaVu Sans,13" }
    set output "mechanics.".kind
    set multiplot layout 2,3 margins 0.055,0.985,0.075,0.905 spacing 0.065,0.135 \
        title "What accuracy costs in time: mechanics (down and left is better)\n{/*0.8 ".machine."}"

    set xlabel "assemble + factor (s; least of the repetitions)"
    set ylabel "|error| of the mean depression (%)"
    set xrange [0.002:10]
    set yrange [0.1:200]
    set key bottom left
    do for [nu in "0.3 0.45 0.499"] {
    set title "Slab, 25 mN parabola, Poisson ratio ".nu
        ."\n{/*0.85 486, 2,890, 8,750, 19,602 nodes; against the Richardson limit}" plot f using(
            column("offline_s"))
        : (error_of("slab", "tet4 nu ".nu, "error_percent"))with linespoints ls 1 title "tetrahedra (tet4)",
    f using(column("offline_s"))
        : (error_of("slab", "hex8 nu ".nu, "error_percent"))with linespoints ls 2 title "hexahedra (hex8)",
          f using(column("offline_s"))
        : (error_of("slab", "hex8-bbar nu ".nu, "error_percent"))with linespoints ls 3 title
          "hexahedra, B-bar"
    }

    set title "Ball of 8 mm, contact mesh\n{/*0.85 bars reach the worst of 27 places and depths (Hertz: 9 depths)}"
    set xlabel "factor + surface compliance (s)"
    set ylabel "rms error of the force (%)"
    set xrange [0.02:30]
    set yrange [0.1:200]
    worst(line, group) = error_of(group, line, "worst_error_percent")
    plot f using (column("offline_s")):(error_of("contact mesh", "tet4", "error_percent")):(error_of("contact mesh", "tet4", "error_percent")):(worst("tet4", "contact mesh")) with yerrorbars ls 1 notitle, \
         f using (column("offline_s")):(error_of("contact mesh", "tet4", "error_percent")) with linespoints ls 1 title "tet4, finest mesh", \
         f using (column("offline_s")):(error_of("contact mesh", "hex8", "error_percent")):(error_of("contact mesh", "hex8", "error_percent")):(worst("hex8", "contact mesh")) with yerrorbars ls 2 notitle, \
         f using (column("offline_s")):(error_of("contact mesh", "hex8", "error_percent")) with linespoints ls 2 title "hex8, finest mesh", \
         f using (column("offline_s")):(error_of("contact mesh", "hex8-bbar", "error_percent")):(error_of("contact mesh", "hex8-bbar", "error_percent")):(worst("hex8-bbar", "contact mesh")) with yerrorbars ls 3 notitle, \
         f using (column("offline_s")):(error_of("contact mesh", "hex8-bbar", "error_percent")) with linespoints ls 3 title "B-bar, finest mesh", \
         f using (column("offline_s")):(error_of("contact Hertz", "hex8-bbar against Hertz", "error_percent")):(error_of("contact Hertz", "hex8-bbar against Hertz", "error_percent")):(worst("hex8-bbar against Hertz", "contact Hertz")) with yerrorbars ls 6 notitle, \
         f using (column("offline_s")):(error_of("contact Hertz", "hex8-bbar against Hertz", "error_percent")) with linespoints ls 6 title "B-bar, Hertz"

    set title "Contact algorithm\n{/*0.85 mean step; bar to the 99th percentile}"
    set xlabel "one step (us)"
    set ylabel "rms error (%)"
    set xrange [5:20000]
    set yrange [1e-14:1000]
    set ytics 100
    set key bottom right
    plot f using (column("per_step_us")):(error_of("contact solver", "active set; warm", "error_percent")):(column("per_step_us")):(column("per_step_p99_us")) with xerrorbars ls 3 title "active set, warm", \
         f using (column("per_step_us")):(error_of("contact solver", "active set; cold", "error_percent")):(column("per_step_us")):(column("per_step_p99_us")) with xerrorbars ls 6 title "active set, cold", \
         f using (column("per_step_us")):(strcol(1) eq "contact solver" && strstrt(strcol(2), "Gauss") == 1 ? floored(column("error_percent")) : NaN):(column("per_step_us")):(column("per_step_p99_us")) with xerrorbars ls 2 title "Gauss-Seidel 10, 20, 50", \
         f using (column("per_step_us")):(strcol(1) eq "friction" && strstrt(strcol(2), "0.3") == 1 ? floored(column("error_percent")) : NaN):(column("per_step_us")):(column("per_step_p99_us")) with xerrorbars ls 1 title "friction 0.3, to 1e-2 ... 1e-7", \
         f using (column("per_step_us")):(error_of("friction", "off (active set)", "error_percent")):(column("per_step_us")):(column("per_step_p99_us")) with xerrorbars ls 4 title "friction left out"

    set title "Solver, and what is kept between steps\n{/*0.85 mean step; bar to the 99th percentile}"
    set xlabel "one step, or one right-hand side (us)"
    set xrange [10:1e7]
    set yrange [1e-14:1e-6]
    plot f using (column("per_step_us")):(error_of("live step", "compliance kept", "error_percent")):(column("per_step_us")):(column("per_step_p99_us")) with xerrorbars ls 3 title "step, compliance kept", \
         f using (column("per_step_us")):(error_of("live step", "factor kept; columns in each step", "error_percent")):(column("per_step_us")):(column("per_step_p99_us")) with xerrorbars ls 5 title "step, factor kept", \
         f using (column("per_step_us")):(error_of("live step", "nothing kept; all in each step", "error_percent")):(column("per_step_us")):(column("per_step_p99_us")) with xerrorbars ls 1 title "step, nothing kept", \
         f using (column("per_step_us")):(error_of("sparse solver", "MUMPS", "error_percent")):(column("per_step_us")):(column("per_step_p99_us")) with xerrorbars ls 2 title "MUMPS, one right-hand side", \
         f using (column("per_step_us")):(error_of("sparse solver", "Eigen LDLT", "error_percent")):(column("per_step_us")):(column("per_step_p99_us")) with xerrorbars ls 4 title "Eigen, one right-hand side"
    unset multiplot
    unset output
    set ytics autofreq
    set key bottom left
}
)gp";

std::string shell_quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

}  // namespace

std::string plot_mechanics(const std::filesystem::path& folder, const Machine& machine) {
    const std::string label = machine.processor + ", " + std::to_string(machine.threads) + " threads, load " +
                              short_number(machine.load) + ", " + machine.date;
    write_text_atomically(folder / "mechanics.gp", "machine = \"" + label + "\"\n" + kScript);
    if (std::system("command -v gnuplot >/dev/null 2>&1") != 0)
        return "gnuplot is not installed (package gnuplot-nox), so there is no figure; mechanics.csv and "
               "mechanics.gp "
               "are kept: run `gnuplot mechanics.gp` where it is";
    if (std::system(("cd " + shell_quoted(folder.string()) + " && gnuplot mechanics.gp").c_str()) != 0)
        return "gnuplot could not draw " + (folder / "mechanics.gp").string() + "; mechanics.csv is kept";
    return "";
}

}  // namespace palpa
