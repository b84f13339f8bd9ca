#include "figures/map_script.h"

#include <algorithm>
#include <cmath>

#include "figures/colour_maps.h"
#include "figures/gnuplot.h"
#include "figures/tic_step.h"
#include "files/text.h"

namespace palpa::figures {
namespace {

// Colours by Okabe and Ito, which colour-blind people can distinguish.
constexpr const char* kHead =
    R"gp(set border lw 0.8
set tics out nomirror scale 0.5
set cbtics scale 0.4
set style line 1 lc rgb "#D55E00" lw 2 pt 7 ps 0.8
set style line 2 lc rgb "#0072B2" lw 2 pt 5 ps 0.8
set style line 3 lc rgb "#009E73" lw 2 pt 9 ps 0.9
set style line 4 lc rgb "#CC79A7" lw 2 pt 13 ps 0.9
set style line 5 lc rgb "#E69F00" lw 2 pt 11 ps 0.9
set style line 6 lc rgb "#000000" lw 2 pt 4 ps 0.9
)gp";

std::string rows_of(const Image& im) {
    std::string rows;
    for (std::size_t j = 0; j < im.n_y; ++j) {
        for (std::size_t i = 0; i < im.n_x; ++i) {
            rows += text_of(im.x0 + im.dx * static_cast<double>(i)) + " " +
                    text_of(im.y0 + im.dy * static_cast<double>(j)) + " " + text_of(im.values[j * im.n_x + i]) + "\n";
        }
    }
    return rows;
}

}  // namespace

std::string text_of(double value) { return std::isfinite(value) ? files::number_text(value) : "NaN"; }

std::string quoted(const std::string& text) { return single_quoted(text) + " noenhanced"; }

Span span_of(const std::vector<double>& values) {
    Span span{INFINITY, -INFINITY};
    for (const double v : values) {
        if (!std::isfinite(v)) continue;
        span.low = std::min(span.low, v);
        span.high = std::max(span.high, v);
    }
    if (!(span.low <= span.high)) return {0.0, 1.0};
    if (span.low == span.high) span.high = span.low + std::max(1e-6, 0.1 * std::abs(span.low));
    return span;
}

Script::Script(const std::string& title, double width_px, double height_px)
    : width_px_(width_px),
      height_px_(height_px),
      text_(kHead + ("set label 99 " + quoted(title) + " at screen 0.5, screen " + text_of(1.0 - 16.0 / height_px) +
                     " center font ',13'\n")) {}

std::string Script::block(const std::string& rows) {
    const std::string name = "$d" + std::to_string(++blocks_);
    blocks_text_ += name + " << EOD\n" + rows + "EOD\n";
    return name;
}

void Script::image(const Image& im, Box box) {
    // the box is made as wide as the picture will be, so that the colour bar stands beside it
    const double aspect = im.dy * static_cast<double>(im.n_y) / (im.dx * static_cast<double>(im.n_x));
    if (!im.down) box.x1 = std::min(box.x1, box.x0 + (box.y1 - box.y0) * height_px_ / aspect / width_px_);
    const std::string data = block(rows_of(im));
    place(box);
    text_ += "set palette " + gnuplot_palette(im.apart ? kApart : kViridis) + "\n";
    text_ += "set cbrange [" + text_of(im.span.low) + ":" + text_of(im.span.high) + "]\n";
    text_ += im.bar ? "set colorbox user origin screen " + text_of(box.x1 + 0.008) + ", screen " + text_of(box.y0) +
                          " size screen 0.012, screen " + text_of(box.y1 - box.y0) + "\nset cblabel " +
                          quoted(im.unit) + " offset 0.5,0\n"
                    : "unset colorbox\n";
    text_ += im.down ? "set size noratio\n" : "set size ratio -1\n";
    const double x1 = im.x0 + im.dx * (static_cast<double>(im.n_x) - 0.5);
    const double y1 = im.y0 + im.dy * (static_cast<double>(im.n_y) - 0.5);
    text_ += "set xrange [" + text_of(im.x0 - 0.5 * im.dx) + ":" + text_of(x1) + "]\n";
    const std::string low = text_of(im.y0 - 0.5 * im.dy);
    text_ += "set yrange [" + (im.down ? text_of(y1) + ":" + low : low + ":" + text_of(y1)) + "]\n";
    text_ += "set xlabel " + quoted(im.x_label) + " offset 0,0.5\nset ylabel " + quoted(im.y_label) + " offset 1,0\n";
    text_ += im.title_left
                 ? "unset title\nset label 98 " + quoted(im.title) + " at graph 0, graph 1 left offset 0,0.7\n"
                 : "set title " + quoted(im.title) + " offset 0,-0.6\n";
    if (im.small && im.y_label.empty()) text_ += "set format y ''\n";
    if (im.small && im.x_label.empty()) text_ += "set format x ''\n";
    text_ += im.before;
    text_ +=
        "set object 1 rectangle from graph 0,0 to graph 1,1 fc rgb '#9a9a9a' fs pattern 4 noborder behind\nset "
        "grid noxtics noytics\n";
    text_ +=
        "set xtics " +
        text_of(tic_step(im.dx * static_cast<double>(im.n_x), std::max(4.0, (box.x1 - box.x0) * width_px_ / 70.0))) +
        "\n";
    text_ += im.down
                 ? "set ytics autofreq\n"
                 : "set ytics " +
                       text_of(tic_step(im.dy * static_cast<double>(im.n_y), std::max(4.0, (box.x1 - box.x0) * 20.0))) +
                       "\n";
    text_ += "plot " + data + " using 1:2:3 with image notitle" + im.over +
             "\nunset object 1\nunset label\nset key default\nset xtics autofreq\nset ytics autofreq\nset format x "
             "'% h'\nset format y '% h'\n";
}

void Script::place(const Box& box) {
    text_ += "set lmargin at screen " + text_of(box.x0) + "\nset rmargin at screen " + text_of(box.x1) +
             "\nset bmargin at screen " + text_of(box.y0) + "\nset tmargin at screen " + text_of(box.y1) + "\n";
}

}  // namespace palpa::figures
