// A shaft that cannot follow its ends: how long it is waited for.
#include "runtime/contact/stylus_contact.h"
#include "runtime/surface/shapes.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/tries.h"

#include <optional>
#include <random>
#include <vector>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

// Hands that jump among spikes and then stay: after how many ticks at rest each shaft is let go, if it is.
std::vector<std::optional<int>> ticks_until_let_go(double rate_hz, int wait_ticks)
{
    Mesh mesh = make_star(3);
    scale_to_size(mesh, 0.1);
    const auto surface = build_surface(mesh).surface;
    std::vector<std::optional<int>> let_go;
    std::mt19937_64 random(9); // of its first sixty hands two have to wait
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto anywhere = [&] { return 0.07 * dvec3(uniform(random), uniform(random), uniform(random)); };
    for (int hand = 0; hand < (is_sanitized ? 60 : 300); ++hand) {
        StylusContact stylus(surface, rate_hz);
        for (int jump = 0; jump < 3; ++jump) {
            const dvec3 tip = anywhere(), tail = tip + 0.1 * glm::normalize(anywhere());
            stylus.update(tip, tail, {});
            if (jump < 2) continue;
            std::optional<int> ticks;
            for (int i = 1; i <= wait_ticks && !ticks && stylus.ideal(); ++i) {
                stylus.update(tip, tail, {});
                if (!stylus.ideal()) ticks = i;
            }
            let_go.push_back(ticks);
        }
    }
    return let_go;
}

} // namespace

TEST_CASE("a shaft that cannot follow is let go after the same time at any rate")
{
    const auto at_1_khz = ticks_until_let_go(1000, 80), at_4_khz = ticks_until_let_go(4000, 320),
               at_250_hz = ticks_until_let_go(250, 20);
    int waited = 0;
    for (std::size_t i = 0; i < at_1_khz.size(); ++i) {
        if (!at_1_khz[i] || !at_4_khz[i] || *at_1_khz[i] < 32) continue; // at once: nothing was waited for
        ++waited;
        const auto waited_for = [](int ticks, double rate_hz) { // it may be on its way for some ticks before
            const double more = ticks - rate_hz * StylusContact::patience_s;
            CHECK(more >= -4);
            CHECK(more <= 16);
        };
        waited_for(*at_1_khz[i], 1000);
        waited_for(*at_4_khz[i], 4000);
        if (at_250_hz[i]) waited_for(*at_250_hz[i], 250);
    }
    CHECK(waited > 0);
}
