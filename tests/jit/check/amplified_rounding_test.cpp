// Errors that a texture makes of its own rounding are told apart from faults, with their place. The sizes are known:
// of f64 a result is off by half of its last digit.
#include "jit/check/check_gradient.h"
#include "tests/jit/codegen/samples.h"

#include <cmath>

using namespace haptel;
using test::compiled;
using test::contains;

namespace {

struct Checked {
    jit::GradientCheck check;
    std::string place; // the text that is blamed
};

// `spoil` may be null.
Checked checked_gradient(const std::string& text, haptel_entry* spoil = nullptr)
{
    const auto program = compiled(text);
    auto bound = jit::make_binding(program, "", test::request_over(0.05), jit::For::figures);
    INFO(bound.diagnostics);
    REQUIRE(bound.binding);
    haptel_texture texture = *bound.binding->texture;
    if (spoil) texture.height_gradient = spoil;
    TextureBinding binding = *bound.binding;
    binding.texture = &texture;
    Checked checked{jit::check_gradient(program, binding, {}, 200), {}};
    if (checked.check.amplified) checked.place = program->sources().text(checked.check.amplified->span);
    return checked;
}

// Cells of 1 mm, each with a height of 0 .. 1 mm by the hash.
std::string cells(const std::string& hash)
{
    return "float of_cell(float n) { return " + hash + "; }\ntexture t() { return 1mm * of_cell(floor(p.x / 1mm)); }";
}

} // namespace

TEST_CASE("a hash of a sine passes, and is told with its place and size")
{
    for (const char* hash : {"fract(sin(n) * 43758.5453)", "fract(cos(n) * 43758.5453)", "fract(43758.5453 * sin(n))",
                             "fract(0.5 + sin(n) * 437.585 * 100.0)"}) {
        INFO(hash);
        const Checked found = checked_gradient(cells(hash));
        REQUIRE(found.check.amplified);
        CHECK(found.check.passed());
        CHECK(found.check.amplified->is_hash_of_sine);
        CHECK(found.place == hash);
        // The sine, of a whole number, is at most 1 and off by at most 2^-53; the product, below 2^16, by half of its
        // last digit, 2^-37; with the sum at most as much again. The largest height is 0.9 to 1 of a millimetre.
        const double most = (43758.6 * 0x1p-53 + 2 * 0x1p-37) / 0.9;
        CHECK(found.check.amplified->height <= most);
        CHECK(found.check.amplified->height >= most / 100); // the worst of some fifty cells
        CHECK(*found.check.height_error_oracle > 1e-12);
        CHECK(found.check.amplified->gradient == 0);
    }
}

TEST_CASE("other numbers that lose their digits are told as well, and hash() is none of them")
{
    const Checked folded = checked_gradient(cells("fract(n * 1234567.891)"));
    REQUIRE(folded.check.amplified);
    CHECK(folded.check.passed());
    CHECK_FALSE(folded.check.amplified->is_hash_of_sine);
    CHECK(folded.place == "fract(n * 1234567.891)");

    const Checked exact = checked_gradient(cells("hash(int(n))"));
    CHECK(exact.check.passed());
    CHECK_FALSE(exact.check.amplified);
    const Checked smooth = checked_gradient("texture t() { return 1mm * sinturn(p.x / 1mm); }");
    CHECK(smooth.check.passed());
    CHECK_FALSE(smooth.check.amplified);
}

TEST_CASE("digits that are lost otherwise are a fault as before")
{
    // 1e6 + x keeps ten digits of x behind the point; nothing is folded.
    const Checked cancelled =
        checked_gradient("texture t() { float x = p.x / 1mm; return 1mm * ((x + 1000000.0) - 1000000.0); }");
    CHECK_FALSE(cancelled.check.amplified);
    CHECK_FALSE(cancelled.check.passed());
}

TEST_CASE("a wrong height or gradient fails, however much the texture amplifies")
{
    static haptel_entry* original = nullptr;
    const std::string text = "float of_cell(float n) { return fract(sin(n) * 43758.5453); }\n"
                             "texture t() { return 1mm * of_cell(floor(p.x / 1mm)) * sinturn(p.y / 5mm); }";
    const auto program = compiled(text);
    original = program->find("")->height_gradient;
    const Checked right = checked_gradient(text, original);
    CHECK(right.check.passed());
    CHECK(right.check.amplified);
    const Checked gradient =
        checked_gradient(text, [](const haptel_point* point, const void* block, haptel_sample* sample) {
            original(point, block, sample);
            sample->gradient[1] *= 1 + 1e-9;
        });
    CHECK_FALSE(gradient.check.amplified);
    REQUIRE_FALSE(gradient.check.passed());
    CHECK(contains(gradient.check.failures.back(), "worst at --at "));
    const Checked height =
        checked_gradient(text, [](const haptel_point* point, const void* block, haptel_sample* sample) {
            original(point, block, sample);
            sample->height_m *= 1 + 1e-9;
        });
    CHECK_FALSE(height.check.passed());
}
