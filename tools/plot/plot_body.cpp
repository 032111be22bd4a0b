#include "tools/plot/plot_body.h"

#include "tools/plot/plot_faults.h"
#include "tools/plot/plot_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace haptel::tools::plot {

namespace {

constexpr double pi = std::numbers::pi;

using ToEye = glm::dvec3 (*)(const glm::dvec3&); // of a direction: x to the right, y up, z toward who looks

glm::dvec3 normal_of(const haptel_point& point)
{
    return {point.n[0], point.n[1], point.n[2]};
}

// Along the surface.
glm::dvec3 slope_on(const haptel_point& point, const haptel_sample& sample)
{
    const glm::dvec3 gradient(sample.gradient[0], sample.gradient[1], sample.gradient[2]), normal = normal_of(point);
    return gradient - glm::dot(gradient, normal) * normal;
}

struct Measured {
    Range slope;
    double samples = 0, faulty = 0;
    uint32_t faults = 0;
};

Measured measured(const Canvas& canvas)
{
    std::vector<Measured> rows(static_cast<std::size_t>(canvas.pixels));
    for_each_pixel(canvas, 1, [&](const PixelSamples& pixel) {
        Measured& row = rows[static_cast<std::size_t>(pixel.row)];
        for (std::size_t i = 0; i < pixel.samples.size(); ++i) {
            ++row.samples;
            row.faulty += pixel.samples[i].faults != 0, row.faults |= pixel.samples[i].faults;
            if (pixel.samples[i].faults == 0) row.slope.add(glm::length(slope_on(pixel.points[i], pixel.samples[i])));
        }
    });
    Measured all;
    for (const Measured& row : rows) {
        all.slope.squares += row.slope.squares, all.slope.count += row.slope.count;
        all.samples += row.samples, all.faulty += row.faulty, all.faults |= row.faults;
    }
    return all;
}

Picture draw_body(const TextureView& view, Body& body, ToEye to_eye)
{
    constexpr double page = 512, margin = 1.04; // of the radius
    Picture picture(page, page, view.size_px / page);
    const double radius_m = view.window_m / 2;
    const Canvas canvas{margin * view.window_m, view.size_px,
                        [&](const glm::dvec2& at_m) { return body(view.center_m, radius_m, at_m / radius_m); },
                        view.samples};
    const Measured all = measured(canvas);
    const double factor = exaggeration_for(all.slope.rms());
    const Fineness fine = fineness(canvas, Shown::gradient);
    tell_fineness(view, canvas, fine, averaged(fine));
    tell_faults(view, all.samples > 0 ? all.faulty / all.samples : 0, all.faults);

    Image image(canvas.pixels, canvas.pixels);
    for_each_pixel(canvas, std::max(fine.each_way, samples_per_pixel), [&](const PixelSamples& pixel) {
        const auto background = static_cast<double>(pixel.background);
        Color sum{background, background, background}; // white
        bool is_faulty = false;
        for (std::size_t i = 0; i < pixel.samples.size(); ++i) {
            const haptel_point& point = pixel.points[i];
            const Color c = lit(to_eye(normal_of(point) - factor * slope_on(point, pixel.samples[i])));
            sum.red += c.red, sum.green += c.green, sum.blue += c.blue;
            is_faulty = is_faulty || pixel.samples[i].faults != 0;
        }
        const double count = background + static_cast<double>(pixel.samples.size());
        image.at(pixel.column, pixel.row) = is_faulty ? hatch(picture, pixel.column, pixel.row)
                                                      : Color{sum.red / count, sum.green / count, sum.blue / count};
    });
    picture.image({0, 0, page, page}, image);
    return picture;
}

} // namespace

std::optional<haptel_point> on_ball(const glm::dvec3& center_m, double radius_m, const glm::dvec2& at)
{
    const double rest = 1 - glm::dot(at, at);
    if (rest <= 0) return std::nullopt;
    const glm::dvec3 n(at, std::sqrt(rest));
    haptel_point point{};
    for (int i = 0; i < 3; ++i) {
        point.p[i] = center_m[i] + radius_m * n[i];
        point.n[i] = n[i];
        for (int k = 0; k < 3; ++k) point.n_dp[i][k] = ((i == k ? 1 : 0) - n[i] * n[k]) / radius_m;
    }
    const double across = std::max(std::hypot(n.x, n.y), 1e-9); // the poles have no longitude
    point.uv[0] = std::atan2(n.y, n.x) / (2 * pi) + 0.5;
    point.uv[1] = std::asin(std::clamp(n.z, -1.0, 1.0)) / pi + 0.5;
    const glm::dvec3 east(-n.y / across, n.x / across, 0), north = (glm::dvec3(0, 0, 1) - n.z * n) / across;
    for (int k = 0; k < 3; ++k) {
        point.uv_dp[0][k] = east[k] / (2 * pi * radius_m * across);
        point.uv_dp[1][k] = north[k] / (pi * radius_m);
    }
    return point;
}

std::optional<haptel_point> on_cylinder(const glm::dvec3& center_m, double radius_m, const glm::dvec2& at)
{
    if (std::abs(at.x) >= 1 || std::abs(at.y) >= 1) return std::nullopt;
    const glm::dvec3 n(at.x, -std::sqrt(1 - at.x * at.x), 0);
    haptel_point point{};
    for (int i = 0; i < 3; ++i) {
        point.p[i] = center_m[i] + radius_m * (i < 2 ? n[i] : at.y);
        point.n[i] = n[i];
        for (int k = 0; i < 2 && k < 2; ++k) point.n_dp[i][k] = ((i == k ? 1 : 0) - n[i] * n[k]) / radius_m;
    }
    point.uv[0] = std::atan2(n.y, n.x) / (2 * pi) + 0.5;
    point.uv[1] = (at.y + 1) / 2;
    point.uv_dp[0][0] = -n.y / (2 * pi * radius_m);
    point.uv_dp[0][1] = n.x / (2 * pi * radius_m);
    point.uv_dp[1][2] = 1 / (2 * radius_m);
    return point;
}

Picture draw_ball(const TextureView& view)
{
    return draw_body(view, on_ball, [](const glm::dvec3& n) { return n; });
}

Picture draw_cylinder(const TextureView& view)
{
    return draw_body(view, on_cylinder, [](const glm::dvec3& n) { return glm::dvec3(n.x, n.z, -n.y); });
}

} // namespace haptel::tools::plot
