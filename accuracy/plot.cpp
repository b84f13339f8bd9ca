// The work-precision figure, by gnuplot.

#include "accuracy/accuracy.h"
#include "figures/gnuplot.h"
#include "files/text.h"

namespace palpa::accuracy {
namespace {

// Colours by Okabe and Ito, which colour-blind people can distinguish; the markers repeat the distinction.
constexpr const char* kScript =
    R"gp(# gnuplot mechanics.gp draws mechanics.csv as mechanics.png; gnuplot -e "kind='svg'" mechanics.gp: or svg, pdf
if (!exists("kind")) kind = "png"
set datafile separator ","
set datafile missing NaN
f = "mechanics.csv"
# an exact zero is drawn at the lower edge
floored(e) = abs(e) < 2e-14 ? 2e-14 : abs(e)
mine(group, line) = strcol("group") eq group && strcol("series") eq line
err(group, line) = mine(group, line) ? floored(column("error_percent")) : NaN
worst(group, line) = mine(group, line) ? floored(column("worst_error_percent")) : NaN
starts(group, begin) = strcol("group") eq group && strstrt(strcol("choice"), begin) == 1
err_of(group, begin) = starts(group, begin) ? floored(column("error_percent")) : NaN
offline(n) = column("offline_s")
step(n) = column("per_step_us")
late(n) = column("per_step_p99_us")

set style line 1 lc rgb "#D55E00" lw 2 pt 9 ps 1.4
set style line 2 lc rgb "#0072B2" lw 2 pt 5 ps 1.2
set style line 3 lc rgb "#009E73" lw 2 pt 7 ps 1.3
set style line 4 lc rgb "#CC79A7" lw 2 pt 13 ps 1.6
set style line 5 lc rgb "#E69F00" lw 2 pt 11 ps 1.4
set style line 6 lc rgb "#000000" lw 2 pt 4 ps 1.3
set style line 9 lc rgb "#BBBBBB" lw 1 dt 3
set logscale xy
set grid xtics ytics ls 9
set tics nomirror
set border 3
set format x "10^{%L}"
set format y "10^{%L}"
set key samplen 2 spacing 1.1

if (kind eq "png") set terminal pngcairo size 1500,1000 font "DejaVu Sans,13"
if (kind eq "svg") set terminal svg size 1500,1000 font "DejaVu Sans,14" background rgb "white"
if (kind eq "pdf") set terminal pdfcairo size 15in,10in font "DejaVu Sans,13"
set output "mechanics." . kind
set multiplot layout 2,3 margins 0.055,0.985,0.07,0.885 spacing 0.072,0.15 \
    title "What accuracy costs in time: mechanics (down and left is better)\n{/*0.8 " . machine . "}"

set xlabel "assemble + factor (s; least of the repetitions)"
set ylabel "|error| of the mean depression (%)"
# the usual range at least, and every point that was measured
set xrange [* < 0.002 : 20 < *]
set yrange [* < 0.04 : 200 < *]
set key bottom left Left reverse
do for [nu in "0.3 0.45 0.499"] {
    set title "Slab, parabolic load, Poisson ratio " . nu . "\n{/*0.8 graded meshes, a point each; against Richardson's limit}"
    plot f using (offline(0)):(err("slab", "tet4 nu " . nu)) with linespoints ls 1 title "tetrahedra (tet4)", \
         f using (offline(0)):(err("slab", "hex8 nu " . nu)) with linespoints ls 2 title "hexahedra (hex8)", \
         f using (offline(0)):(err("slab", "hex8-bbar nu " . nu)) with linespoints ls 3 title "hexahedra, B-bar", \
         f using (offline(0)):(err("slab", "hex8-bbar uniform nu " . nu)) with points ls 6 title "B-bar, not graded"
}

set title "Ball of 8 mm pressed 2 mm: mesh\n{/*0.8 bars to the worst of 27 places and depths}"
set xlabel "factor + surface compliance (s)"
set ylabel "rms error of the force (%)"
hertz = "hex8-bbar against Hertz"
plot f using (offline(0)):(err("contact mesh", "tet4")):(err("contact mesh", "tet4")):(worst("contact mesh", "tet4")) with yerrorbars ls 1 notitle, \
     f using (offline(0)):(err("contact mesh", "tet4")) with linespoints ls 1 title "tet4, finest mesh", \
     f using (offline(0)):(err("contact mesh", "hex8")):(err("contact mesh", "hex8")):(worst("contact mesh", "hex8")) with yerrorbars ls 2 notitle, \
     f using (offline(0)):(err("contact mesh", "hex8")) with linespoints ls 2 title "hex8, finest mesh", \
     f using (offline(0)):(err("contact mesh", "hex8-bbar")):(err("contact mesh", "hex8-bbar")):(worst("contact mesh", "hex8-bbar")) with yerrorbars ls 3 notitle, \
     f using (offline(0)):(err("contact mesh", "hex8-bbar")) with linespoints ls 3 title "B-bar, finest mesh", \
     f using (offline(0)):(err("contact Hertz", hertz)):(err("contact Hertz", hertz)):(worst("contact Hertz", hertz)) with yerrorbars ls 6 notitle, \
     f using (offline(0)):(err("contact Hertz", hertz)) with linespoints ls 6 title "B-bar, Hertz (1 mm deep)"

set title "Contact algorithm\n{/*0.8 median; bar to the 99th percentile; an exact 0 at the lower edge}"
set xlabel "one step (us)"
set key noreverse Right at graph 1.0, 0.44 right top font ",11"
set ylabel "rms error (%)"
set xrange [* < 1 : 1e6 < *]
set yrange [1e-14 : 1e3 < *]
set ytics 100
plot f using (step(0)):(err("contact solver", "active set; warm")):(step(0)):(late(0)) with xerrorbars ls 3 title "active set, warm", \
     f using (step(0)):(err("contact solver", "active set; cold")):(step(0)):(late(0)) with xerrorbars ls 6 title "active set, cold", \
     f using (step(0)):(err_of("contact solver", "Gauss")):(step(0)):(late(0)) with xerrorbars ls 2 title "Gauss-Seidel, 2 ... 50", \
     f using (step(0)):(err_of("friction", "0.3")):(step(0)):(late(0)) with xerrorbars ls 1 title "friction, to 1e-2 ... 1e-7", \
     f using (step(0)):(err_of("friction", "off")):(step(0)):(late(0)) with xerrorbars ls 4 title "friction left out"

set title "Sparse solver, and what is kept between steps\n{/*0.8 median; bar to the 99th percentile}"
set xlabel "one step, or one right-hand side (us)"
set key noreverse Right at graph 1.0, 0.98 right top font ",13"
set xrange [* < 1 : 1e8 < *]
set yrange [1e-14 : 1e-9 < *]
set ytics 10
plot f using (step(0)):(err_of("live step", "compliance")):(step(0)):(late(0)) with xerrorbars ls 3 title "step, compliance kept", \
     f using (step(0)):(err_of("live step", "factor")):(step(0)):(late(0)) with xerrorbars ls 5 title "step, only the factor kept", \
     f using (step(0)):(err_of("live step", "nothing")):(step(0)):(late(0)) with xerrorbars ls 1 title "step, nothing kept", \
     f using (step(0)):(err_of("sparse solver", "MUMPS")):(step(0)):(late(0)) with xerrorbars ls 2 title "MUMPS, one right-hand side", \
     f using (step(0)):(err_of("sparse solver", "Eigen")):(step(0)):(late(0)) with xerrorbars ls 4 title "Eigen, one right-hand side"
unset multiplot
)gp";

}  // namespace

std::string plot_list(const std::filesystem::path& folder, const std::string& name, const std::string& script,
                      const Machine& machine) {
    const std::string label = machine.processor + ", " + std::to_string(machine.threads) + " threads, load " +
                              files::short_number(machine.load) + ", " + machine.date;
    files::write_text_atomically(folder / (name + ".gp"), "machine = " + figures::single_quoted(label) + "\n" + script);
    return figures::draw_script(folder / (name + ".gp"), name + ".csv is kept");
}

std::string plot_mechanics(const std::filesystem::path& folder, const Machine& machine) {
    return plot_list(folder, "mechanics", kScript, machine);
}

}  // namespace palpa::accuracy
