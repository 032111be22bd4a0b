#include "tests/support/catch.h"
#include "tools/plot/plot_axes.h"

#include <cmath>

using namespace haptel::tools::plot;

namespace {

std::vector<std::string> texts(const Axis& axis, int wanted)
{
    std::vector<std::string> result;
    for (const Tick& tick : ticks(axis, wanted))
        if (!tick.text.empty()) result.push_back(tick.text);
    return result;
}

} // namespace

TEST_CASE("ticks stand at round numbers within the axis, with as many decimals as their step needs")
{
    using Texts = std::vector<std::string>;
    CHECK(texts({"", -10, 10}, 5) == Texts{"−10", "−5", "0", "5", "10"});
    CHECK(texts({"", 0, 0.3}, 3) == Texts{"0.0", "0.1", "0.2", "0.3"});
    CHECK(texts({"", 0.021, 0.049}, 3) == Texts{"0.03", "0.04"});
    CHECK(texts({"", 0, 250}, 5) == Texts{"0", "50", "100", "150", "200", "250"});
    CHECK(texts({"", 0.05, 50, true}, 6) == Texts{"0.1", "1", "10"});
    CHECK(texts({"", 1e-5, 100, true}, 8) == Texts{"10⁻⁵", "10⁻⁴", "10⁻³", "0.01", "0.1", "1", "10", "100"});
    for (const Tick& tick : ticks({"", -7, 13}, 6)) CHECK((tick.value >= -7 && tick.value <= 13));
}

TEST_CASE("a fitted axis holds its data and has a length, also where the data have none")
{
    for (const auto& [low, high] : {std::pair{0.0, 0.97},
                                    {-0.31, 0.29},
                                    {5.0, 5.0},
                                    {0.0, 0.0},
                                    {-3e-7, 1e9},
                                    {1.0, 0.0},
                                    {7.0, std::nextafter(7.0, 8.0)}}) {
        const Axis axis = fitted("x", low, high);
        CAPTURE(low, high, axis.low, axis.high);
        CHECK(axis.high > axis.low);
        CHECK(ticks(axis, 5).size() < 20);
        if (high >= low) {
            CHECK(axis.low <= low + 1e-5 * (axis.high - axis.low));
            CHECK(axis.high >= high - 1e-5 * (axis.high - axis.low));
        }
        CHECK(ticks(axis, 5).size() >= 2);
        CHECK(ticks(axis, 5).size() <= 12);
    }
}

TEST_CASE("places follow the axes: linear, logarithmic, y upwards")
{
    const Axes axes{{100, 50, 200, 80}, {"", -1, 1}, {"", 1, 100, true}};
    CHECK(std::abs(axes.at(0, 10).x - 200) < 1e-9);
    CHECK(std::abs(axes.at(0, 10).y - 90) < 1e-9);
    CHECK(std::abs(axes.at(1, 100).x - 300) < 1e-9);
    CHECK(std::abs(axes.at(1, 100).y - 50) < 1e-9);
    CHECK(std::isfinite(axes.at(0, 0).y)); // nothing is logarithmically far, but not infinitely
}

TEST_CASE("lengths are given in the unit in which they read best")
{
    CHECK(length_unit(0.02).name == "mm");
    CHECK(length_unit(-60e-6).name == "µm");
    CHECK(length_unit(2e-9).name == "nm");
    CHECK(length_unit(3).name == "m");
    CHECK(length_unit(0).name == "µm");
    CHECK(length_unit(0.02).per_m == 1e3);
}
