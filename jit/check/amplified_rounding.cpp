#include "jit/check/amplified_rounding.h"

#include "jit/check/all_points.h"
#include "jit/check/check_code.h"
#include "jit/check/entry_inputs.h"
#include "lang/ir/op_info.h"
#include "lang/math/quad.h"

#include <array>
#include <cmath>
#include <set>
#include <unordered_map>
#include <vector>

namespace haptel::jit {

namespace {

using ir::Instruction;
using ir::Op;
using ir::Quad;
using Operations = ir::Interpreter<Quad>::Operations;

std::optional<Op> op_of(const Instruction& made)
{
    const auto* operation = std::get_if<ir::Operation>(&made.kind);
    return operation ? std::optional(operation->op) : std::nullopt;
}

// Those that fold their argument, of the function and of all that it calls.
struct Folding {
    const ir::Module& module;
    std::vector<std::pair<const Instruction*, uint32_t>> found; // and the function that it stands in
    std::set<uint32_t> seen = {};

    void look_at(uint32_t function)
    {
        if (!seen.insert(function).second) return;
        ir::for_each_instruction(module.functions[function].body, [&](const Instruction& made) {
            if (const auto* call = std::get_if<ir::Call>(&made.kind)) look_at(call->function);
            if (const auto op = op_of(made); op && ir::traits(*op).reduces) found.emplace_back(&made, function);
        });
    }
};

// By how much height and gradient are off: shares of the largest.
struct Off {
    double height = 0, gradient = 0;
    double most() const { return greater(height, gradient); }
};

// One thread's 113 bits.
class Rounded {
public:
    Rounded(const CompiledProgram& program, const TextureBinding& binding, const Off& largest)
        : size(largest), texture(program, binding)
    {
        texture.interpreter.watch_decisions(true);
    }

    // Nothing where rounding leads to another piece of the texture: that is an edge, not an error.
    Off off(const haptel_point& point, const Operations& operations)
    {
        const Sample truth = sample(point, nullptr);
        const uint64_t piece = texture.interpreter.decisions();
        const Sample rounded = sample(point, &operations);
        if (texture.interpreter.decisions() != piece) return {};
        const auto off = [&](size_t i) { return static_cast<double>(Quad(rounded[i] - truth[i])); };
        return {relative(std::fabs(off(0)), size.height), relative(std::hypot(off(1), off(2), off(3)), size.gradient)};
    }

private:
    using Sample = std::array<Quad, 4>;
    Sample sample(const haptel_point& point, const Operations* operations)
    {
        texture.interpreter.round_to_f64(operations);
        const auto results = texture.height_gradient(point);
        return {results[0].real, results[1].real, results[2].real, results[3].real};
    }

    const Off size;
    InterpretedTexture<Quad> texture;
};

bool is_wave(Op op)
{
    return op == Op::sin || op == Op::cos;
}

// Finds the sine whose late digits an operation takes, through products and sums with what else there is.
class SineSearch {
public:
    explicit SineSearch(const ir::Function& function)
    {
        ir::for_each_instruction(function.body, [&](const Instruction& made) {
            for (const ir::Value result : made.results) maker[result.index] = &made;
        });
    }

    const Instruction* below(const Instruction& made) const
    {
        for (const ir::Value operand : made.operands) {
            const auto found = maker.find(operand.index);
            if (found == maker.end()) continue;
            const std::optional<Op> op = op_of(*found->second);
            if (op && is_wave(*op)) return found->second;
            if (op && (*op == Op::mul || *op == Op::add || *op == Op::sub || *op == Op::neg || *op == Op::abs))
                if (const Instruction* sine = below(*found->second)) return sine;
        }
        return nullptr;
    }

private:
    std::unordered_map<uint32_t, const Instruction*> maker; // by Value::index
};

// Of a folding operation of the function, the fract() or floor() of a sine that it belongs to; null if there is none.
const Instruction* hash_of_sine(const ir::Function& function, const Instruction& blamed)
{
    const SineSearch search(function);
    const Instruction* hash = nullptr;
    ir::for_each_instruction(function.body, [&](const Instruction& made) {
        const std::optional<Op> op = op_of(made);
        if (hash || !op || !ir::traits(*op).reduces || is_wave(*op)) return;
        const Instruction* sine = search.below(made);
        if (sine && (sine == &blamed || &made == &blamed)) hash = &made;
    });
    return hash;
}

} // namespace

std::optional<AmplifiedRounding> amplified_rounding(const CompiledProgram& program, const TextureBinding& binding,
                                                    const CheckPoints& points, uint32_t count, double largest_height_m,
                                                    double largest_gradient)
{
    Folding folding{program.module(), {}};
    folding.look_at(program.source_of(*program.find(binding.texture->name)).height_gradient);
    Operations all;
    for (const auto& [made, function] : folding.found) all.insert(made);

    const Off largest{largest_height_m, largest_gradient};
    std::vector<Off> offs(count);
    for_all_points(count, [&] {
        return [&, rounded = std::make_shared<Rounded>(program, binding, largest)](uint32_t index) {
            offs[index] = rounded->off(points.random(index), all);
        };
    });
    AmplifiedRounding found;
    uint32_t worst = 0;
    for (uint32_t i = 0; i < count; ++i) {
        found.height = greater(found.height, offs[i].height);
        found.gradient = greater(found.gradient, offs[i].gradient);
        if (offs[i].most() > offs[worst].most()) worst = i;
    }
    if (count == 0 || !(offs[worst].most() > 0)) return std::nullopt;

    Rounded rounded(program, binding, largest);
    double most = -1;
    std::pair<const Instruction*, uint32_t> blamed;
    for (const auto& one : folding.found) {
        const double alone = rounded.off(points.random(worst), {one.first}).most();
        if (alone > most) most = alone, blamed = one;
    }
    const Instruction* hash = hash_of_sine(program.module().functions[blamed.second], *blamed.first);
    found.is_hash_of_sine = hash != nullptr;
    found.span = hash ? hash->span : blamed.first->span;
    return found;
}

} // namespace haptel::jit
