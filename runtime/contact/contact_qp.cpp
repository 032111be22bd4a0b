// The dual of the least squares problem has as many unknowns as there are contacts, and is solved by an active set
// (Lawson and Hanson 1974, Solving Least Squares Problems, 23.3, written for the Gram matrix).
#include "runtime/contact/contact_qp.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

constexpr uint32_t n_max = shaft_contacts_max;
constexpr int steps_max = 32;

// Of a diagonal element: what is left of it below this is no direction of its own. By 1e-5 in angle pushes would be
// that of rounding, over it.
constexpr double independent = 1e-10;

// Of the others' sum that a contact is: a smaller part of one is rounding.
constexpr double least_part = 1e-4;

// Lattice units: violations below it are none.
constexpr double settled = 1e-3;

using Vector = std::array<double, n_max>;
using Matrix = std::array<Vector, n_max>;

// Solves gram x = b for the chosen contacts by Cholesky's decomposition; false: one depends on the others.
bool solve(const Matrix& gram, const Vector& b, const std::array<uint32_t, n_max>& chosen, uint32_t count, Vector& x)
{
    Matrix l{};
    Vector y{};
    for (uint32_t i = 0; i < count; ++i) {
        for (uint32_t j = 0; j <= i; ++j) {
            double sum = gram[chosen[i]][chosen[j]];
            for (uint32_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
            if (i == j && !(sum > independent * gram[chosen[i]][chosen[i]])) return false;
            l[i][j] = i == j ? std::sqrt(sum) : sum / l[j][j];
        }
        double sum = b[chosen[i]];
        for (uint32_t k = 0; k < i; ++k) sum -= l[i][k] * y[k];
        y[i] = sum / l[i][i];
    }
    for (uint32_t i = count; i-- > 0;) {
        double sum = y[i];
        for (uint32_t k = i + 1; k < count; ++k) sum -= l[k][i] * x[chosen[k]];
        x[chosen[i]] = sum / l[i][i];
    }
    return true;
}

// The newest of those chosen is a sum of the others: it pushes in the place of one of which it has a positive part, of
// that which it relieves first. False: there is none, and it contradicts the others.
bool take_place(const Matrix& gram, std::array<uint32_t, n_max>& chosen, uint32_t& count, std::array<bool, n_max>& in,
                Vector& push)
{
    const uint32_t newest = chosen[count - 1], others = count - 1;
    Vector part{};
    if (!solve(gram, gram[newest], chosen, others, part)) return false;
    uint32_t relieved = others;
    double more = HUGE_VAL;
    for (uint32_t i = 0; i < others; ++i) {
        const double share = part[chosen[i]];
        if (!(share > least_part) || push[chosen[i]] >= more * share) continue;
        more = push[chosen[i]] / share;
        relieved = i;
    }
    if (relieved == others) return false;
    for (uint32_t i = 0; i < others; ++i) push[chosen[i]] = std::max(0.0, push[chosen[i]] - more * part[chosen[i]]);
    push[newest] += more;
    push[chosen[relieved]] = 0;
    in[chosen[relieved]] = false;
    for (uint32_t i = relieved + 1; i < count; ++i) chosen[i - 1] = chosen[i];
    --count;
    return true;
}

} // namespace

std::array<double, n_max> solve_multipliers(std::span<const ShaftContact> contacts, const glm::dvec3& tip,
                                            const glm::dvec3& tail, EndsGive gives) noexcept
{
    const uint32_t n = static_cast<uint32_t>(contacts.size() < n_max ? contacts.size() : n_max);
    Matrix gram{};
    Vector b{}, push{};
    for (uint32_t i = 0; i < n; ++i) {
        const ShaftContact& a = contacts[i];
        b[i] = a.offset - glm::dot(a.normal, (1 - a.share) * tip + a.share * tail);
        for (uint32_t j = 0; j <= i; ++j) {
            const ShaftContact& c = contacts[j];
            const double by_tip = gives.tip ? (1 - a.share) * (1 - c.share) : 0;
            const double by_tail = gives.tail ? a.share * c.share : 0;
            gram[i][j] = gram[j][i] = glm::dot(a.normal, c.normal) * (by_tip + by_tail);
        }
    }

    std::array<uint32_t, n_max> chosen{};
    uint32_t count = 0;
    std::array<bool, n_max> in{}, refused{};
    for (int step = 0; step < steps_max; ++step) {
        uint32_t worst = n;
        double by = settled;
        for (uint32_t i = 0; i < n; ++i) {
            if (in[i] || refused[i]) continue;
            double violation = b[i];
            for (uint32_t j = 0; j < n; ++j) violation -= gram[i][j] * push[j];
            if (violation <= by) continue;
            by = violation;
            worst = i;
        }
        if (worst == n) break;
        chosen[count++] = worst;
        in[worst] = true;
        for (;;) {
            Vector x{};
            if (!solve(gram, b, chosen, count, x)) { // the newest depends on the others
                if (take_place(gram, chosen, count, in, push)) continue;
                refused[chosen[count - 1]] = true;
                in[chosen[--count]] = false;
                push[chosen[count]] = 0;
                break;
            }
            uint32_t first_to_go = count;
            double share = 1; // of the way from push to x that keeps all at 0 or above
            for (uint32_t i = 0; i < count; ++i) {
                const double now = push[chosen[i]], then = x[chosen[i]];
                if (then > 0 || now >= share * (now - then)) continue;
                share = now / (now - then);
                first_to_go = i;
            }
            for (uint32_t i = 0; i < count; ++i) push[chosen[i]] += share * (x[chosen[i]] - push[chosen[i]]);
            if (first_to_go == count) break;
            push[chosen[first_to_go]] = 0;
            in[chosen[first_to_go]] = false;
            for (uint32_t i = first_to_go + 1; i < count; ++i) chosen[i - 1] = chosen[i];
            --count;
        }
    }
    return push;
}

// Of both ends together, six coordinates, what the contacts leave free is what is at right angles to all of them.
glm::dmat3 compliance(ShaftEnd end, std::span<const ShaftContact> contacts, std::span<const double> multipliers,
                      EndsGive gives) noexcept
{
    struct Ends {
        glm::dvec3 tip, tail;
        double dot(const Ends& e) const { return glm::dot(tip, e.tip) + glm::dot(tail, e.tail); }
    };
    std::array<Ends, n_max> held;
    uint32_t count = 0;
    glm::dmat3 give(1);
    for (size_t i = 0; i < contacts.size() && i < n_max; ++i) {
        if (!(multipliers[i] > 0)) continue;
        const ShaftContact& contact = contacts[i];
        Ends way{(gives.tip ? 1 - contact.share : 0.0) * contact.normal,
                 (gives.tail ? contact.share : 0.0) * contact.normal};
        const double square = way.dot(way);
        for (int twice = 0; twice < 2; ++twice) // once leaves the rounding of nearly equal ones
            for (uint32_t k = 0; k < count; ++k) {
                const double part = way.dot(held[k]);
                way.tip -= part * held[k].tip;
                way.tail -= part * held[k].tail;
            }
        const double left = way.dot(way);
        if (!(left > independent * square)) continue;
        const double scale = 1 / std::sqrt(left);
        held[count] = {scale * way.tip, scale * way.tail};
        const glm::dvec3& own = end == ShaftEnd::tip ? held[count].tip : held[count].tail;
        give -= glm::outerProduct(own, own);
        ++count;
    }
    return give;
}

} // namespace haptel::runtime
