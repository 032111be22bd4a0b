// A page to draw on, in points, y down; Cairo behind it. Text is DejaVu Sans, antialiased.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

struct _cairo;
struct _cairo_surface;

namespace haptel::tools::plot {

// 0 .. 1, sRGB.
struct Color {
    double red = 0, green = 0, blue = 0, alpha = 1;
};

inline constexpr Color ink{0.13, 0.14, 0.16};
inline constexpr Color quiet{0.42, 0.44, 0.48}; // subtitles, ticks
inline constexpr Color grid{0.90, 0.91, 0.92};
inline constexpr Color accent{0.10, 0.36, 0.62}; // the one line that matters
inline constexpr Color accent_2{0.80, 0.33, 0.12};

struct Point {
    double x = 0, y = 0;
};

struct Rect {
    double x = 0, y = 0, width = 0, height = 0;
    double right() const { return x + width; }
    double bottom() const { return y + height; }
};

// Pixels by rows from the top, one Color each; alpha is not used.
struct Image {
    int width = 0, height = 0;
    std::vector<Color> pixels;
    Image(int w, int h) : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
    Color& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x]; }
};

enum class Align : uint8_t { left, center, right };

struct TextStyle {
    double size = 9;
    Color color = ink;
    Align align = Align::left;
    bool bold = false;
    bool upright = false; // reads from bottom to top
};

class Picture {
public:
    // White; `pixels_per_point` makes the same page sharper, not different.
    Picture(double width, double height, double pixels_per_point);

    double width() const { return width_; }
    double height() const { return height_; }
    double pixels_per_point() const { return pixels_per_point_; }

    void fill(const Rect& rect, const Color& color);
    void frame(const Rect& rect, const Color& color, double line_width);
    void line(Point from, Point to, const Color& color, double line_width);
    void polyline(std::span<const Point> points, const Color& color, double line_width);
    // Stretched over `rect` without smoothing: a pixel of the image is a sample and shows as one.
    void image(const Rect& rect, const Image& image);
    // Baseline at `at`.
    void text(Point at, std::string_view text, const TextStyle& style = {});
    double text_width(std::string_view text, const TextStyle& style);

    // What is drawn between these two is cut off at the rectangle.
    void begin_clip(const Rect& rect);
    void end_clip();

    // Empty, or why the file could not be written.
    std::string write_png(const std::string& file);
    // The bytes of such a file; empty where there is no memory for them.
    std::string png();

private:
    void use(const Color& color);
    void use(const TextStyle& style);

    double width_, height_, pixels_per_point_;
    std::shared_ptr<_cairo_surface> surface_;
    std::shared_ptr<_cairo> cairo_;
};

} // namespace haptel::tools::plot
