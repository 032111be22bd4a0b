#include "lang/ir/bounds/polynomial.h"

#include "lang/ir/bounds/interval_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptel::ir {
namespace {

// How far operations are written out: enough for the noise of four corners, and for the edges of a smoothstep.
constexpr uint32_t steps_max = 18;
constexpr size_t terms_max = 32;
constexpr double least_magnitude = 1e-250; // of a coefficient: far above where numbers lose their digits

const double* constant_of(const Instruction* made)
{
    const auto* constant = made ? std::get_if<RealConstant>(&made->kind) : nullptr;
    return constant ? &constant->value : nullptr;
}

// What is written out: of the others nothing is known but their intervals.
bool is_written_out(std::span<const Instruction* const> makers, const Instruction* made)
{
    const auto* operation = made ? std::get_if<Operation>(&made->kind) : nullptr;
    if (!operation) return false;
    const Op op = operation->op;
    if (op == Op::add || op == Op::sub || op == Op::mul || op == Op::neg) return true;
    const double* divisor = op == Op::div ? constant_of(makers[made->operands[1].index]) : nullptr;
    return divisor && *divisor != 0;
}

// Whether the two are cosine and sine of one angle.
bool is_circle(const Instruction* a, const Instruction* b)
{
    const auto* cosine = a ? std::get_if<Operation>(&a->kind) : nullptr;
    const auto* sine = b ? std::get_if<Operation>(&b->kind) : nullptr;
    if (!cosine || !sine || a->operands[0] != b->operands[0]) return false;
    return (cosine->op == Op::cos && sine->op == Op::sin) || (cosine->op == Op::costurn && sine->op == Op::sinturn);
}

} // namespace

struct Polynomial::Term {
    Coefficient times;
    std::array<uint8_t, parts_max> powers{}; // by parts

    bool operator==(const Term& other) const { return powers == other.powers; }
};

// Which values the whole is made of, as more and more of it is written out, the latest first.
class Polynomial::Expansion {
    using Terms = std::vector<Term>;

public:
    Expansion(std::span<const Instruction* const> all_makers, Value value) : makers(all_makers), whole(value) {}

    // Writes one more value out; false where there is none left, or too many are met.
    bool step()
    {
        const Value next = written.empty() ? whole : latest();
        if (next.index == none || written.size() == steps_max) return false;
        std::erase_if(met, [&](const Met& one) { return one.value == next; });
        written.push_back(next);
        for (const Value operand : makers[next.index]->operands) {
            if (constant_of(makers[operand.index])) continue;
            const auto known = std::ranges::find(met, operand, &Met::value);
            if (known != met.end())
                ++known->times;
            else
                met.push_back({operand});
        }
        return met.size() <= parts_max;
    }

    // How often parts stand in it beyond once each; a cosine and its sine are two coordinates of one point.
    uint32_t shared() const
    {
        uint32_t more = 0;
        for (const Met& one : met) more += one.times - 1;
        return more + (circle().has_value() ? 1 : 0);
    }

    // As it is written out so far; nothing where that is too long.
    std::optional<Polynomial> polynomial() const
    {
        std::vector<Value> parts;
        for (const Met& one : met) parts.push_back(one.value);
        const auto on_circle = circle();
        if (on_circle) {
            std::swap(parts[0], parts[on_circle->first]);
            std::ranges::iter_swap(parts.begin() + 1, std::ranges::find(parts, met[on_circle->second].value));
        }
        // Operands before what is made of them.
        std::vector<Value> order = written;
        std::ranges::sort(order, {}, &Value::index);
        std::vector<std::pair<Value, Terms>> known;
        const auto terms_of = [&](Value value) -> Terms {
            if (const double* constant = constant_of(makers[value.index]))
                return {Term{{*constant, std::fabs(*constant)}, {}}};
            const auto part = std::ranges::find(parts, value);
            if (part != parts.end()) {
                Term term{{1, 1}, {}};
                term.powers[static_cast<size_t>(part - parts.begin())] = 1;
                return {term};
            }
            return std::ranges::find(known, value, &std::pair<Value, Terms>::first)->second;
        };
        for (const Value value : order) {
            const Instruction& maker = *makers[value.index];
            const Op op = std::get<Operation>(maker.kind).op;
            Terms terms = op == Op::neg ? Terms{} : terms_of(maker.operands[0]);
            const Terms other = terms_of(maker.operands.back());
            if (op == Op::mul)
                terms = product(terms, other);
            else if (op == Op::div)
                for (Term& term : terms) {
                    term.times.factor /= other[0].times.factor;
                    term.times.magnitude = scaled(term.times.magnitude, 1 / other[0].times.magnitude);
                }
            else
                add(terms, other, op == Op::add ? 1 : -1);
            if (terms.size() > terms_max || std::ranges::any_of(terms, is_lost)) return std::nullopt;
            known.emplace_back(value, std::move(terms));
        }
        Polynomial made;
        if (!on_circle || !made.set(parts, known.back().second, 2)) {
            made = {}; // a circle among more than there is room for
            if (!made.set(parts, known.back().second, 0)) return std::nullopt;
        }
        made.operations = static_cast<uint32_t>(written.size() + known.back().second.size() + degree_max);
        return made;
    }

private:
    static constexpr uint32_t none = std::numeric_limits<uint32_t>::max();
    struct Met {
        Value value;
        uint32_t times = 1;
    };

    static void add(Terms& to, const Terms& from, double sign)
    {
        for (const Term& term : from) {
            const auto same = std::ranges::find(to, term);
            Coefficient& sum = (same != to.end() ? *same : to.emplace_back(Term{{}, term.powers})).times;
            sum.factor += sign * term.times.factor;
            sum.magnitude += term.times.magnitude;
        }
    }

    // Infinite where it is so small that what it was made of may have been lost, or too large.
    static double scaled(double magnitude, double by)
    {
        const double product = magnitude * by;
        return magnitude > 0 && by > 0 && product < least_magnitude ? infinity : product;
    }
    static bool is_lost(const Term& term) { return !std::isfinite(term.times.magnitude); }

    static Terms product(const Terms& a, const Terms& b)
    {
        Terms all;
        for (const Term& left : a) {
            Terms line = b;
            for (Term& term : line) {
                term.times.factor *= left.times.factor;
                term.times.magnitude = scaled(term.times.magnitude, left.times.magnitude);
                for (size_t i = 0; i < parts_max; ++i)
                    term.powers[i] = static_cast<uint8_t>(std::min(term.powers[i] + left.powers[i], 255));
            }
            add(all, line, 1);
            if (all.size() > terms_max) break;
        }
        return all;
    }

    // Where in `met` a cosine is, and its sine.
    std::optional<std::pair<size_t, size_t>> circle() const
    {
        for (size_t i = 0; i < met.size(); ++i)
            for (size_t j = 0; j < met.size(); ++j)
                if (is_circle(makers[met[i].value.index], makers[met[j].value.index])) return std::pair{i, j};
        return std::nullopt;
    }

    Value latest() const
    {
        Value found{none};
        for (const Met& one : met)
            if ((found.index == none || one.value.index > found.index) &&
                is_written_out(makers, makers[one.value.index]))
                found = one.value;
        return found;
    }

    std::span<const Instruction* const> makers;
    const Value whole;
    std::vector<Value> written;
    std::vector<Met> met;
};

// Takes the terms, where range() knows how: of powers of one part, or of products of different ones. The first
// `of_circle` (two, or none) of all are a cosine and its sine.
bool Polynomial::set(std::span<const Value> all, std::span<const Term> terms, size_t of_circle)
{
    const auto is_in = [&](const Term& term) {
        std::vector<size_t> in;
        for (size_t i = 0; i < all.size(); ++i)
            if (term.powers[i] > 0) in.push_back(i);
        return in;
    };
    std::array<uint8_t, parts_max> bit{}; // of those that multiply others, from 1 on
    has_circle = of_circle > 0;
    for (size_t i = 0; i < of_circle; ++i) {
        parts.push_back(all[i]);
        bit[i] = static_cast<uint8_t>(parts.size());
    }
    for (const Term& term : terms) {
        const std::vector<size_t> in = is_in(term);
        for (const size_t i : in) {
            is_of_powers |= term.powers[i] > 1;
            if (in.size() < 2 || bit[i] > 0) continue;
            parts.push_back(all[i]);
            bit[i] = static_cast<uint8_t>(parts.size());
        }
    }
    if (is_of_powers) {
        if (all.size() > 1) return false;
        parts = {all[0]};
        for (const Term& term : terms) {
            if (term.powers[0] > degree_max) return false;
            coefficients.resize(std::max<size_t>(coefficients.size(), term.powers[0] + 1u));
            coefficients[term.powers[0]] = term.times;
        }
        return true;
    }
    if (parts.size() > corners_max) return false;
    coefficients.resize(size_t{1} << parts.size());
    for (const Term& term : terms) {
        const std::vector<size_t> in = is_in(term);
        size_t product = 0;
        for (const size_t i : in)
            if (bit[i] > 0) product |= size_t{1} << (bit[i] - 1);
        if (in.size() == 1 && product == 0)
            alone.push_back({all[in[0]], term.times});
        else
            coefficients[product] = term.times;
    }
    return true;
}

std::optional<Polynomial> Polynomial::of(std::span<const Instruction* const> makers, Value whole)
{
    if (!is_written_out(makers, makers[whole.index])) return std::nullopt;
    Expansion expansion(makers, whole);
    std::optional<Polynomial> best;
    uint32_t most_shared = 0;
    while (expansion.step()) {
        if (expansion.shared() <= most_shared) continue;
        std::optional<Polynomial> made = expansion.polynomial();
        if (!made) continue;
        most_shared = expansion.shared();
        best = std::move(made);
    }
    return best;
}

// In the form of Bernstein it lies between its coefficients, of which the first and the last are values of it; of
// halves they are nearer (de Casteljau).
Interval Polynomial::of_one_part(const Interval& at) const
{
    using Numbers = std::array<double, degree_max + 1>;
    Numbers powers{}; // of s, where the part is minimum + width * s
    const size_t degree = coefficients.size() - 1;
    const double width = at.maximum - at.minimum;
    for (size_t power = 0; power <= degree; ++power) {
        double share = coefficients[power].factor; // times the binomial of power and i
        for (size_t i = 0; i <= power; ++i) {
            double scaled = share;
            for (size_t k = 0; k < power; ++k) scaled *= k < i ? width : at.minimum;
            powers[i] += scaled;
            share *= static_cast<double>(power - i) / static_cast<double>(i + 1);
        }
    }
    Numbers bernstein{};
    for (size_t j = 0; j <= degree; ++j) {
        double ratio = 1; // of binomials: j over i, degree over i
        for (size_t i = 0; i <= j; ++i) {
            bernstein[j] += ratio * powers[i];
            ratio *= static_cast<double>(j - i) / static_cast<double>(degree - i);
        }
    }
    Interval found = no_value;
    const auto look = [&](const auto& self, Numbers left, int halvings) -> void {
        const auto [least, most] = std::minmax_element(left.begin(), left.begin() + static_cast<ptrdiff_t>(degree) + 1);
        const double ends[] = {std::min(left[0], left[degree]), std::max(left[0], left[degree])};
        if (halvings == 0 || (*least == ends[0] && *most == ends[1])) {
            found = join(found, {*least, *most});
            return;
        }
        Numbers right{};
        for (size_t k = 0; k <= degree; ++k) {
            right[degree - k] = left[degree];
            for (size_t i = degree; i > k; --i) left[i] = (left[i] + left[i - 1]) / 2;
        }
        self(self, left, halvings - 1);
        self(self, right, halvings - 1);
    };
    look(look, bernstein, 4);
    return found;
}

// Linear in each part, it is least and greatest where each is: at an end. Part by part the coefficients become values
// at both. Of a circle, which is the first and hence the last that is left, c + a cos + b sin + d cos sin is within
// hypot(a, b) + |d| / 2 of c.
Interval Polynomial::of_corners(std::span<const Interval> values) const
{
    std::array<double, size_t{1} << corners_max> corner;
    for (size_t i = 0; i < coefficients.size(); ++i) corner[i] = coefficients[i].factor;
    Interval circle{-infinity, infinity};
    for (size_t k = parts.size(); k-- > 0;) {
        if (k == 1 && has_circle) {
            circle = no_value;
            for (size_t i = 0; i < coefficients.size(); i += 4) {
                const double radius = std::hypot(corner[i + 1], corner[i + 2]) + std::fabs(corner[i + 3]) / 2;
                circle = join(circle, {corner[i] - radius, corner[i] + radius});
            }
        }
        const Interval& at = values[parts[k].index];
        for (size_t i = 0, bit = size_t{1} << k; i < coefficients.size(); ++i) {
            if (i & bit) continue;
            const double with = corner[i | bit], without = corner[i];
            corner[i] = without + with * at.minimum;
            corner[i | bit] = without + with * at.maximum;
        }
    }
    const auto [least, most] = std::minmax_element(corner.begin(), corner.begin() + std::ssize(coefficients));
    Interval all{std::max(*least, circle.minimum), std::min(*most, circle.maximum)};
    for (const auto& [part, times] : alone) {
        const Interval& at = values[part.index];
        const double a = times.factor * at.minimum, b = times.factor * at.maximum;
        all = {all.minimum + std::min(a, b), all.maximum + std::max(a, b)};
    }
    return all;
}

// At least the sum of all that is added up on the way, without signs.
double Polynomial::magnitude(std::span<const Interval> values) const
{
    double sum = 0;
    if (is_of_powers) {
        const Interval& at = values[parts[0].index];
        const double size = std::fabs(at.minimum) + (at.maximum - at.minimum);
        for (size_t i = coefficients.size(); i-- > 0;) sum = sum * size + coefficients[i].magnitude;
        return sum;
    }
    std::array<double, size_t{1} << corners_max> product;
    for (size_t i = 0; i < coefficients.size(); ++i) product[i] = coefficients[i].magnitude;
    for (size_t k = parts.size(); k-- > 0;)
        for (size_t i = 0, bit = size_t{1} << k; i < bit; ++i)
            product[i] += product[i | bit] * size_of(values[parts[k].index]);
    sum = product[0];
    for (const auto& [part, times] : alone) sum += times.magnitude * size_of(values[part.index]);
    return sum;
}

std::optional<Interval> Polynomial::range(std::span<const Interval> values) const
{
    const auto is_finite = [&](Value part) { return values[part.index].is_finite(); };
    if (!std::ranges::all_of(parts, is_finite) || !std::ranges::all_of(alone, is_finite, &Alone::part))
        return std::nullopt;
    // Each operation is off by half a unit in the last place of what is added up, at most; or of the least number, and
    // that may be multiplied by all that there is, and by what makes the least coefficient on the way the one at the
    // end.
    double most = 1;
    for (const Coefficient& times : coefficients) most = std::max(most, times.magnitude);
    for (const Alone& one : alone) most = std::max(most, one.times.magnitude);
    for (const Value part : parts)
        for (size_t i = 0; i < (is_of_powers ? coefficients.size() : 1); ++i)
            most *= std::max(1.0, size_of(values[part.index]));
    using Limits = std::numeric_limits<double>;
    const double lost = Limits::denorm_min() / least_magnitude * most;
    const double slack = 4.0 * operations * (Limits::epsilon() * magnitude(values) + lost);
    if (!std::isfinite(slack)) return std::nullopt;
    const Interval found = is_of_powers ? of_one_part(values[parts[0].index]) : of_corners(values);
    return Interval{found.minimum - slack, found.maximum + slack};
}

} // namespace haptel::ir
