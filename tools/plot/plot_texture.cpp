#include "tools/plot/plot_texture.h"

#include "tools/output/terminal.h"
#include "tools/plot/plot_axes.h"
#include "tools/plot/plot_ball.h"
#include "tools/plot/plot_colors.h"
#include "tools/plot/plot_grid.h"
#include "tools/plot/plot_spectrum.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <vector>

namespace haptel::tools::plot {

namespace {

constexpr double page = 512; // points, each way
constexpr Rect map_rect{60, 58, 384, 384};

Picture new_picture(const TextureView& view)
{
    return {page, page, view.size_px / page};
}

std::string length_text(double metres)
{
    const LengthUnit unit = length_unit(metres);
    return fmt::format("{:.3g} {}", metres * unit.per_m, unit.name);
}

int pixels(const Picture& picture, double points)
{
    return std::max(1, static_cast<int>(std::lround(points * picture.pixels_per_point())));
}

// "x (mm)" and "y (mm)" round the window.
Axes window_axes(const TextureView& view, const Rect& rect)
{
    const LengthUnit unit = length_unit(view.window_m);
    const auto axis = [&](const char* name, double center_m) {
        return Axis{fmt::format("{} ({})", name, unit.name), (center_m - view.window_m / 2) * unit.per_m,
                    (center_m + view.window_m / 2) * unit.per_m};
    };
    return {rect, axis("x", view.center_m.x), axis("y", view.center_m.y)};
}

std::string statistics(const Range& height, const Range& slope)
{
    const double steepest = std::max(std::abs(slope.low), std::abs(slope.high));
    return fmt::format("peak to valley {}  ·  rms {}  ·  slope rms {:.3g}, largest {:.3g}",
                       length_text(height.high - height.low), length_text(height.deviation()), slope.rms(), steepest);
}

Picture draw_height(const TextureView& view)
{
    Picture picture = new_picture(view);
    const int n = pixels(picture, map_rect.width);
    const Grid grid_of_samples(view, n, n);
    const Range& height = grid_of_samples.height;
    const LengthUnit unit = length_unit(std::max(std::abs(height.low), std::abs(height.high)));
    Axis axis{fmt::format("height ({})", unit.name), height.low * unit.per_m, height.high * unit.per_m};
    if (!(axis.high > axis.low)) axis = fitted(axis.label, axis.low, axis.high);

    Image image(n, n);
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column)
            image.at(column, row) = viridis(axis.share(grid_of_samples.at(column, row).height_m * unit.per_m));
    picture.image(map_rect, image);
    draw_axes(picture, window_axes(view, map_rect));
    draw_color_bar(picture, {map_rect.right() + 10, map_rect.y, 9, map_rect.height}, axis, viridis);
    draw_title(picture, view.title, "height   " + statistics(height, grid_of_samples.slope));
    return picture;
}

Image relief_of(const Grid& samples, int n, double factor)
{
    constexpr int fine = samples_per_pixel;
    Image image(n, n);
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            Color mean{0, 0, 0};
            for (int part = 0; part < fine * fine; ++part) {
                const haptel_sample& sample = samples.at(column * fine + part % fine, row * fine + part / fine);
                const Color c = lit({-factor * sample.gradient[0], -factor * sample.gradient[1], 1});
                mean.red += c.red / (fine * fine), mean.green += c.green / (fine * fine);
                mean.blue += c.blue / (fine * fine);
            }
            image.at(column, row) = mean;
        }
    return image;
}

Picture draw_shaded(const TextureView& view)
{
    Picture picture = new_picture(view);
    constexpr double side = 400;
    const Rect rect{60, 58, side, side};
    const int n = pixels(picture, side);
    const Grid samples(view, n * samples_per_pixel, n * samples_per_pixel);
    const double factor = exaggeration_for(samples.slope.rms());
    picture.image(rect, relief_of(samples, n, factor));
    draw_axes(picture, window_axes(view, rect));
    const std::string relief = factor == 1 ? "relief to scale" : fmt::format("relief {:g} times as steep", factor);
    draw_title(picture, view.title, relief + "   " + statistics(samples.height, samples.slope));
    return picture;
}

Picture draw_relief(const TextureView& view)
{
    Picture picture = new_picture(view);
    const Grid samples(view, view.size_px * samples_per_pixel, view.size_px * samples_per_pixel);
    picture.image({0, 0, page, page}, relief_of(samples, view.size_px, exaggeration_for(samples.slope.rms())));
    return picture;
}

Picture draw_section(const TextureView& view)
{
    Picture picture = new_picture(view);
    constexpr int count = 4000;
    std::vector<double> x_m, height_m, slope;
    std::vector<glm::dvec3> points_m;
    for (int i = 0; i <= count; ++i) {
        const double offset_m = (static_cast<double>(i) / count - 0.5) * view.window_m;
        points_m.push_back(view.center_m + glm::dvec3(offset_m, 0, 0));
        x_m.push_back(view.center_m.x + offset_m);
    }
    Range heights, slopes;
    for (const haptel_sample& sample : samples_at(view, points_m)) {
        height_m.push_back(sample.height_m);
        slope.push_back(sample.gradient[0]);
        heights.add(sample.height_m);
        slopes.add(sample.gradient[0]);
    }
    const LengthUnit unit = length_unit(std::max(std::abs(heights.low), std::abs(heights.high)));
    const Axes window = window_axes(view, {});
    const LengthUnit along = length_unit(view.window_m);
    const Axes upper{
        {66, 58, 424, 196},
        window.x,
        fitted(fmt::format("height ({})", unit.name), heights.low * unit.per_m, heights.high * unit.per_m)};
    const Axes lower{{66, 270, 424, 196}, window.x, fitted("slope dh/dx", slopes.low, slopes.high)};

    const auto draw = [&](const Axes& axes, const std::vector<double>& values, double per_unit, const Color& color,
                          bool x_labels) {
        AxesStyle style;
        style.x_labels = x_labels;
        draw_grid(picture, axes, style);
        std::vector<Point> points;
        for (std::size_t i = 0; i < values.size(); ++i)
            points.push_back(axes.at(x_m[i] * along.per_m, values[i] * per_unit));
        picture.begin_clip(axes.rect);
        picture.polyline(points, color, 1.2);
        picture.end_clip();
        draw_axes(picture, axes, style);
    };
    draw(upper, height_m, unit.per_m, accent, false);
    draw(lower, slope, 1, accent_2, true);
    draw_title(picture, view.title,
               fmt::format("section at y = {:.4g} {}   {}", view.center_m.y * along.per_m, along.name,
                           statistics(heights, slopes)));
    return picture;
}

Picture draw_spectrum(const TextureView& view)
{
    constexpr std::size_t length = 2048;
    constexpr int lines = 64;
    const auto along = [&](int axis) {
        std::vector<std::vector<double>> heights_m;
        for (int line = 0; line < lines; ++line) {
            std::vector<double>& heights = heights_m.emplace_back();
            std::vector<glm::dvec3> points(length, view.center_m);
            for (std::size_t i = 0; i < length; ++i) {
                points[i][axis] += (static_cast<double>(i) / length - 0.5) * view.window_m;
                points[i][1 - axis] += ((line + 0.5) / lines - 0.5) * view.window_m;
            }
            for (const haptel_sample& sample : samples_at(view, points)) heights.push_back(sample.height_m);
        }
        return spectrum_of(heights_m, view.window_m);
    };
    const Spectrum spectra[] = {along(0), along(1)};
    const double low_per_m = spectra[0].frequency_per_m.front(), high_per_m = spectra[0].frequency_per_m.back();

    double largest_m = 0;
    for (const Spectrum& spectrum : spectra)
        largest_m = std::max(largest_m, *std::max_element(spectrum.amplitude_m.begin(), spectrum.amplitude_m.end()));
    if (!(largest_m > 0)) largest_m = 1e-6;
    const double top_um = std::pow(10, std::ceil(std::log10(largest_m * 1e6)));

    Picture picture = new_picture(view);
    const Axes axes{{66, 74, 424, 380},
                    {"spatial frequency (1/mm)", low_per_m / 1e3, high_per_m / 1e3, true},
                    {"amplitude (µm)", top_um * 1e-7, top_um, true}};
    draw_grid(picture, axes);
    picture.begin_clip(axes.rect);
    const Color colors[] = {accent, accent_2};
    for (int i = 1; i >= 0; --i) {
        std::vector<Point> points;
        for (std::size_t k = 0; k < spectra[i].amplitude_m.size(); ++k)
            points.push_back(
                axes.at(spectra[i].frequency_per_m[k] / 1e3, std::max(spectra[i].amplitude_m[k] * 1e6, top_um * 1e-9)));
        picture.polyline(points, colors[i], 1.1);
    }
    picture.end_clip();
    draw_axes(picture, axes);
    // The same axis as wavelengths, on top.
    const Axis wavelength{"", 1e3 / high_per_m, 1e3 / low_per_m, true};
    for (const Tick& tick : ticks(wavelength, 6)) {
        const double x = axes.at(1 / tick.value, axes.y.low).x;
        picture.line({x, axes.rect.y}, {x, axes.rect.y - (tick.text.empty() ? 2 : 3.5)}, quiet, 0.8);
        picture.text({x, axes.rect.y - 6}, tick.text, {8, quiet, Align::center});
    }
    picture.text({axes.rect.right(), axes.rect.y - 18}, "wavelength (mm)", {8, quiet, Align::right});
    picture.line({axes.rect.right() - 96, axes.rect.y + 14}, {axes.rect.right() - 80, axes.rect.y + 14}, accent, 1.6);
    picture.text({axes.rect.right() - 74, axes.rect.y + 17}, "along x", {8.5});
    picture.line({axes.rect.right() - 96, axes.rect.y + 28}, {axes.rect.right() - 80, axes.rect.y + 28}, accent_2, 1.6);
    picture.text({axes.rect.right() - 74, axes.rect.y + 31}, "along y", {8.5});
    draw_title(picture, view.title,
               fmt::format("spectrum   {} lines of {} each way, Hann window, zero-to-peak amplitudes", lines,
                           length_text(view.window_m)));
    return picture;
}

Picture draw_gradient_error(const TextureView& view)
{
    Picture picture = new_picture(view);
    constexpr int n = 96; // the oracle is slow
    std::vector<double> errors;
    double largest_gradient = 0;
    const Grid samples(view, n, n);
    Progress progress;
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            const glm::dvec3 expected = view.true_gradient(samples.point(column, row));
            const double* gradient = samples.at(column, row).gradient;
            errors.push_back(glm::distance(glm::dvec3(gradient[0], gradient[1], gradient[2]), expected));
            largest_gradient = std::max(largest_gradient, glm::length(expected));
            progress.show(static_cast<double>(errors.size()) / (n * n));
        }
    Range range;
    Image image(n, n);
    const Axis axis{"log₁₀ of relative error", -18, -10};
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const double relative = largest_gradient > 0 ? errors[i] / largest_gradient : errors[i];
        range.add(relative);
        image.pixels[i] = magma(axis.share(std::log10(std::max(relative, 1e-300))));
    }
    picture.image(map_rect, image);
    draw_axes(picture, window_axes(view, map_rect));
    draw_color_bar(picture, {map_rect.right() + 10, map_rect.y, 9, map_rect.height}, axis, magma);
    draw_title(
        picture, view.title,
        fmt::format("gradient error against the 113-bit oracle, by the largest gradient   rms {:.1e}, largest {:.1e}",
                    range.rms(), std::max(range.high, 0.0)));
    return picture;
}

constexpr TextureKind kinds[] = {
    {"height", "colours for height", draw_height},
    {"shaded", "relief, lit from the upper left", draw_shaded},
    {"relief", "the same from edge to edge, without axes and words", draw_relief},
    {"ball", "relief of a ball as wide as the window, for textures that read center, extent, n or uv", draw_ball},
    {"section", "height and slope along x", draw_section},
    {"spectrum", "amplitude against wavelength", draw_spectrum},
    {"gradient-error", "error of the compiled gradient against the 113-bit oracle", draw_gradient_error},
};

} // namespace

std::span<const TextureKind> texture_kinds()
{
    return kinds;
}

} // namespace haptel::tools::plot
