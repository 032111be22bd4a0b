#include "tests/support/catch.h"
#include "tests/tools/commands/png.h"
#include "tools/plot/plot_run.h"
#include "tools/plot/plot_texture.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <unistd.h>

using namespace haptel::tools::plot;
using haptel::test::png_size;

namespace {

struct PictureFile {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("haptel-picture-test-" + std::to_string(getpid()) + ".png");
    ~PictureFile() { std::filesystem::remove(path); }
};

haptel_sample ripple(const glm::dvec3& p)
{
    haptel_sample sample{};
    sample.height_m = 40e-6 * std::sin(3000 * p.x);
    sample.gradient[0] = 0.12 * std::cos(3000 * p.x);
    return sample;
}

haptel_sample flat(const glm::dvec3&)
{
    return {};
}

haptel_sample wild(const glm::dvec3& p)
{
    haptel_sample sample{};
    sample.height_m = p.x > 0 ? 1e30 : -1e-30;
    sample.gradient[1] = 1e300;
    return sample;
}

} // namespace

TEST_CASE("every kind of picture has the size asked for, whatever the texture")
{
    const PictureFile file;
    for (const TextureKind& kind : texture_kinds())
        for (haptel_sample (*sample)(const glm::dvec3&) : {ripple, flat, wild})
            for (const int size : {64, 300}) {
                CAPTURE(kind.name, size);
                TextureView view;
                view.title = "test";
                view.on_plane = [](const glm::dvec3& p_m) {
                    return haptel_point{{p_m.x, p_m.y, p_m.z}, {}, {}, 0, {}, {}, {}, 0, 0, {}, {}, 0};
                };
                view.samples = [&](std::span<const haptel_point> points, std::span<haptel_sample> samples) {
                    std::transform(points.begin(), points.end(), samples.begin(), [&](const haptel_point& point) {
                        return sample({point.p[0], point.p[1], point.p[2]});
                    });
                };
                view.true_gradient = [](const glm::dvec3&) { return glm::dvec3(0); };
                view.size_px = size;
                CHECK(kind.draw(view).write_png(file.path.string()).empty());
                CHECK(png_size(file.path) == std::pair<uint32_t, uint32_t>(size, size));
            }
}

TEST_CASE("a picture that cannot be written says so and names the file")
{
    Picture picture(10, 10, 1);
    CHECK(picture.write_png("/no/such/folder/x.png").find("/no/such/folder/x.png") != std::string::npos);
}

TEST_CASE("runs are drawn whatever they hold")
{
    const PictureFile file;
    std::vector<haptel::runtime::TickRecord> ticks;
    haptel::runtime::Histogram histogram;
    const auto draw_all = [&] {
        const auto surface = [](double x, double) { return x > 0 ? std::optional(glm::dvec3(0, 0, 1)) : std::nullopt; };
        CHECK(draw_force(ticks, "run", 7).write_png(file.path.string()).empty());
        CHECK(draw_path(ticks, "run", surface).write_png(file.path.string()).empty());
        CHECK(draw_path(ticks, "run", nullptr).write_png(file.path.string()).empty());
        CHECK(draw_tick_histogram(histogram, "run", 1e-3).write_png(file.path.string()).empty());
    };
    draw_all(); // nothing
    for (int i = 0; i < 5000; ++i) {
        haptel::runtime::TickRecord tick;
        tick.tick = i;
        tick.time_s = i * 1e-3;
        tick.tip_m = {0.01 * std::cos(i * 1e-2), 0.01 * std::sin(i * 1e-2), 0};
        tick.contact = i % 1000 > 300;
        tick.force_n = {0, 0, tick.contact ? 1.0 : 0.0};
        ticks.push_back(tick);
        histogram.add(static_cast<uint64_t>(i) * 37 % 9000);
        if (i == 0) draw_all(); // one tick
    }
    histogram.add(std::numeric_limits<uint64_t>::max());
    draw_all();
}
