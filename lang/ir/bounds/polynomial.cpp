#include "lang/ir/bounds/polynomial.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace haptel::ir {
namespace {

// How far operations are written out: enough for the noise of four corners, and for the edges of a smoothstep.
constexpr uint32_t steps_max = 18;
constexpr size_t terms_max = 32;

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

// The op of the sine that is on a circle with such a cosine; nothing if it is none.
std::optional<Op> sine_beside(const Instruction* made)
{
    const auto* operation = made ? std::get_if<Operation>(&made->kind) : nullptr;
    if (!operation) return std::nullopt;
    return operation->op == Op::cos       ? std::optional(Op::sin)
           : operation->op == Op::costurn ? std::optional(Op::sinturn)
                                          : std::nullopt;
}

} // namespace

// Of all parts but one alone each is to the power of 1 at most, for range() knows no others.
struct Polynomial::Term {
    Coefficient times;
    uint32_t of; // which parts, a bit each; of one alone: its power
};

// Which values the whole is made of, as more and more of it is written out, the latest first.
class Polynomial::Expansion {
public:
    Expansion(std::span<const Instruction* const> all_makers, Value value) : makers(all_makers), whole(value)
    {
        terms.reserve(steps_max * (terms_max + 3));
    }

    // Writes one more value out; false where there is none left, or too many are met.
    bool step()
    {
        const Value next = written.empty() ? whole : latest();
        if (next.index == none || written.size() == steps_max) return false;
        std::erase_if(met, [&](const Met& one) { return one.value == next; });
        written.push_back(next);
        for (const Value operand : makers[next.index]->operands) {
            if (constant_of(makers[operand.index])) continue;
            const auto before = std::ranges::find(met, operand, &Met::value);
            if (before != met.end())
                ++before->times;
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

    // As it is written out so far; nothing where that is too long, or to a power that range() does not know.
    std::optional<Polynomial> polynomial()
    {
        parts.clear();
        for (const Met& one : met) parts.push_back(one.value);
        const auto on_circle = circle();
        if (on_circle) {
            std::swap(parts[0], parts[on_circle->first]);
            std::ranges::iter_swap(parts.begin() + 1, std::ranges::find(parts, met[on_circle->second].value));
        }
        const std::optional<Terms> all = write_out();
        if (!all) return std::nullopt;
        const std::span<const Term> found = std::span(terms).subspan(all->begin, all->count);
        Polynomial made;
        if (!on_circle || !made.set(parts, found, 2)) {
            made = {}; // a circle among more than there is room for
            if (!made.set(parts, found, 0)) return std::nullopt;
        }
        made.operations = static_cast<uint32_t>(written.size() + found.size() + degree_max);
        return made;
    }

private:
    static constexpr uint32_t none = std::numeric_limits<uint32_t>::max();
    struct Met {
        Value value;
        uint32_t times = 1;
    };
    struct Terms { // of a value, in `terms`
        size_t begin, count;
    };

    // What is written out, operands before what is made of them: the terms of the last, the whole.
    std::optional<Terms> write_out()
    {
        terms.clear();
        known.clear();
        order = written;
        std::ranges::sort(order, {}, &Value::index);
        for (const Value value : order) {
            const Instruction& maker = *makers[value.index];
            const Op op = std::get<Operation>(maker.kind).op;
            const Terms first = terms_of(maker.operands[0]), second = terms_of(maker.operands.back());
            const size_t begin = terms.size();
            if (op == Op::mul) {
                if (!multiply(first, second)) return std::nullopt;
            } else if (op == Op::div) {
                const Coefficient by = terms[second.begin].times;
                for (size_t i = 0; i < first.count; ++i) {
                    const auto [times, of] = terms[first.begin + i];
                    terms.push_back({{times.factor / by.factor, scaled(times.magnitude, 1 / by.magnitude)}, of});
                }
            } else {
                if (op != Op::neg) add(begin, first, 1);
                add(begin, second, op == Op::add ? 1 : -1);
            }
            const auto made = std::span(terms).subspan(begin);
            if (made.size() > terms_max || std::ranges::any_of(made, is_lost)) return std::nullopt;
            known.push_back({begin, made.size()});
        }
        return known.back();
    }

    Terms terms_of(Value value)
    {
        if (const auto before = std::ranges::find(order, value); before - order.begin() < std::ssize(known))
            return known[static_cast<size_t>(before - order.begin())];
        const double* constant = constant_of(makers[value.index]);
        const auto part = static_cast<size_t>(std::ranges::find(parts, value) - parts.begin());
        terms.push_back(constant ? Term{{*constant, std::fabs(*constant)}, 0} : Term{{1, 1}, uint32_t{1} << part});
        return {terms.size() - 1, 1};
    }

    // To what is being made, from `begin` on.
    void add(size_t begin, Coefficient times, uint32_t of)
    {
        const auto same = std::ranges::find(terms.begin() + static_cast<ptrdiff_t>(begin), terms.end(), of, &Term::of);
        Coefficient& sum = (same != terms.end() ? *same : terms.emplace_back(Term{{}, of})).times;
        sum.factor += times.factor;
        sum.magnitude += times.magnitude;
    }

    void add(size_t begin, Terms from, double sign)
    {
        for (size_t i = 0; i < from.count; ++i) {
            const auto [times, of] = terms[from.begin + i];
            add(begin, {sign * times.factor, times.magnitude}, of);
        }
    }

    // Behind all terms; false where there are too many of them, or powers that range() does not know.
    bool multiply(Terms a, Terms b)
    {
        const bool is_of_one = parts.size() == 1;
        const size_t begin = terms.size();
        for (size_t i = 0; i < a.count; ++i)
            for (size_t k = 0; k < b.count; ++k) {
                const Term left = terms[a.begin + i], right = terms[b.begin + k];
                const uint32_t of = is_of_one ? left.of + right.of : left.of | right.of;
                if (is_of_one ? of > degree_max : (left.of & right.of) != 0) return false;
                add(begin,
                    {right.times.factor * left.times.factor, scaled(right.times.magnitude, left.times.magnitude)}, of);
                if (terms.size() > begin + terms_max) return false;
            }
        return true;
    }

    // Infinite where it is so small that what it was made of may have been lost, or too large.
    static double scaled(double magnitude, double by)
    {
        const double product = magnitude * by;
        return magnitude > 0 && by > 0 && product < least_magnitude ? infinity : product;
    }
    static bool is_lost(const Term& term) { return !std::isfinite(term.times.magnitude); }

    // Where in `met` a cosine is, and its sine.
    std::optional<std::pair<size_t, size_t>> circle() const
    {
        for (size_t i = 0; i < met.size(); ++i) {
            const Instruction* cosine = makers[met[i].value.index];
            const std::optional<Op> wanted = sine_beside(cosine);
            for (size_t j = 0; wanted && j < met.size(); ++j) {
                const Instruction* sine = makers[met[j].value.index];
                const auto* operation = sine ? std::get_if<Operation>(&sine->kind) : nullptr;
                if (operation && operation->op == *wanted && sine->operands[0] == cosine->operands[0])
                    return std::pair{i, j};
            }
        }
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
    // Of the latest polynomial; kept for the next one, as many are made and few are the last.
    std::vector<Value> parts, order;
    std::vector<Term> terms;
    std::vector<Terms> known; // by `order`
};

// Takes the terms, where range() knows how: of powers of one part, or of products of different ones. The first
// `of_circle` (two, or none) of all are a cosine and its sine.
bool Polynomial::set(std::span<const Value> all, std::span<const Term> terms, size_t of_circle)
{
    const auto is_squared = [](const Term& term) { return term.of > 1; };
    if (all.size() == 1 && std::ranges::any_of(terms, is_squared)) {
        is_of_powers = true;
        parts = {all[0]};
        for (const Term& term : terms) {
            coefficients.resize(std::max<size_t>(coefficients.size(), term.of + 1));
            coefficients[term.of] = term.times;
        }
        return true;
    }
    std::array<uint32_t, parts_max> bit{}; // of those that multiply others, or are of the circle
    const auto take = [&](size_t part) {
        if (bit[part] == 0) bit[part] = uint32_t{1} << parts.size(), parts.push_back(all[part]);
    };
    const auto for_each_part = [](uint32_t of, const auto& look) {
        for (; of != 0; of &= of - 1) look(static_cast<size_t>(std::countr_zero(of)));
    };
    has_circle = of_circle > 0;
    for (size_t i = 0; i < of_circle; ++i) take(i);
    for (const Term& term : terms)
        if (!std::has_single_bit(term.of)) for_each_part(term.of, take);
    if (parts.size() > corners_max) return false;
    coefficients.resize(size_t{1} << parts.size());
    for (const Term& term : terms) {
        uint32_t product = 0;
        for_each_part(term.of, [&](size_t part) { product |= bit[part]; });
        if (term.of != 0 && product == 0)
            alone.push_back({all[static_cast<size_t>(std::countr_zero(term.of))], term.times});
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
        const uint32_t shared = expansion.shared();
        if (shared <= most_shared) continue;
        std::optional<Polynomial> made = expansion.polynomial();
        if (!made) continue;
        most_shared = shared;
        best = std::move(made);
    }
    return best;
}

} // namespace haptel::ir
