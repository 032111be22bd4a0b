// From data to page: axes with round numbers, units with the right prefix, grid, ticks, titles, colour bars.
#pragma once

#include "tools/plot/plot_colors.h"
#include "tools/plot/plot_picture.h"

#include <string>
#include <vector>

namespace haptel::tools::plot {

struct Axis {
    std::string label; // "time (s)"
    double low = 0, high = 1;
    bool logarithmic = false; // low > 0

    // 0 at low, 1 at high.
    double share(double value) const;
};

struct Tick {
    double value = 0;
    std::string text; // empty: a minor tick
};

// At 1, 2 or 5 times a power of ten, about `wanted` of them within the axis; decades where it is logarithmic.
std::vector<Tick> ticks(const Axis& axis, int wanted);

// The axis from the smallest to the largest value, stretched to the next round numbers; never of zero length.
Axis fitted(std::string label, double low, double high);

// A prefix that makes lengths around `size_m` readable: {"µm", 1e6}: multiply metres by it.
struct LengthUnit {
    std::string name;
    double per_m = 1;
};
LengthUnit length_unit(double size_m);
std::string length_text(double metres); // "12 µm"

// A rectangle of the page with an axis along x (rising to the right) and y (rising to the top).
struct Axes {
    Rect rect;
    Axis x, y;

    Point at(double x_value, double y_value) const
    {
        return {rect.x + x.share(x_value) * rect.width, rect.bottom() - y.share(y_value) * rect.height};
    }
};

struct AxesStyle {
    bool x_labels = true; // numbers and label; false for a panel above another one with the same axis
    int x_ticks = 6, y_ticks = 5;
};

void draw_grid(Picture& picture, const Axes& axes, const AxesStyle& style = {}); // below the data
void draw_axes(Picture& picture, const Axes& axes, const AxesStyle& style = {}); // above it
void draw_title(Picture& picture, std::string_view title, std::string_view subtitle);

// Colours from the bottom (low) to the top (high), with numbers on the right.
void draw_color_bar(Picture& picture, const Rect& rect, const Axis& axis, ColorMap map);

} // namespace haptel::tools::plot
