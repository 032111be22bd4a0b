#include "tools/plot/plot_axes.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace haptel::tools::plot {

namespace {

constexpr double tick_length = 3.5;
const TextStyle number_style{8, quiet};

// 1, 2 or 5 times a power of ten.
double round_step(double span, int wanted)
{
    const double raw = span / std::max(wanted, 1);
    const double decade = std::pow(10, std::floor(std::log10(raw)));
    for (const double step : {1.0, 2.0, 5.0})
        if (step * decade >= raw * (1 - 1e-9)) return step * decade;
    return 10 * decade;
}

std::string superscript(int exponent)
{
    static constexpr const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text = exponent < 0 ? "⁻" : "";
    for (const char digit : std::to_string(std::abs(exponent))) text += digits[digit - '0'];
    return text;
}

std::string decade_text(int exponent)
{
    if (exponent >= -2 && exponent <= 3) return fmt::format("{:g}", std::pow(10, exponent));
    return "10" + superscript(exponent);
}

std::vector<Tick> linear_ticks(const Axis& axis, int wanted)
{
    std::vector<Tick> result;
    const double step = round_step(axis.high - axis.low, wanted);
    const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
    const bool plain = decimals <= 5 && std::max(std::abs(axis.low), std::abs(axis.high)) < 1e6;
    for (double i = std::ceil(axis.low / step - 1e-6); i * step <= axis.high + 1e-6 * step; ++i) {
        const double value = i == 0 ? 0 : i * step; // not -0
        std::string text = plain ? fmt::format("{:.{}f}", value, decimals) : fmt::format("{:.6g}", value);
        if (text.starts_with('-')) text.replace(0, 1, "−");
        result.push_back({value, std::move(text)});
    }
    return result;
}

std::vector<Tick> decade_ticks(const Axis& axis, int wanted)
{
    std::vector<Tick> result;
    const int first = static_cast<int>(std::floor(std::log10(axis.low) + 1e-9));
    const int last = static_cast<int>(std::ceil(std::log10(axis.high) - 1e-9));
    const int each = std::max(1, (last - first) / std::max(wanted, 1));
    const bool within_a_decade = axis.high / axis.low < 10.5;
    for (int exponent = first; exponent <= last; ++exponent)
        for (int digit = 1; digit < 10; ++digit) {
            const double value = digit * std::pow(10, exponent);
            if (value < axis.low * (1 - 1e-9) || value > axis.high * (1 + 1e-9)) continue;
            if (digit == 1)
                result.push_back({value, (exponent - first) % each == 0 ? decade_text(exponent) : ""});
            else if (last - first <= 6)
                result.push_back(
                    {value, within_a_decade && (digit == 2 || digit == 5) ? fmt::format("{:g}", value) : ""});
        }
    return result;
}

} // namespace

double Axis::share(double value) const
{
    if (logarithmic) return std::log(std::max(value, 1e-300) / low) / std::log(high / low);
    return (value - low) / (high - low);
}

std::vector<Tick> ticks(const Axis& axis, int wanted)
{
    return axis.logarithmic ? decade_ticks(axis, wanted) : linear_ticks(axis, wanted);
}

Axis fitted(std::string label, double low, double high)
{
    // A constant but for rounding, or nothing: ticks so close would have equal labels, and steps from one to the next
    // could be lost.
    const double least = 1e-9 * std::max(std::abs(low), std::abs(high));
    if (!(high - low > least)) {
        const double middle = std::isfinite(low + high) ? (low + high) / 2 : 0;
        const double around = middle != 0 ? std::abs(middle) : 1;
        low = middle - around / 2, high = middle + around / 2;
    }
    const double step = round_step(high - low, 5);
    return {std::move(label), step * std::floor(low / step + 1e-6), step * std::ceil(high / step - 1e-6)};
}

LengthUnit length_unit(double size_m)
{
    const double size = std::abs(size_m);
    if (size >= 1) return {"m", 1};
    if (size >= 0.5e-3) return {"mm", 1e3};
    if (size >= 0.5e-6 || size == 0) return {"µm", 1e6};
    return {"nm", 1e9};
}

std::string length_text(double metres)
{
    const LengthUnit unit = length_unit(metres);
    return fmt::format("{:.3g} {}", metres * unit.per_m, unit.name);
}

void draw_grid(Picture& picture, const Axes& axes, const AxesStyle& style)
{
    const Rect& rect = axes.rect;
    for (const Tick& tick : ticks(axes.x, style.x_ticks)) {
        const double x = axes.at(tick.value, axes.y.low).x;
        if (!tick.text.empty()) picture.line({x, rect.y}, {x, rect.bottom()}, grid, 0.7);
    }
    for (const Tick& tick : ticks(axes.y, style.y_ticks)) {
        const double y = axes.at(axes.x.low, tick.value).y;
        if (!tick.text.empty()) picture.line({rect.x, y}, {rect.right(), y}, grid, 0.7);
    }
}

void draw_axes(Picture& picture, const Axes& axes, const AxesStyle& style)
{
    const Rect& rect = axes.rect;
    picture.frame(rect, quiet, 0.8);
    TextStyle number = number_style;
    number.align = Align::center;
    for (const Tick& tick : ticks(axes.x, style.x_ticks)) {
        const double x = axes.at(tick.value, axes.y.low).x;
        picture.line({x, rect.bottom()}, {x, rect.bottom() + (tick.text.empty() ? 2 : tick_length)}, quiet, 0.8);
        if (style.x_labels) picture.text({x, rect.bottom() + tick_length + 9}, tick.text, number);
    }
    number.align = Align::right;
    double widest = 0;
    for (const Tick& tick : ticks(axes.y, style.y_ticks)) {
        const double y = axes.at(axes.x.low, tick.value).y;
        picture.line({rect.x, y}, {rect.x - (tick.text.empty() ? 2 : tick_length), y}, quiet, 0.8);
        picture.text({rect.x - tick_length - 3, y + 3}, tick.text, number);
        widest = std::max(widest, picture.text_width(tick.text, number));
    }
    if (style.x_labels)
        picture.text({rect.x + rect.width / 2, rect.bottom() + tick_length + 23}, axes.x.label,
                     {9, ink, Align::center});
    picture.text({rect.x - tick_length - widest - 10, rect.y + rect.height / 2}, axes.y.label,
                 {9, ink, Align::center, false, true});
}

void draw_title(Picture& picture, std::string_view title, std::string_view subtitle)
{
    const auto fitting = [&](double y, std::string_view text, TextStyle style) {
        const double room = picture.width() - 32, width = picture.text_width(text, style);
        if (width > room) style.size *= room / width;
        picture.text({16, y}, text, style);
    };
    fitting(23, title, {12, ink, Align::left, true});
    fitting(38, subtitle, {8.5, quiet});
}

void draw_color_bar(Picture& picture, const Rect& rect, const Axis& axis, ColorMap map)
{
    const int steps = static_cast<int>(std::ceil(rect.height * picture.pixels_per_point()));
    Image colors(1, std::max(steps, 2));
    for (int i = 0; i < colors.height; ++i) colors.at(0, i) = map(1 - (i + 0.5) / colors.height);
    picture.image(rect, colors);
    picture.frame(rect, quiet, 0.8);
    double widest = 0;
    for (const Tick& tick : ticks(axis, 6)) {
        const double y = rect.bottom() - axis.share(tick.value) * rect.height;
        picture.line({rect.right(), y}, {rect.right() + (tick.text.empty() ? 2 : tick_length), y}, quiet, 0.8);
        picture.text({rect.right() + tick_length + 3, y + 3}, tick.text, number_style);
        widest = std::max(widest, picture.text_width(tick.text, number_style));
    }
    picture.text({rect.right() + tick_length + widest + 13, rect.y + rect.height / 2}, axis.label,
                 {9, ink, Align::center, false, true});
}

} // namespace haptel::tools::plot
