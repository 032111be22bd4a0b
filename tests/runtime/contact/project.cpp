// The solver of contact against one that tries every set of active rows in 113 bits, and against the conditions of
// Karush, Kuhn and Tucker; and that nothing is wedged between rows that are nearly the same or nearly opposite.
#include "runtime/contact/project.h"

#include "tests/runtime/surface/distance.h"
#include "tests/support/catch.h"

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <vector>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

using Quad = boost::multiprecision::cpp_bin_float_quad;

using Place = std::array<Quad, 6>; // of a point, the last three are 0

struct Row {
    Place direction{};
    Quad offset = 0;
};

Quad dot(const Place& a, const Place& b)
{
    Quad sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
    return sum;
}

Place place(const dvec3& tip, const dvec3& tail = dvec3(0))
{
    return {tip.x, tip.y, tip.z, tail.x, tail.y, tail.z};
}

Row row(const HalfSpace& space)
{
    return {place(space.normal), space.offset};
}

Row row(const ShaftRow& shaft)
{
    Row row{{}, shaft.offset};
    for (int k = 0; k < 3; ++k) {
        row.direction[std::size_t(k)] = (1 - Quad(shaft.arm)) * shaft.normal[k];
        row.direction[std::size_t(k) + 3] = Quad(shaft.arm) * shaft.normal[k];
    }
    return row;
}

double distance(const Place& a, const Place& b)
{
    Place way = a;
    for (std::size_t k = 0; k < way.size(); ++k) way[k] -= b[k];
    return std::sqrt(double(dot(way, way)));
}

// Gauss' elimination with the largest pivot. False: the rows depend on each other.
bool solve(std::vector<std::vector<Quad>>& gram, std::vector<Quad>& b)
{
    const std::size_t n = b.size();
    for (std::size_t i = 0; i < n; ++i) {
        std::size_t pivot = i;
        for (std::size_t k = i + 1; k < n; ++k)
            if (std::abs(double(gram[k][i])) > std::abs(double(gram[pivot][i]))) pivot = k;
        std::swap(gram[i], gram[pivot]);
        std::swap(b[i], b[pivot]);
        if (std::abs(double(gram[i][i])) < 1e-28) return false;
        for (std::size_t k = i + 1; k < n; ++k) {
            const Quad factor = gram[k][i] / gram[i][i];
            for (std::size_t j = i; j < n; ++j) gram[k][j] -= factor * gram[i][j];
            b[k] -= factor * b[i];
        }
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) b[i] -= gram[i][k] * b[k];
        b[i] /= gram[i][i];
    }
    return true;
}

// The nearest place by trial of all sets of rows that may hold it. Nothing: the rows contradict each other.
std::optional<Place> nearest(const std::vector<Row>& rows, const Place& target, Quad tolerance)
{
    for (std::size_t bits = 0; bits < std::size_t(1) << rows.size(); ++bits) {
        std::vector<std::size_t> active;
        for (std::size_t i = 0; i < rows.size(); ++i)
            if (bits >> i & 1) active.push_back(i);
        if (active.size() > target.size()) continue;
        std::vector<std::vector<Quad>> gram(active.size(), std::vector<Quad>(active.size()));
        std::vector<Quad> push(active.size());
        for (std::size_t i = 0; i < active.size(); ++i) {
            push[i] = rows[active[i]].offset - dot(rows[active[i]].direction, target);
            for (std::size_t j = 0; j < active.size(); ++j)
                gram[i][j] = dot(rows[active[i]].direction, rows[active[j]].direction);
        }
        if (!solve(gram, push) || std::ranges::any_of(push, [](Quad p) { return p < 0; })) continue;
        Place at = target;
        for (std::size_t i = 0; i < active.size(); ++i)
            for (std::size_t k = 0; k < at.size(); ++k) at[k] += push[i] * rows[active[i]].direction[k];
        if (std::ranges::all_of(rows, [&](const Row& r) { return dot(r.direction, at) >= r.offset - tolerance; }))
            return at;
    }
    return {};
}

} // namespace

TEST_CASE("project finds the nearest place of a point and of a shaft, as 113 bits find it by trial")
{
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> u(-1, 1);
    const auto any = [&] { return dvec3(u(random), u(random), u(random)); };
    std::array<int, 7> by_count{};
    int contradictory = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        const bool is_shaft = trial % 2 == 1;
        const Shaft target{any(), is_shaft ? any() : dvec3(0)};
        std::vector<HalfSpace> spaces(1 + random() % 7);
        std::vector<ShaftRow> shaft_rows(spaces.size());
        std::vector<Row> rows;
        // Every third time the rows meet in one line, as edges in a vertex: many sets hold the same place.
        const bool at_a_vertex = trial % 3 == 2;
        const dvec3 up = random_direction(random), aside = glm::normalize(glm::cross(up, random_direction(random)));
        for (std::size_t i = 0; i < spaces.size(); ++i) {
            const dvec3 normal = at_a_vertex ? glm::normalize(up + 3 * u(random) * aside) : random_direction(random);
            spaces[i] = {normal, at_a_vertex ? 0.01 : u(random)};
            const double arm = at_a_vertex && i > 0 ? shaft_rows[0].arm : 0.5 * (1 + u(random));
            shaft_rows[i] = {normal, spaces[i].offset, arm};
            if (i > 0 && random() % 8 == 0) spaces[i] = spaces[i - 1], shaft_rows[i] = shaft_rows[i - 1];
            rows.push_back(is_shaft ? row(shaft_rows[i]) : row(spaces[i]));
        }
        const Place from = place(target.tip, target.tail);
        const std::optional<Place> expected = nearest(rows, from, 1e-25);
        contradictory += !expected;
        CAPTURE(trial, is_shaft, rows.size());
        const auto check = [&](const auto& found, const Place& at) {
            if (expected) CHECK(distance(at, *expected) < 1e-9 * (1 + distance(*expected, from)));
            Place pushed = from; // also by rows that contradict each other
            for (std::size_t i = 0; i < found.count; ++i) {
                CHECK(found.push[i] >= 0);
                for (std::size_t k = 0; k < pushed.size(); ++k)
                    pushed[k] += found.push[i] * rows[found.active[i]].direction[k];
            }
            CHECK(distance(pushed, at) < 1e-9 * (1 + distance(at, from)));
            by_count[found.count] += expected.has_value();
        };
        if (is_shaft) {
            const Projection<Shaft> found = project(shaft_rows, target, 1e-14);
            check(found, place(found.at.tip, found.at.tail));
        } else if (expected) {
            dvec3 inside(0);
            for (int k = 0; k < 3; ++k) inside[k] = double((*expected)[std::size_t(k)]);
            const Projection<dvec3> found = project(spaces, target.tip, inside, 1e-13);
            check(found, place(found.at));
        }
    }
    CHECK(contradictory > 20);
    for (const int times : by_count) CHECK(times > 5);
}

TEST_CASE("the place of a point that nearly parallel planes hold meets the conditions that define it")
{
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    int by_count[4] = {};
    for (int trial = 0; trial < 20000; ++trial) {
        // Around the origin, some nearly parallel, some twice.
        std::vector<HalfSpace> spaces;
        const dvec3 common = random_direction(random);
        const double spread = std::pow(10.0, -8 * uniform(random));
        const int count = 1 + static_cast<int>(uniform(random) * 20);
        for (int i = 0; i < count; ++i)
            spaces.push_back({glm::normalize(common + spread * random_direction(random)), -uniform(random) * spread});
        if (uniform(random) < 0.3) spaces.push_back(spaces.front());
        const dvec3 target = 3.0 * uniform(random) * random_direction(random);
        const Projection<dvec3> found = project(spaces, target, dvec3(0), 1e-14);
        dvec3 pushed(0);
        for (std::size_t i = 0; i < found.count; ++i) {
            CHECK(found.push[i] >= 0);
            pushed += found.push[i] * spaces[found.active[i]].normal;
        }
        for (const HalfSpace& space : spaces) CHECK(glm::dot(space.normal, found.at) - space.offset > -1e-12);
        // Karush, Kuhn, Tucker: the way back to the target is a push by the spaces touched alone.
        CHECK(glm::length(found.at - target - pushed) < 1e-6);
        for (std::size_t i = 0; i < found.count; ++i)
            CHECK(glm::dot(spaces[found.active[i]].normal, found.at) - spaces[found.active[i]].offset < 1e-6);
        ++by_count[found.count];
    }
    for (const int times : by_count) CHECK(times > 20);
}

// Places that the hand's shaft may go to are known: the nearest is no farther. Directions that differ by 1e-14 to 1e-7
// make the pushes those of rounding over rounding, unless the solver takes them for the same.
TEST_CASE("rows of a shaft that are nearly the same, or nearly opposite, take it nowhere far")
{
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> u(0, 1);
    const auto any = [&] { return dvec3(normal(random), normal(random), normal(random)); };
    const double scale = 1e9;
    for (int trial = 0; trial < 60'000; ++trial) {
        const double apart = std::pow(10, -7 - 7 * u(random)), arm = u(random);
        const dvec3 a = glm::normalize(any()), b = glm::normalize(any());
        const Shaft allowed{scale * any(), scale * any()};
        EndsGive gives{random() % 8 > 0, true};
        Shaft hand{allowed.tip + scale * u(random) * any(), allowed.tail + scale * u(random) * any()};
        if (!gives.tip) hand.tip = allowed.tip;
        std::vector<ShaftRow> rows(1 + random() % 12);
        for (ShaftRow& row : rows) {
            const uint64_t kind = random() % 3;
            row.normal = glm::normalize((kind == 0 ? a : kind == 1 ? -a : b) + apart * any());
            row.arm = random() % 2 == 0 ? arm : double(random() % 2);
            row.offset = glm::dot(row.normal, allowed.at(row.arm)) - (random() % 2 == 0 ? 0 : scale * u(random));
        }
        const Projection<Shaft> found = project(rows, hand, 1e-3, gives);
        const auto apart_by = [](const Shaft& p, const Shaft& q) {
            return std::hypot(glm::distance(p.tip, q.tip), glm::distance(p.tail, q.tail));
        };
        CAPTURE(trial, apart, rows.size());
        for (std::size_t i = 0; i < found.count; ++i) REQUIRE(found.push[i] >= 0);
        REQUIRE((gives.tip || found.at.tip == hand.tip));
        REQUIRE(apart_by(found.at, hand) < 1.001 * apart_by(allowed, hand));
        for (const ShaftRow& row : rows)
            REQUIRE(glm::dot(row.normal, found.at.at(row.arm)) - row.offset > -1e-4 * scale);
    }
}
