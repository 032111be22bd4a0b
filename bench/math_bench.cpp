#include "bench/math_bench.h"

#include "bench/elementary_truth.h"
#include "bench/library_functions.h"
#include "jit/engine/engine.h"
#include "lang/ir/builder.h"
#include "lang/ir/op_info.h"
#include "lang/ir/semantics.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

namespace haptel::bench {
namespace {

using ir::Op;

// Values of a point that a texture may read, and as many calls in one: what is not the function's own counts little.
constexpr size_t calls = 8;
using ir::Input;
constexpr Input inputs[calls] = {Input::p_x, Input::p_y, Input::p_z,  Input::n_x,
                                 Input::n_y, Input::n_z, Input::uv_x, Input::uv_y};
constexpr size_t points_at_once = 512; // they stay in the nearest cache

// A texture that adds up `calls` values of the function.
void add_texture(ir::Module& module, Op op)
{
    const ir::OpInfo& info = ir::op_info(op);
    ir::Builder builder(module, std::string(info.name));
    std::vector<ir::Value> arguments;
    for (const ir::Input input : inputs) arguments.push_back(builder.input(input));
    ir::Value sum{};
    for (size_t i = 0; i < calls; ++i) {
        const ir::Value operands[] = {arguments[i], arguments[(i + 1) % calls]};
        const ir::Value value = builder.operation(op, std::span(operands, info.arity));
        sum = i == 0 ? value : builder.operation(Op::add, {sum, value});
    }
    ir::Texture texture;
    texture.name = info.name;
    texture.block_size = sizeof(haptel_block_head);
    texture.reads = HAPTEL_READS_POINT | HAPTEL_READS_NORMAL | HAPTEL_READS_UV;
    const ir::Value faults = builder.u32(0), results[] = {sum, faults};
    texture.height = builder.finish(results);
    module.textures.push_back(std::move(texture));
}

// Ordinary arguments of a function: where it is defined, not far away, and of a power where it is a number.
std::pair<double, double> usual(Op op)
{
    const ir::Traits& row = ir::traits(op);
    if (row.shape == ir::Shape::power) return {0.1, 5};
    return {std::max(row.from, -20.0), std::min(row.to, 20.0)};
}

// The same numbers as points one by one, and as arrays.
struct Arguments {
    std::vector<haptel_point> points = std::vector<haptel_point>(points_at_once);
    std::vector<std::vector<double>> arrays = std::vector(calls, std::vector<double>(points_at_once));
    std::vector<std::vector<float>> singles = std::vector(calls, std::vector<float>(points_at_once));

    explicit Arguments(Op op)
    {
        std::mt19937_64 random(1);
        const auto [from, to] = usual(op);
        std::uniform_real_distribution<double> between(from, to);
        for (size_t i = 0; i < points_at_once; ++i) {
            double held[calls];
            for (size_t k = 0; k < calls; ++k) {
                held[k] = arrays[k][i] = between(random);
                singles[k][i] = static_cast<float>(held[k]);
            }
            std::memcpy(&points[i], held, sizeof held); // p, n, uv come first
        }
    }
};

class Measured {
public:
    Measured(Op of, const jit::Code& f64, const jit::Code& f32) : op(of), arguments(of), code{&f64, &f32} {}

    void take()
    {
        for (size_t format = 0; format < 2; ++format) {
            alone[format].push_back(per_value([&] { one_by_one(*code[format]); }));
            lanes[format].push_back(per_value([&] { all_at_once(*code[format]); }));
        }
        library[0].push_back(per_value([&] { library_sums(op, arguments.arrays, results.data()); }));
        library[1].push_back(per_value([&] { library_sums(op, arguments.singles, single_results.data()); }));
    }
    void write(MathRow& row) const
    {
        MathFormat* const formats[] = {&row.f64, &row.f32};
        for (size_t format = 0; format < 2; ++format) {
            formats[format]->alone_ns = summary(alone[format]);
            formats[format]->lanes_ns = summary(lanes[format]);
            formats[format]->library_ns = summary(library[format]);
        }
    }

private:
    Op op;
    Arguments arguments;
    const jit::Code* code[2];
    std::vector<double> alone[2], lanes[2], library[2]; // nanoseconds, by format and round
    std::vector<double> results = std::vector<double>(points_at_once);
    std::vector<float> single_results = std::vector<float>(points_at_once);

    static double per_value(const std::function<void()>& work)
    {
        constexpr int times = 8;
        const double whole_ms = milliseconds([&] {
            for (int i = 0; i < times; ++i) work();
        });
        return whole_ms * 1e6 / static_cast<double>(times * points_at_once * calls);
    }
    void one_by_one(const jit::Code& of)
    {
        haptel_entry* const entry = of.entry(std::string(ir::op_info(op).name));
        const double block[sizeof(haptel_block_head) / sizeof(double)] = {};
        for (size_t i = 0; i < points_at_once; ++i) {
            haptel_sample sample;
            entry(&arguments.points[i], block, &sample);
            results[i] = sample.height_m;
        }
    }
    void all_at_once(const jit::Code& of)
    {
        const double block[sizeof(haptel_block_head) / sizeof(double)] = {};
        haptel_points points{};
        for (size_t axis = 0; axis < 3; ++axis) {
            points.p[axis] = arguments.arrays[axis].data();
            points.n[axis] = arguments.arrays[3 + axis].data();
        }
        for (size_t axis = 0; axis < 2; ++axis) points.uv[axis] = arguments.arrays[6 + axis].data();
        haptel_samples samples{};
        samples.height_m = results.data();
        of.batch_entry(std::string(ir::op_info(op).name) + "*")(&points, points_at_once, block, &samples);
    }
};

void measure_errors(MathRow& row, Op op, int count)
{
    for (const auto& [a, b] : ir::elementary_arguments(op, count)) {
        const ir::Quad exact = ir::elementary_truth(op, a, b);
        const auto a32 = static_cast<float>(a), b32 = static_cast<float>(b);
        const ir::Quad exact32 = ir::elementary_truth(op, static_cast<double>(a32), static_cast<double>(b32));
        const auto take = [](double& worst, double off) { worst = std::max(worst, off); };
        take(row.f64.error, ir::units_off(ir::elementary_f64(op, a, b), exact));
        take(row.f64.library_error, ir::units_off(library_function(op, a, b), exact));
        take(row.f32.error, ir::units_off(ir::elementary_f32(op, a32, b32), exact32));
        take(row.f32.library_error, ir::units_off(library_function(op, a32, b32), exact32));
    }
}

} // namespace

std::vector<MathRow> bench_math(bool quick, const std::function<void(double)>& progress)
{
    ir::Module module;
    for (const Op op : ir::elementary_ops()) add_texture(module, op);
    std::shared_ptr<const jit::Code> code[2];
    for (size_t format = 0; format < 2; ++format) {
        std::vector<jit::EntryPoint> entries;
        for (const ir::Texture& texture : module.textures)
            for (const jit::LaneForm lanes : {jit::LaneForm::one, jit::LaneForm::points})
                entries.push_back({texture.name + (lanes == jit::LaneForm::points ? "*" : ""), &texture,
                                   jit::EntryPoint::Kind::height, lanes,
                                   format == 0 ? jit::Precision::f64 : jit::Precision::f32});
        code[format] = jit::compile_code(module, entries, {jit::Effort::full}).code;
    }
    std::vector<MathRow> rows;
    std::vector<Measured> measured;
    const std::vector<Op> ops = ir::elementary_ops();
    for (const Op op : ops) {
        progress(0.5 * static_cast<double>(rows.size()) / static_cast<double>(ops.size()));
        rows.push_back({std::string(ir::op_info(op).name), jit::engine_info().batch_lanes, ir::traits(op).ulp, {}, {}});
        measure_errors(rows.back(), op, quick ? 500 : 20'000);
        measured.emplace_back(op, *code[0], *code[1]);
    }
    const int rounds = quick ? 5 : 51;
    for (int round = 0; round < rounds; ++round) {
        progress(0.5 + 0.5 * round / rounds);
        for (Measured& one : measured) one.take();
    }
    progress(1);
    for (size_t i = 0; i < rows.size(); ++i) measured[i].write(rows[i]);
    return rows;
}

} // namespace haptel::bench
