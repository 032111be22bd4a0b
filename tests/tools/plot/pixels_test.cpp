// What a pixel shows, of waves whose length and mean are known.
#include "lang/abi/outputs.h"
#include "tests/support/catch.h"
#include "tools/plot/plot_grid.h"
#include "tools/plot/plot_pixels.h"

#include <cmath>
#include <mutex>
#include <numbers>

using namespace haptel;
using namespace haptel::tools::plot;

namespace {

// height_m sin(2 pi x / length) upon 1 mm, over 20 mm; x is turned by 37 degrees so that both axes see it.
TextureView waves(double length_m, double height_m)
{
    TextureView view;
    view.on_plane = [](const glm::dvec3& p) {
        haptel_point point{};
        for (int i = 0; i < 3; ++i) point.p[i] = p[i];
        return point;
    };
    view.samples = [=](std::span<const haptel_point> points, std::span<haptel_sample> samples) {
        for (size_t i = 0; i < points.size(); ++i) {
            const double k = 2 * std::numbers::pi / length_m, phase = k * (0.8 * points[i].p[0] + 0.6 * points[i].p[1]);
            const double slope = height_m * k * std::cos(phase);
            samples[i] = blank_sample;
            samples[i].height_m = 1e-3 + height_m * std::sin(phase);
            samples[i].gradient[0] = 0.8 * slope;
            samples[i].gradient[1] = 0.6 * slope;
        }
    };
    return view;
}

} // namespace

TEST_CASE("how fine a wave is is measured, and so many samples are taken that four come on each")
{
    for (const double length_um : {2000.0, 300.0, 90.0, 50.0, 30.0}) {
        CAPTURE(length_um);
        const TextureView view = waves(length_um * 1e-6, 1e-9);
        const Canvas canvas = canvas_of(view, 500); // of 40 um
        for (const Shown what : {Shown::height, Shown::gradient}) {
            const Fineness found = fineness(canvas, what);
            // Along x, the steeper axis, it is longer by 1 / 0.8; distances are tried in steps of the square root of 2.
            CHECK(found.feature_m <= length_um * 1e-6 / 0.8 * 1.05);
            CHECK(found.feature_m >= length_um * 1e-6 / 0.8 / std::numbers::sqrt2 * 0.95);
            CHECK(found.each_way >= 4 * 40 / (length_um / 0.8) - 1e-9);
            CHECK(found.each_way <= std::max(1.0, 4 * 40 / (length_um / 0.8) * std::numbers::sqrt2 / 0.95 + 1));
        }
    }
    const TextureView tiny = waves(1e-7, 1e-9);
    CHECK(fineness(canvas_of(tiny, 500), Shown::height).each_way == samples_most);
    const TextureView flat = waves(1e-3, 0);
    CHECK(fineness(canvas_of(flat, 500), Shown::height).each_way == 1);
    CHECK(fineness(canvas_of(flat, 500), Shown::gradient).each_way == 1);
}

TEST_CASE("the mean over a pixel is that of what is in it")
{
    // Some 400 waves to a pixel: one sample each would show anything, the mean is 1 mm.
    const TextureView view = waves(1.0137e-6, 1e-4);
    const Canvas canvas = canvas_of(view, 50);
    const auto largest_error = [&](int each_way) {
        std::mutex mutex;
        double error = 0;
        int met = 0;
        for_each_pixel(canvas, each_way, [&](const PixelSamples& pixel) {
            double mean = 0;
            for (const haptel_sample& sample : pixel.samples)
                mean += sample.height_m / static_cast<double>(pixel.samples.size());
            const std::lock_guard lock(mutex);
            error = std::max(error, std::abs(mean - 1e-3));
            met += static_cast<int>(pixel.samples.size());
        });
        CHECK(met == 50 * 50 * each_way * each_way);
        return error;
    };
    CHECK(largest_error(1) > 0.9e-4);
    // The mean of 256 independent samples of a sine is off by 1 / sqrt(2 * 256) of it, and of 2500 hardly one by 5
    // times.
    CHECK(largest_error(samples_most) < 5 * 1e-4 / std::sqrt(512.0));
}

TEST_CASE("samples stand within their pixel, the first row on top")
{
    const TextureView view = waves(1e-3, 1e-4);
    for (const int each_way : {1, 2, 5})
        for_each_pixel(canvas_of(view, 40), each_way, [&](const PixelSamples& pixel) {
            bool within = pixel.background == 0;
            for (const haptel_point& point : pixel.points) {
                const double x = (point.p[0] / view.window_m + 0.5) * 40, y = (0.5 - point.p[1] / view.window_m) * 40;
                within = within && x >= pixel.column && x <= pixel.column + 1 && y >= pixel.row && y <= pixel.row + 1;
            }
            if (!within) FAIL(pixel.column << " " << pixel.row);
        });
}

TEST_CASE("it is said what is too fine, and with which window it is seen")
{
    std::string said;
    TextureView view = waves(20e-6, 1e-5);
    view.say = [&](const std::string& text) { said = text; };
    const Canvas canvas = canvas_of(view, 500);
    tell_fineness(view, canvas, {20e-6, 8}, averaged({20e-6, 8}));
    // Four pixels to a wave of 20 um are 500 pixels of 5 um, 2.5 mm; of one digit 2 mm.
    CHECK(said == "features of 20 µm are finer than two pixels of 40 µm: 64 samples averaged per pixel; zoom with "
                  "--window 2mm to see them");
    said.clear();
    tell_fineness(view, canvas, {90e-6, 2}, "");
    CHECK(said.empty());
}
