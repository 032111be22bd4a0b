// The pushes on a shaft against what makes them optimal, and that they stay bounded where contacts are nearly the same.
#include "runtime/contact/contact_qp.h"

#include "tests/support/catch.h"

#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <vector>

using namespace haptel::runtime;
using glm::dvec3;

namespace {

struct Ends {
    dvec3 tip{0}, tail{0};
};

} // namespace

TEST_CASE("pushes on a shaft are those of the best active set, whatever the contacts")
{
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> u(-1, 1);
    const auto any = [&] { return dvec3(u(random), u(random), u(random)); };
    for (int trial = 0; trial < 2000; ++trial) {
        std::vector<ShaftContact> contacts(1 + random() % shaft_contacts_max);
        const Ends hand{1e9 * any(), 1e9 * any()};
        for (ShaftContact& contact : contacts)
            contact = {glm::normalize(any()), 0.5 * (1 + u(random)), 1e9 * u(random)};
        // Every other time they are edges that meet on the shaft: two of these normals make up for a third.
        const bool at_a_vertex = trial % 2 == 1;
        const dvec3 up = glm::normalize(any()), aside = glm::normalize(glm::cross(up, any()));
        for (ShaftContact& contact : contacts)
            if (at_a_vertex) contact = {glm::normalize(up + 3 * u(random) * aside), contacts[0].share, 128};
        const auto found = solve_multipliers(contacts, hand.tip, hand.tail);
        // Optimal is what solves the conditions of Karush, Kuhn and Tucker: nothing pulls, nothing is violated, and
        // what pushes is tight.
        Ends held = hand;
        for (size_t i = 0; i < contacts.size(); ++i) {
            held.tip += found[i] * (1 - contacts[i].share) * contacts[i].normal;
            held.tail += found[i] * contacts[i].share * contacts[i].normal;
        }
        for (size_t i = 0; i < contacts.size(); ++i) {
            const ShaftContact& contact = contacts[i];
            const double gap =
                glm::dot(contact.normal, (1 - contact.share) * held.tip + contact.share * held.tail) - contact.offset;
            if (found[i] < 0 || gap < -1e-2 || (found[i] > 0 && gap > 1e-2)) {
                CAPTURE(trial, i, contacts.size(), gap, found[i]);
                CHECK(contacts.size() == 6); // six of them may have no common solution,
                CHECK(!at_a_vertex);         // those of one vertex always have
            }
        }
    }
}

// Places that the hand's shaft may go to are known: the nearest is no farther. Directions that differ by 1e-14 to 1e-7
// make the pushes those of rounding over rounding, unless the solver takes them for the same.
TEST_CASE("pushes on a shaft by contacts that are nearly the same, or nearly opposite, take it nowhere far")
{
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> u(0, 1);
    const auto any = [&] { return dvec3(normal(random), normal(random), normal(random)); };
    const double scale = 1e9;
    for (int trial = 0; trial < 60'000; ++trial) {
        const double apart = std::pow(10, -7 - 7 * u(random)), share = u(random);
        const dvec3 a = glm::normalize(any()), b = glm::normalize(any());
        const Ends allowed{scale * any(), scale * any()};
        EndsGive gives{random() % 8 > 0, true};
        Ends hand{allowed.tip + scale * u(random) * any(), allowed.tail + scale * u(random) * any()};
        if (!gives.tip) hand.tip = allowed.tip;
        std::vector<ShaftContact> contacts(1 + random() % shaft_contacts_max);
        for (ShaftContact& contact : contacts) {
            const uint64_t kind = random() % 3;
            contact.normal = glm::normalize((kind == 0 ? a : kind == 1 ? -a : b) + apart * any());
            contact.share = random() % 2 == 0 ? share : double(random() % 2);
            const dvec3 at = (1 - contact.share) * allowed.tip + contact.share * allowed.tail;
            contact.offset = glm::dot(contact.normal, at) - (random() % 2 == 0 ? 0 : scale * u(random));
        }
        const auto found = solve_multipliers(contacts, hand.tip, hand.tail, gives);
        Ends way;
        for (size_t i = 0; i < contacts.size(); ++i) {
            REQUIRE(found[i] >= 0);
            if (gives.tip) way.tip += found[i] * (1 - contacts[i].share) * contacts[i].normal;
            way.tail += found[i] * contacts[i].share * contacts[i].normal;
        }
        const auto length = [](const dvec3& tip, const dvec3& tail) {
            return std::sqrt(glm::dot(tip, tip) + glm::dot(tail, tail));
        };
        CAPTURE(trial, apart, contacts.size());
        const double known = length(allowed.tip - hand.tip, allowed.tail - hand.tail);
        REQUIRE(length(way.tip, way.tail) < 1.001 * known);
        for (const ShaftContact& contact : contacts) {
            const dvec3 tip = hand.tip + way.tip, tail = hand.tail + way.tail;
            const double at = glm::dot(contact.normal, (1 - contact.share) * tip + contact.share * tail);
            REQUIRE(at - contact.offset > -1e-4 * scale);
        }
    }
}
