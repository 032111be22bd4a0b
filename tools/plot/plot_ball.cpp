#include "tools/plot/plot_ball.h"

#include "tools/plot/plot_grid.h"

#include <algorithm>
#include <numbers>

namespace haptel::tools::plot {

namespace {

constexpr double pi = std::numbers::pi;

// Of a ball, where its outward normal is `n`.
haptel_point on_ball(const glm::dvec3& center_m, double radius_m, const glm::dvec3& n)
{
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

} // namespace

Picture draw_ball(const TextureView& view)
{
    constexpr double page = 512, margin = 1.04; // of the radius
    const int n = view.size_px, fine = samples_per_pixel * n;
    struct Seen {
        bool is_ball = false;
        glm::dvec3 normal{0}, slope{0}; // slope: along the ball
    };
    std::vector<Seen> seen(static_cast<std::size_t>(fine) * static_cast<std::size_t>(fine));
    for_each_row(fine, [&](int row) {
        std::vector<haptel_point> points;
        std::vector<Seen*> places;
        for (int column = 0; column < fine; ++column) {
            const glm::dvec2 at = margin * glm::dvec2((2 * column + 1.0) / fine - 1, 1 - (2 * row + 1.0) / fine);
            const double rest = 1 - glm::dot(at, at);
            if (rest <= 0) continue;
            places.push_back(&seen[static_cast<std::size_t>(row) * static_cast<std::size_t>(fine) +
                                   static_cast<std::size_t>(column)]);
            *places.back() = {true, {at, std::sqrt(rest)}, {}};
            points.push_back(on_ball(view.center_m, view.window_m / 2, places.back()->normal));
        }
        std::vector<haptel_sample> samples(points.size());
        view.samples(points, samples);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const glm::dvec3 gradient(samples[i].gradient[0], samples[i].gradient[1], samples[i].gradient[2]);
            places[i]->slope = gradient - glm::dot(gradient, places[i]->normal) * places[i]->normal;
        }
    });
    Range slope;
    for (const Seen& one : seen)
        if (one.is_ball) slope.add(glm::length(one.slope));
    const double factor = exaggeration_for(slope.rms());

    Image image(n, n);
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            Color mean{0, 0, 0};
            for (int part = 0; part < samples_per_pixel * samples_per_pixel; ++part) {
                const int x = column * samples_per_pixel + part % samples_per_pixel;
                const int y = row * samples_per_pixel + part / samples_per_pixel;
                const Seen& one =
                    seen[static_cast<std::size_t>(y) * static_cast<std::size_t>(fine) + static_cast<std::size_t>(x)];
                const Color c = one.is_ball ? lit(one.normal - factor * one.slope) : Color{1, 1, 1};
                constexpr double share = 1.0 / (samples_per_pixel * samples_per_pixel);
                mean.red += c.red * share, mean.green += c.green * share, mean.blue += c.blue * share;
            }
            image.at(column, row) = mean;
        }
    Picture picture(page, page, view.size_px / page);
    picture.image({0, 0, page, page}, image);
    return picture;
}

} // namespace haptel::tools::plot
