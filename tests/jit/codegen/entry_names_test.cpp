// Names of textures are the author's: none of them can be taken for what code is linked with.
#include "jit/codegen/codegen.h"
#include "tests/jit/codegen/samples.h"
#include "tests/support/tries.h"

using namespace haptel;
using namespace haptel::test;

namespace {

// Calls, on one processor or another, every function that code is linked with.
std::string texture_named(const std::string& name)
{
    return "texture " + name + R"((image picture, float w = 1mm)
    {
        float x = p.x / w, kept[8];
        for (int i = 0; i < 8; ++i) kept[i] = float(i) * x;
        float steps = floor(x) + ceil(0.7 * x) + trunc(0.9 * x) + round(1.1 * x);
        float far = sin(1e9 * x) + fma(x, x, 0.5) + sample(picture, p.xy / 1m) + float(image_width(picture));
        return 1mm * (steps + far + kept[int(p.y / 1mm)]);
    })";
}

std::shared_ptr<const jit::CompiledProgram> program_named(const std::string& name, jit::Effort effort)
{
    jit::TextureOptions options;
    options.entries = jit::Entries::both_and_batches;
    options.effort = effort;
    const jit::CompiledTextures made = jit::compile_texture(texture_named(name), options);
    INFO(made.rendered());
    REQUIRE(made.program);
    return made.program;
}

// Height alone, beside its gradient, and in batches of f32 and f64.
std::vector<double> numbers_of(const jit::CompiledProgram& program, const void* block)
{
    const haptel_texture& texture = program.textures()[0];
    haptel_point point{};
    point.p[0] = 0.00123;
    point.p[1] = 0.0042;
    haptel_sample alone{}, both{};
    texture.height(&point, block, &alone);
    texture.height_gradient(&point, block, &both);
    haptel_points points{};
    for (size_t i = 0; i < 3; ++i) points.p[i] = &point.p[i];
    double height = 0, height_beside = 0;
    haptel_samples heights{}, all{};
    heights.height_m = &height;
    all.height_m = &height_beside;
    texture.height_batch(&points, 1, block, &heights);
    texture.height_gradient_batch(&points, 1, block, &all);
    return {alone.height_m, both.height_m, both.gradient[0], both.gradient[1], height, height_beside};
}

} // namespace

TEST_CASE("a texture may have the name of any function that its code is linked with", "[code]")
{
    std::vector<std::string> names = {"memmove", "main", "haptel_texture", "exp", "sqrt"};
    for (const jit::LibraryFunction& function : jit::code_library()) names.emplace_back(function.name);
    for (const jit::Effort effort : {jit::Effort::draft, jit::Effort::quick, jit::Effort::full}) {
        const auto plain = program_named("t", effort);
        const TextureResult bound = jit::make_binding(plain, "t", request_over(0.05), jit::For::figures);
        REQUIRE(bound.binding);
        const std::vector<double> expected = numbers_of(*plain, bound.binding->block);
        // All at the effort at which LLVM does most, with functions whose names it knows; and some at the others.
        for (size_t i = 0; i < names.size(); i += effort == jit::Effort::full && !is_sanitized ? 1 : 5) {
            const std::string& name = names[i];
            INFO(name);
            CHECK(numbers_of(*program_named(name, effort), bound.binding->block) == expected);
        }
    }
}
