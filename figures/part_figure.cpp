#include "figures/part_figure.h"

#include <algorithm>
#include <array>

#include "figures/gnuplot.h"
#include "files/text.h"

namespace palpa::figures {
namespace {

std::string row(double first, double second) {
    return files::number_text(first) + " " + files::number_text(second) + "\n";
}

std::string line_block(const char* name, const DesignLine& design, double force_N) {
    return "$" + std::string(name) + " << EOD\n0 0\n" + row(1e3 * force_N / design.stiffness_N_per_m, force_N) +
           "EOD\n";
}

// A triangle from no force to the smallest and the largest displacement that are told from the first design's.
std::string band_block(std::size_t n, const DesignLine& design, double force_N, double fraction) {
    const double mm = 1e3 * force_N / design.stiffness_N_per_m;
    return "$band" + std::to_string(n) + " << EOD\n0 0\n" + row(mm / (1.0 + fraction), force_N) +
           row(mm * (1.0 + fraction), force_N) + "0 0\nEOD\n";
}

std::string key_of(const DesignLine& design) {
    return single_quoted(design.name + ": " + files::short_number(1e-3 * design.stiffness_N_per_m) + " N/mm, " +
                         files::short_number(1e3 * design.mass_kg) + " g" + (design.applies ? "" : ", DOES NOT APPLY"));
}

}  // namespace

std::string designs_script(const DesignLine& a, const DesignLine& b, double force_N,
                           const std::vector<double>& weber_fractions) {
    std::vector<double> widest_first;
    if (a.applies && b.applies) widest_first = weber_fractions;
    std::sort(widest_first.rbegin(), widest_first.rend());
    std::string out = line_block("a", a, force_N) + line_block("b", b, force_N);
    for (std::size_t i = 0; i < widest_first.size(); ++i) out += band_block(i, a, force_N, widest_first[i]);
    out +=
        R"gp(set border 3
set tics nomirror
set xlabel 'displacement (mm)'
set ylabel 'force (N)'
set xrange [0:*]
set yrange [0:*]
set key bottom right opaque
set style fill solid 1 noborder
plot )gp";
    constexpr std::array kTints{"#E8EEF4", "#CFDDEB"};
    for (std::size_t i = 0; i < widest_first.size(); ++i) {
        out += "$band" + std::to_string(i) + " using 1:2 with filledcurves closed fc rgb '" +
               kTints[std::min(i, kTints.size() - 1)] + "' title 'within " +
               files::short_number(100.0 * widest_first[i]) + " % of the first, hard to tell', \\\n     ";
    }
    out += "$a using 1:2 with lines lc rgb '#0072B2' lw 2 title " + key_of(a);
    return out + ", \\\n     $b using 1:2 with lines lc rgb '#D55E00' lw 2 dt 2 title " + key_of(b) + "\n";
}

void plot_designs(const DesignLine& a, const DesignLine& b, double force_N, const std::vector<double>& weber_fractions,
                  const std::filesystem::path& file) {
    draw_figure(designs_script(a, b, force_N, weber_fractions), file, 900, 600);
}

}  // namespace palpa::figures
