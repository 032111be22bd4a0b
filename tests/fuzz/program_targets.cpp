// Random programs: every engine gives the same, and what is measured lies in the bounds.
#include "jit/check/entry_inputs.h"
#include "jit/engine/engine.h"
#include "lang/compile.h"
#include "lang/ir/bounds/bounds.h"
#include "lang/ir/cost.h"
#include "lang/ir/verify.h"
#include "lang/math/quad.h"
#include "tests/fuzz/random_source.h"
#include "tests/fuzz/target.h"
#include "tests/support/ball.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <random>

namespace haptel::fuzz {
namespace {

using test::Ball;

constexpr double box_half_m = 2; // points lie in a cube of this half side

struct Program {
    std::string source;
    std::shared_ptr<const lang::Program> compiled;
    const ir::Module& module() const { return compiled->module; }
    const ir::Texture& texture() const { return compiled->module.textures.back(); }
    [[noreturn]] void fail(const std::string& what) const { fuzz::fail(what + "\n" + source); }
};

// Of the seed that the bytes are. Nothing where the program is larger than the language allows, or odd and refused.
Program program_of(uint64_t seed)
{
    const bool is_odd = seed % 8 == 3;
    Program program{is_odd ? odd_source(seed) : random_source(seed), nullptr};
    const lang::CompileResult result = lang::compile({"random.haptel", program.source}, {});
    program.compiled = result.program;
    if (result.program) return program;
    bool is_refused = is_odd;
    for (const lang::Diagnostic& said : result.diagnostics.all()) {
        if (said.severity != lang::Severity::error) continue;
        if (said.code == "internal-error") program.fail("internal error: " + said.message);
        is_refused |= said.code == "too-large" || said.code == "too-costly";
    }
    if (!is_refused)
        program.fail("a valid program is refused:\n" + lang::render(result.diagnostics.all(), result.sources, false));
    count(is_odd ? "odd and refused" : "refused as too large");
    return program;
}

uint64_t seed_of(std::string_view bytes)
{
    uint64_t seed = 0;
    std::memcpy(&seed, bytes.data(), std::min(bytes.size(), sizeof seed));
    return seed;
}

haptel_point random_point(std::mt19937_64& random)
{
    std::uniform_real_distribution<double> in_box(-box_half_m, box_half_m), unit(-1, 1);
    haptel_point point{};
    for (double& coordinate : point.p) coordinate = in_box(random);
    for (double& component : point.n) component = unit(random);
    for (double& coordinate : point.uv) coordinate = unit(random);
    for (auto& row : point.n_dp)
        for (double& entry : row) entry = unit(random);
    for (auto& row : point.uv_dp)
        for (double& entry : row) entry = unit(random);
    return point;
}

// The block of a texture at its defaults.
std::vector<double> block_of(const ir::Texture& texture)
{
    std::vector<double> block(texture.block_size / sizeof(double) + 1);
    for (const ir::Parameter& parameter : texture.parameters) {
        char* const place = reinterpret_cast<char*>(block.data()) + parameter.offset;
        const auto word = static_cast<int32_t>(parameter.value);
        if (parameter.type == ir::Type::real)
            std::memcpy(place, &parameter.value, sizeof parameter.value);
        else
            std::memcpy(place, &word, sizeof word);
    }
    return block;
}

template <typename T>
class Engine {
public:
    Engine(const Program& program, const std::vector<double>& block)
        : texture(program.texture()), interpreter(program.module())
    {
        jit::set_block(inputs, texture, block.data());
        interpreter.watch_decisions(true);
    }
    // Height, gradient; `faults` and `decisions` are of the last run.
    std::array<T, 4> run(const haptel_point& point)
    {
        jit::set_point(inputs, point);
        const auto results = interpreter.run(texture.height_gradient, {}, &inputs);
        faults = results[4].bits;
        decisions = interpreter.decisions();
        return {results[0].real, results[1].real, results[2].real, results[3].real};
    }
    // The height where the contact has moved along an axis, the normal and the mesh coordinates with it.
    T height_beside(const haptel_point& point, size_t axis, const T& offset)
    {
        jit::set_point(inputs, point);
        ir::EntryInputs<T> used = inputs;
        const auto move = [&](ir::Input first, size_t i, double by) {
            used.input[static_cast<size_t>(first) + i] += T(by) * offset;
        };
        move(ir::Input::p_x, axis, 1);
        for (size_t i = 0; i < 3; ++i) move(ir::Input::n_x, i, point.n_dp[i][axis]);
        for (size_t i = 0; i < 2; ++i) move(ir::Input::uv_x, i, point.uv_dp[i][axis]);
        const auto results = interpreter.run(texture.height_gradient, {}, &used);
        faults = results[4].bits;
        decisions = interpreter.decisions();
        return results[0].real;
    }
    uint32_t faults = 0;
    uint64_t decisions = 0;

private:
    const ir::Texture& texture;
    ir::Interpreter<T> interpreter;
    ir::EntryInputs<T> inputs;
};

bool same_bits(double a, double b)
{
    return std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b);
}

std::string shown(const char* engine, const std::array<double, 4>& sample)
{
    char text[200];
    std::snprintf(text, sizeof text, "%-12s %.17g gradient %.17g %.17g %.17g\n", engine, sample[0], sample[1],
                  sample[2], sample[3]);
    return text;
}

// The interpreter against the truth: no further away than rounding each operation can lead.
void check_rounding(const Program& program, Engine<double>& interpreter, const std::array<double, 4>& found,
                    Engine<Ball>& truth, const haptel_point& point)
{
    Ball::undecided = false;
    const std::array<Ball, 4> balls = truth.run(point);
    if (truth.decisions != interpreter.decisions || truth.faults != interpreter.faults) {
        if (!Ball::undecided) program.fail("decides otherwise than the oracle where rounding cannot");
        count("points where rounding decides");
        return;
    }
    bool is_useful = true; // the bound
    std::string rows;
    for (size_t i = 0; i < 4; ++i) {
        char row[160];
        std::snprintf(row, sizeof row, "found %.17g, exact %.17g, by rounding +-%.3g\n", found[i],
                      static_cast<double>(balls[i].middle), static_cast<double>(balls[i].radius));
        rows += row;
        is_useful &= balls[i].radius <= 1e-9 * (1 + fabs(balls[i].middle));
    }
    for (size_t i = 0; i < 4; ++i)
        if (!balls[i].may_be(found[i])) program.fail("differs from the oracle beyond rounding:\n" + rows);
    count("compared with the oracle");
    if (is_useful) count("of these to 1e-9");
}

// Points side by side, and what single points gave.
struct Lanes {
    static constexpr size_t reals = jit::point_inputs;
    std::vector<double> inputs[reals];
    std::vector<std::array<double, 4>> expected;

    void add(const haptel_point& point, const std::array<double, 4>& sample)
    {
        double held[reals];
        std::memcpy(held, &point, sizeof point);
        for (size_t i = 0; i < reals; ++i) inputs[i].push_back(held[i]);
        expected.push_back(sample);
    }
    void check(const Program& program, haptel_batch_entry* entry, const void* block)
    {
        const double* arrays[reals];
        for (size_t i = 0; i < reals; ++i) arrays[i] = inputs[i].data();
        haptel_points points;
        std::memcpy(&points, arrays, sizeof points);
        std::vector<double> found[4];
        for (auto& numbers : found) numbers.resize(expected.size());
        haptel_samples samples{};
        samples.height_m = found[0].data();
        for (size_t i = 0; i < 3; ++i) samples.gradient[i] = found[1 + i].data();
        entry(&points, expected.size(), block, &samples);
        for (size_t i = 0; i < expected.size(); ++i)
            for (size_t j = 0; j < 4; ++j)
                if (!same_bits(found[j][i], expected[i][j]))
                    program.fail("lanes differ:\n" + shown("one point", expected[i]) +
                                 shown("lanes", {found[0][i], found[1][i], found[2][i], found[3][i]}));
        count("batches");
    }
};

// The gradient itself, which every engine takes from the same derivative: against central differences of the 113-bit
// height with a Richardson step, where no piece ends between.
void check_gradient(const Program& program, Engine<ir::Quad>& oracle, const haptel_point& point)
{
    const std::array<ir::Quad, 4> truth = oracle.run(point);
    const uint64_t decisions = oracle.decisions;
    if (oracle.faults != 0) return;
    for (size_t axis = 0; axis < 3; ++axis) {
        bool is_smooth = true;
        const auto height = [&](const ir::Quad& offset) {
            const ir::Quad result = oracle.height_beside(point, axis, offset);
            is_smooth = is_smooth && oracle.faults == 0 && oracle.decisions == decisions;
            return result;
        };
        const ir::Quad step = 0x1p-28;
        const ir::Quad coarse = (height(step) - height(-step)) / (2 * step);
        const ir::Quad fine = (height(step / 2) - height(-step / 2)) / step;
        if (!is_smooth) {
            count("differences across a kink");
            continue;
        }
        const auto difference = static_cast<double>((4 * fine - coarse) / 3);
        const auto found = static_cast<double>(truth[1 + axis]);
        const double scale = 1 + std::fabs(found) + std::fabs(static_cast<double>(truth[0]));
        if (!(std::fabs(found - difference) <= 1e-10 * scale))
            program.fail("gradient along axis " + std::to_string(axis) + " is " + std::to_string(found) +
                         ", the difference quotient " + std::to_string(difference));
        count("differences");
    }
}

// What code in mixed and in f32 gives, against the truth: no further away than rounding each operation to f32 can lead.
void check_singles(const Program& program, uint64_t seed, const std::vector<double>& block)
{
    const ir::Texture& texture = program.texture();
    std::vector<jit::EntryPoint> entries;
    std::vector<jit::EntryPoint> heights;
    for (const auto precision : {jit::Precision::mixed, jit::Precision::f32}) {
        entries.push_back({"t" + std::to_string(entries.size()), &texture, jit::EntryPoint::Kind::height_gradient,
                           jit::LaneForm::one, precision});
        heights.push_back(entries.back());
        heights.back().name += " alone";
        heights.back().kind = jit::EntryPoint::Kind::height;
    }
    std::vector<jit::EntryPoint> both = entries;
    both.insert(both.end(), heights.begin(), heights.end());
    const jit::CodeResult made = jit::compile_code(program.module(), both);
    if (!made.code) program.fail("no code in mixed and f32: " + made.error);
    Ball::in_singles = true;
    Engine<Ball> truth(program, block);
    std::mt19937_64 random(seed);
    for (int i = 0; i < 4; ++i) {
        const haptel_point point = random_point(random);
        Ball::undecided = false;
        const std::array<Ball, 4> balls = truth.run(point);
        count(Ball::undecided ? "where rounding to f32 decides" : "compared in f32");
        for (const jit::EntryPoint& entry : entries) {
            haptel_sample sample{}, alone{};
            made.code->entry(entry.name)(&point, block.data(), &sample);
            made.code->entry(entry.name + " alone")(&point, block.data(), &alone);
            if (!same_bits(alone.height_m, sample.height_m)) program.fail("in singles the height alone is another");
            const double found[] = {sample.height_m, sample.gradient[0], sample.gradient[1], sample.gradient[2]};
            for (size_t j = 0; j < 4; ++j) {
                if (!std::isfinite(found[j])) program.fail("an entry in singles returned what is not finite");
                if (Ball::undecided || sample.faults != truth.faults || balls[j].may_be(found[j])) continue;
                char row[200];
                std::snprintf(row, sizeof row, "%s: result %zu is %.9g, exact %.17g, by rounding +-%.3g",
                              entry.name == "t0" ? "mixed" : "f32", j, found[j], static_cast<double>(balls[j].middle),
                              static_cast<double>(balls[j].radius));
                program.fail(row);
            }
            if (!Ball::undecided && sample.faults != truth.faults) program.fail("other faults in singles");
        }
    }
    Ball::in_singles = false;
}

// In every precision, with the iterations of loops in lanes: the height alone is that with the gradient.
void check_iterations(const Program& program, uint64_t seed, const std::vector<double>& block)
{
    const ir::Texture& texture = program.texture();
    const auto precision = static_cast<jit::Precision>(seed / 8 % 3);
    const auto entry = [&](const char* name, jit::EntryPoint::Kind kind) {
        return jit::EntryPoint{name, &texture, kind, jit::LaneForm::iterations, precision};
    };
    const std::vector<jit::EntryPoint> entries = {entry("t", jit::EntryPoint::Kind::height),
                                                  entry("t'", jit::EntryPoint::Kind::height_gradient)};
    const jit::CodeResult made = jit::compile_code(program.module(), entries);
    if (!made.code) program.fail("no code with iterations in lanes: " + made.error);
    std::mt19937_64 random(seed);
    for (int i = 0; i < 4; ++i) {
        const haptel_point point = random_point(random);
        haptel_sample both{}, alone{};
        made.code->entry("t'")(&point, block.data(), &both);
        made.code->entry("t")(&point, block.data(), &alone);
        if (!same_bits(both.height_m, alone.height_m)) program.fail("iterations in lanes: the height alone is another");
        for (double number : {both.height_m, both.gradient[0], both.gradient[1], both.gradient[2]})
            if (!std::isfinite(number)) program.fail("iterations in lanes: an entry returned what is not finite");
    }
    count("iterations in lanes");
}

} // namespace

void run_program(std::string_view bytes)
{
    const uint64_t seed = seed_of(bytes);
    const Program program = program_of(seed);
    if (!program.compiled) return;
    const ir::Texture& texture = program.texture();
    // Code takes most of the time: the entry of the height alone, and full effort, are for some.
    std::vector<jit::EntryPoint> entries{{"t'", &texture, jit::EntryPoint::Kind::height_gradient}};
    if (seed % 8 == 0) entries.push_back({"t", &texture, jit::EntryPoint::Kind::height});
    if (seed % 4 == 0)
        entries.push_back({"t'*", &texture, jit::EntryPoint::Kind::height_gradient, jit::LaneForm::points});
    const jit::CodeResult made =
        jit::compile_code(program.module(), entries, {seed % 32 == 0 ? jit::Effort::full : jit::Effort::quick});
    if (!made.code) program.fail("no code: " + made.error);
    const std::vector<double> block = block_of(texture);
    Engine<double> interpreter(program, block);
    Engine<ir::Quad> oracle(program, block);
    Engine<Ball> truth(program, block);
    Lanes lanes;
    std::mt19937_64 random(seed);
    for (int i = 0; i < 4; ++i) {
        const haptel_point point = random_point(random);
        const std::array<double, 4> slow = interpreter.run(point);
        haptel_sample sample{};
        made.code->entry("t'")(&point, block.data(), &sample);
        const std::array<double, 4> fast = {sample.height_m, sample.gradient[0], sample.gradient[1],
                                            sample.gradient[2]};
        for (size_t j = 0; j < 4; ++j)
            if (!same_bits(fast[j], slow[j]) || sample.faults != interpreter.faults)
                program.fail("code differs:\n" + shown("interpreter", slow) + shown("code", fast));
        lanes.add(point, fast);
        if (haptel_entry* const alone = made.code->entry("t")) {
            haptel_sample height{};
            alone(&point, block.data(), &height);
            if (!same_bits(height.height_m, sample.height_m)) program.fail("the height alone is another");
        }
        for (double number : fast)
            if (!std::isfinite(number)) program.fail("an entry returned what is not finite");
        count("points");
        if (sample.faults != 0) count("faults");
        check_rounding(program, interpreter, slow, truth, point);
        // detach() is for gradients that differ on purpose.
        if (i == 0 && program.source.find("detach(") == std::string::npos) check_gradient(program, oracle, point);
    }
    if (seed % 8 == 2) check_iterations(program, seed, block);
    if (seed % 8 == 6) check_singles(program, seed, block);
    if (haptel_batch_entry* const many = made.code->batch_entry("t'*")) lanes.check(program, many, block.data());
    count("programs");
}

void bound_program(std::string_view bytes)
{
    const uint64_t seed = seed_of(bytes);
    const Program program = program_of(seed);
    if (!program.compiled) return;
    const ir::Texture& texture = program.texture();
    if (ir::operations_max(program.module(), texture.height_gradient) > 20'000) return;
    ir::BoundsBox box;
    const auto set = [&](ir::Input first, size_t how_many, double half) {
        for (size_t i = 0; i < how_many; ++i) box.input[static_cast<size_t>(first) + i] = {-half, half};
    };
    set(ir::Input::p_x, 3, box_half_m);
    set(ir::Input::n_x, 3, 1);
    set(ir::Input::uv_x, 2, 1);
    for (size_t i = static_cast<size_t>(ir::Input::time) + 1; i < jit::point_inputs; ++i) box.input[i] = {-1, 1};
    for (const ir::Parameter& parameter : texture.parameters)
        box.parameters.push_back({parameter.value, parameter.value});
    const ir::TextureBounds bounds = ir::texture_bounds(program.module(), texture, box, 16);
    const bool is_total = ir::undefined_in(program.module(), texture, box, 16).empty();
    Engine<double> interpreter(program, block_of(texture));
    std::mt19937_64 random(seed);
    for (int i = 0; i < 40; ++i) {
        const std::array<double, 4> sample = interpreter.run(random_point(random));
        const double slope = std::hypot(sample[1], sample[2], sample[3]);
        const double slack = 1e-12 * std::fabs(sample[0]);
        if (sample[0] < bounds.height.minimum - slack || sample[0] > bounds.height.maximum + slack)
            program.fail("height " + std::to_string(sample[0]) + " outside of " +
                         std::to_string(bounds.height.minimum) + " .. " + std::to_string(bounds.height.maximum));
        if (slope > bounds.slope_max * (1 + 1e-12))
            program.fail("slope " + std::to_string(slope) + " above " + std::to_string(bounds.slope_max));
        const uint32_t of_height = interpreter.faults & ~uint32_t{HAPTEL_FAULT_OUTPUT_NOT_FINITE};
        if (of_height != 0 && is_total) program.fail("a fault where the bounds exclude one");
        count("points");
    }
    count(std::isfinite(bounds.slope_max) ? "bounded" : "unbounded");
    count(is_total ? "finite for certain" : "may fault");
}

} // namespace haptel::fuzz
