#include "tools/plot/plot_texture.h"

#include "tools/output/terminal.h"
#include "tools/plot/plot_axes.h"
#include "tools/plot/plot_body.h"
#include "tools/plot/plot_colors.h"
#include "tools/plot/plot_faults.h"
#include "tools/plot/plot_grid.h"
#include "tools/plot/plot_pixels.h"
#include "tools/plot/plot_section.h"
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

// With its unit. Where the height has no bound, one pole would take all colours: so far from the median as a hand's
// heights reach then (jit/texture/envelope.h), 16 times as far as a quarter of the places are.
struct HeightAxis {
    Axis axis;
    double per_m; // of its unit
};

HeightAxis height_axis(const TextureView& view, const Grid& samples, int n)
{
    Range shown = samples.height;
    double beyond = 0;
    if (!view.is_bounded && shown.count > 0) {
        std::vector<double> heights_m;
        for (int row = 0; row < n; ++row)
            for (int column = 0; column < n; ++column)
                if (const haptel_sample& sample = samples.at(column, row); sample.faults == 0)
                    heights_m.push_back(sample.height_m);
        std::sort(heights_m.begin(), heights_m.end());
        const double median = heights_m[heights_m.size() / 2];
        shown.low = std::max(shown.low, median - 16 * (median - heights_m[heights_m.size() / 4]));
        shown.high = std::min(shown.high, median + 16 * (heights_m[heights_m.size() * 3 / 4] - median));
        for (const double height_m : heights_m) beyond += height_m < shown.low || height_m > shown.high;
        beyond /= static_cast<double>(heights_m.size());
    }
    if (shown.count == 0) shown.low = shown.high = 0;
    if (view.say && beyond > 0)
        view.say(fmt::format("the height has no bound: colours are for {} .. {}, and {:.2g} % of the places are beyond",
                             length_text(shown.low), length_text(shown.high), 100 * beyond));
    const LengthUnit unit = length_unit(std::max(std::abs(shown.low), std::abs(shown.high)));
    Axis axis{fmt::format("height ({})", unit.name), shown.low * unit.per_m, shown.high * unit.per_m};
    if (!(axis.high > axis.low)) axis = fitted(axis.label, axis.low, axis.high);
    return {axis, unit.per_m};
}

// The mean colour of each pixel's samples; hatched where one has a fault.
template <typename ColorOf>
Image averaged_image(const Picture& picture, const Canvas& canvas, int each_way, const ColorOf& color_of)
{
    Image image(canvas.pixels, canvas.pixels);
    for_each_pixel(canvas, each_way, [&](const PixelSamples& pixel) {
        Color mean{0, 0, 0};
        const auto share = 1 / static_cast<double>(pixel.samples.size());
        bool is_faulty = false;
        for (const haptel_sample& sample : pixel.samples) {
            const Color c = color_of(sample);
            mean.red += c.red * share, mean.green += c.green * share, mean.blue += c.blue * share;
            is_faulty = is_faulty || sample.faults != 0;
        }
        image.at(pixel.column, pixel.row) = is_faulty ? hatch(picture, pixel.column, pixel.row) : mean;
    });
    return image;
}

Picture draw_height(const TextureView& view)
{
    Picture picture = new_picture(view);
    const int n = pixels(picture, map_rect.width);
    const Grid samples(view, n, n);
    const auto [axis, per_m] = height_axis(view, samples, n);
    const Canvas canvas = canvas_of(view, n);
    const Fineness fine = fineness(canvas, Shown::height);
    picture.image(map_rect, averaged_image(picture, canvas, fine.each_way, [&](const haptel_sample& sample) {
                      return viridis(axis.share(sample.height_m * per_m));
                  }));
    draw_axes(picture, window_axes(view, map_rect));
    draw_color_bar(picture, {map_rect.right() + 10, map_rect.y, 9, map_rect.height}, axis, viridis);
    draw_title(picture, view.title,
               "height   " + statistics(samples.height, samples.slope) + faults_text(samples.faulty));
    tell_faults(view, samples.faulty, samples.faults);
    tell_fineness(view, canvas, fine, averaged(fine));
    return picture;
}

struct Relief {
    Image image;
    Grid samples;
    double factor; // as steep as it is
};

Relief relief_of(const TextureView& view, const Picture& picture, int n)
{
    Grid samples(view, n * samples_per_pixel, n * samples_per_pixel);
    const double factor = exaggeration_for(samples.slope.rms());
    const Canvas canvas = canvas_of(view, n);
    const Fineness fine = fineness(canvas, Shown::gradient);
    tell_faults(view, samples.faulty, samples.faults);
    tell_fineness(view, canvas, fine, averaged(fine));
    const int each_way = std::max(fine.each_way, samples_per_pixel);
    return {averaged_image(picture, canvas, each_way,
                           [&](const haptel_sample& sample) {
                               return lit({-factor * sample.gradient[0], -factor * sample.gradient[1], 1});
                           }),
            std::move(samples), factor};
}

Picture draw_shaded(const TextureView& view)
{
    Picture picture = new_picture(view);
    constexpr double side = 400;
    const Rect rect{60, 58, side, side};
    const auto [image, samples, factor] = relief_of(view, picture, pixels(picture, side));
    picture.image(rect, image);
    draw_axes(picture, window_axes(view, rect));
    const std::string relief = factor == 1 ? "relief to scale" : fmt::format("relief {:g} times as steep", factor);
    draw_title(picture, view.title,
               relief + "   " + statistics(samples.height, samples.slope) + faults_text(samples.faulty));
    return picture;
}

Picture draw_relief(const TextureView& view)
{
    Picture picture = new_picture(view);
    picture.image({0, 0, page, page}, relief_of(view, picture, view.size_px).image);
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
    const Canvas sampled = canvas_of(view, static_cast<int>(length));
    tell_fineness(view, sampled, fineness(sampled, Shown::height), "they show as longer waves, which are not there",
                  "samples");
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
    {"cylinder", "the same on an upright cylinder as wide and as high as the window", draw_cylinder},
    {"section", "height and slope along x, or along --section or --direction", draw_section},
    {"spectrum", "amplitude against wavelength", draw_spectrum},
    {"gradient-error", "error of the compiled gradient against the 113-bit oracle", draw_gradient_error},
};

} // namespace

std::span<const TextureKind> texture_kinds()
{
    return kinds;
}

} // namespace haptel::tools::plot
