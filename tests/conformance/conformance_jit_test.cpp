// The values of every file of cases/ through machine code: as expected, and bit for bit those of the interpreter.
#include "jit/check/oracle.h"
#include "tests/conformance/case.h"
#include "tests/conformance/folder.h"
#include "tests/conformance/request.h"
#include "tests/jit/codegen/engines.h"

#include <cstring>

using namespace haptel;
using namespace haptel::lang::test;
using haptel::test::same;

namespace {

Outcome outcome_of(const haptel_sample& sample)
{
    return {sample.height_m, {sample.gradient[0], sample.gradient[1], sample.gradient[2]}, sample.faults, sample};
}

bool same_bits(const Outcome& a, const Outcome& b)
{
    for (const OutputInfo& output : output_table)
        for (size_t i = 0; i < output.components; ++i)
            if (!same(components_of(a.sample, output)[i], components_of(b.sample, output)[i])) return false;
    return same(a.height, b.height) && same(a.gradient[0], b.gradient[0]) && same(a.gradient[1], b.gradient[1]) &&
           same(a.gradient[2], b.gradient[2]) && a.faults == b.faults;
}

std::string differences(const std::string& text, jit::Effort effort)
{
    const Case wanted = read_case(text);
    if (wanted.evaluations.empty()) return {};
    jit::TextureOptions options;
    options.load_import = wanted.loader();
    options.effort = effort;
    const jit::CompiledTextures made = jit::compile_texture(wanted.main.text, options);
    if (!made.program) return made.rendered();
    const std::string name = made.program->textures().back().name;
    std::string all;
    for (const Evaluation& at : wanted.evaluations) {
        const TextureResult bound =
            jit::make_binding(made.program, name, request_for(*made.program, at), jit::For::figures);
        if (!bound.binding) return all + bound.diagnostics;
        haptel_sample sample = blank_sample, height{};
        bound.binding->texture->height_gradient(&at.point, bound.binding->block, &sample);
        bound.binding->texture->height(&at.point, bound.binding->block, &height);
        const Outcome found = outcome_of(sample);
        all += value_differences(at, "code", found);
        if (!same_bits(found, outcome_of(jit::interpret_sample(*made.program, *bound.binding, at.point))))
            all += "code differs from the interpreter: " + at.line + "\n";
        if (!same(sample.height_m, height.height_m)) all += "height alone differs: " + at.line + "\n";
    }
    return all;
}

} // namespace

TEST_CASE("conformance: machine code gives the values of every file")
{
    size_t evaluations = 0;
    for (const CaseFile& file : case_files()) {
        INFO(file.name);
        CHECK(differences(file.text, jit::Effort::quick) == "");
        evaluations += read_case(file.text).evaluations.size();
    }
    CHECK(evaluations >= 200);
    CHECK(differences("texture t() { return p.x; }\n//= p=2,0,0 height=3\n", jit::Effort::full) ==
          "code: expected height 3, found 2: p=2,0,0 height=3\n");
}
