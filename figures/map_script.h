#pragma once
// The gnuplot script of a figure of maps: pictures of numbers on a grid, side by side.

#include <cstddef>
#include <string>
#include <vector>

namespace palpa::figures {

std::string text_of(double value);  // "NaN" if not finite

// Returns the text in single quotes, none of it interpreted as markup.
std::string quoted(const std::string& text);

struct Span {
    double low = 0.0;
    double high = 1.0;
};

// Returns the span from the least to the greatest finite value, widened if they are equal; 0 to 1 if there is none.
Span span_of(const std::vector<double>& values);

// A picture of numbers on a grid; x and y in mm, (x0, y0) is the centre of the first cell.
struct Image {
    std::string title;
    std::string x_label = "x (mm)";
    std::string y_label = "y (mm)";
    std::string unit;
    double x0 = 0.0, dx = 1.0, y0 = 0.0, dy = 1.0;
    std::size_t n_x = 1, n_y = 1;
    std::vector<double> values;  // [n_y][n_x]
    Span span;
    bool apart = false;  // signed: colours blue to red around 0
    bool bar = true;
    bool small = false;       // one of small multiples: numbers at the outer axes only
    bool title_left = false;  // leaves room for a key
    bool down = false;        // y grows downwards, on a scale of its own
    std::string over;         // further plot elements
    std::string before;       // commands before the plot
};

struct Box {
    double x0, x1, y0, y1;  // of the drawing area, as shares of the figure, y upwards
};

class Script {
  public:
    Script(const std::string& title, double width_px, double height_px);
    void add(const std::string& text) { text_ += text; }

    // Adds the rows as a block of data and returns its name.
    std::string block(const std::string& rows);

    void image(const Image& im, Box box);
    void place(const Box& box);
    std::string whole() const { return blocks_text_ + "set multiplot\n" + text_ + "unset multiplot\n"; }

  private:
    double width_px_;
    double height_px_;
    std::string text_;
    std::string blocks_text_;
    int blocks_ = 0;
};

}  // namespace palpa::figures
