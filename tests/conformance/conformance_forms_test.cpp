// The values of every file of cases/ in every form of code: each precision, one point and many, hardly and fully
// optimised. In f64 all have the same bits. In mixed and f32 a value is no further from the exact one than rounding
// each operation to f32 can lead; a height is the same with and without its gradient, and in a batch as alone.
#include "jit/check/entry_inputs.h"
#include "tests/conformance/folder.h"
#include "tests/conformance/request.h"
#include "tests/jit/codegen/batch.h"
#include "tests/support/ball.h"
#include "tests/support/tries.h"

using namespace haptel;
using namespace haptel::lang::test;
using haptel::test::Ball, haptel::test::Batch, haptel::test::same;

namespace {

struct Program {
    Program(const Case& wanted, jit::Precision precision, bool in_lanes, jit::Effort effort)
    {
        jit::TextureOptions options;
        options.load_import = wanted.loader();
        options.entries = jit::Entries::both_and_batches;
        options.precision = precision;
        options.iterations_in_lanes = in_lanes;
        options.effort = effort;
        compiled = jit::compile_texture(wanted.main.text, options).program;
    }
    TextureBinding bind(const Evaluation& at) const
    {
        const TextureResult bound = jit::make_binding(compiled, compiled->textures().back().name,
                                                      request_for(*compiled, at), jit::For::figures);
        INFO(bound.diagnostics);
        REQUIRE(bound.binding);
        return *bound.binding;
    }
    std::shared_ptr<const jit::CompiledProgram> compiled;
};

haptel_sample sample(const TextureBinding& binding, const haptel_point& point)
{
    haptel_sample both = blank_sample, alone{};
    binding.texture->height_gradient(&point, binding.block, &both);
    binding.texture->height(&point, binding.block, &alone);
    CHECK(same(both.height_m, alone.height_m));
    return both;
}

haptel_sample sample_in_batch(const TextureBinding& binding, const haptel_point& point)
{
    Batch batch({point}), heights({point});
    binding.texture->height_gradient_batch(&batch.points, 1, binding.block, &batch.samples);
    binding.texture->height_batch(&heights.points, 1, binding.block, &heights.samples);
    CHECK(same(batch.sample(0).height_m, heights.sample(0).height_m));
    return batch.sample(0);
}

// What the texture gives, and how far rounding to f32 may lead away from it; nothing where it decides.
struct Rounded {
    Rounded(const Program& program, const TextureBinding& binding, const haptel_point& point)
    {
        Ball::in_singles = true;
        Ball::undecided = false;
        const ir::Texture& texture = program.compiled->source_of(*program.compiled->find(binding.texture->name));
        ir::EntryInputs<Ball> inputs;
        jit::set_block(inputs, texture, binding.block);
        jit::set_point(inputs, point);
        ir::Interpreter<Ball> interpreter(program.compiled->module());
        interpreter.watch_decisions(true);
        const auto results = interpreter.run(texture.height_gradient, {}, &inputs);
        for (size_t i = 0; i < 4; ++i) balls.push_back(results[i].real);
        is_decided = !Ball::undecided && results[4].bits == 0;
        Ball::in_singles = false;
    }
    bool may_be(const haptel_sample& found) const
    {
        return !is_decided ||
               (found.faults == 0 && balls[0].may_be(found.height_m) && balls[1].may_be(found.gradient[0]) &&
                balls[2].may_be(found.gradient[1]) && balls[3].may_be(found.gradient[2]));
    }
    std::vector<Ball> balls;
    bool is_decided;
};

} // namespace

TEST_CASE("conformance: every form of code gives the values of every file, to its precision")
{
    using jit::Effort, jit::Precision;
    size_t bits = 0, rounded = 0, undecided = 0;
    std::size_t number = 0;
    for (const CaseFile& file : case_files()) {
        INFO(file.name);
        const Case wanted = read_case(file.text);
        if (wanted.evaluations.empty()) continue;
        if (test::is_sanitized && ++number % 4 != 0) continue; // what compiles them is slow then
        const Program exact(wanted, Precision::f64, false, Effort::draft),
            full(wanted, Precision::f64, false, Effort::full), mixed(wanted, Precision::mixed, false, Effort::quick),
            single(wanted, Precision::f32, false, Effort::quick), lanes(wanted, Precision::mixed, true, Effort::quick);
        REQUIRE((exact.compiled && full.compiled && mixed.compiled && single.compiled && lanes.compiled));
        for (const Evaluation& at : wanted.evaluations) {
            INFO(at.line);
            const TextureBinding reference = exact.bind(at);
            const haptel_sample truth = sample(reference, at.point);
            CHECK(same(truth, sample_in_batch(reference, at.point)));
            CHECK(same(truth, sample(full.bind(at), at.point)));
            CHECK(same(truth, sample_in_batch(full.bind(at), at.point)));
            ++bits;
            const Rounded singles(exact, reference, at.point);
            singles.is_decided ? ++rounded : ++undecided;
            for (const Program* program : {&mixed, &single}) {
                const haptel_sample found = sample(program->bind(at), at.point);
                INFO("height " << found.height_m << ", gradient " << found.gradient[0] << ", " << found.gradient[1]
                               << ", " << found.gradient[2] << ", faults " << found.faults << "; in f64 "
                               << truth.height_m << ", " << truth.gradient[0] << ", " << truth.gradient[1] << ", "
                               << truth.gradient[2]);
                CHECK(singles.may_be(found));
                CHECK(same(found, sample_in_batch(program->bind(at), at.point)));
            }
            sample(lanes.bind(at), at.point);
        }
    }
    CHECK(bits >= test::tries(200u));
    INFO(rounded << " held to rounding, " << undecided << " decided by it");
    CHECK(rounded > undecided);
}
