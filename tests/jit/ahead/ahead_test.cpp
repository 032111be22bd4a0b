// Code that was compiled ahead of time: the bits of code that is made at run time, and complete without Haptel.
#include "jit/ahead/ahead.h"
#include "jit/texture/texture.h"
#include "tests/jit/codegen/batch.h"
#include "tests/jit/codegen/samples.h"
#include "tests/support/foreign_textures.h"
#include "tests/support/haptel_files.h"

using namespace haptel;
using namespace haptel::test;

namespace {

constexpr const char* link_command = "cc -shared -nostartfiles -Wl,-z,defs -o '%o' '%d/textures.o' -lm";

// Of the code that is made at run time in this process: avx512 of "avx512 vbmi".
std::string isa_of_engine()
{
    const std::string isa = jit::engine_info().isa;
    return isa.substr(0, isa.find(' '));
}

std::vector<emit_c::LibraryTexture> textures_of(const jit::CompiledProgram& program)
{
    std::vector<emit_c::LibraryTexture> textures;
    for (const haptel_texture& texture : program.textures())
        textures.push_back({&program.module(), &program.source_of(texture), texture.facts, "file.haptel"});
    return textures;
}

void check_equal_tables(const haptel_texture& made, const haptel_texture& expected)
{
    CHECK(made.abi == expected.abi);
    CHECK(made.size == expected.size);
    CHECK(made.reads == expected.reads);
    CHECK(made.writes == expected.writes);
    CHECK(made.block_size == expected.block_size);
    REQUIRE(made.parameter_count == expected.parameter_count);
    CHECK(std::string(made.name) == expected.name);
    CHECK(std::memcmp(&made.facts, &expected.facts, sizeof made.facts) == 0);
    for (uint32_t i = 0; i < made.parameter_count; ++i) {
        const haptel_parameter &a = made.parameters[i], &b = expected.parameters[i];
        CHECK(std::string(a.name) == b.name);
        CHECK(std::string(a.unit) == b.unit);
        CHECK(std::string(a.doc) == b.doc);
        CHECK(a.type == b.type);
        CHECK(std::memcmp(&a.offset, &b.offset, sizeof a - offsetof(haptel_parameter, offset)) == 0);
        const char* const* const names = expected.choices[i];
        REQUIRE((made.choices && made.choices[i]) == (names != nullptr));
        for (int k = 0; names && k <= static_cast<int>(a.maximum); ++k)
            CHECK(std::string(made.choices[i][k]) == names[k]);
    }
}

// Of each texture of a file, compiled for these sets, every entry.
void check_same_bits(const std::string& file, const std::vector<std::string>& isas)
{
    CAPTURE(file, isas);
    jit::TextureOptions options;
    options.entries = jit::Entries::both_and_batches;
    const jit::CompiledTextures compiled = jit::compile_texture_file(file, options);
    REQUIRE(compiled.program);
    const jit::AheadResult object = jit::build_object(textures_of(*compiled.program), {isas});
    INFO(object.error);
    REQUIRE(object.error.empty());
    ForeignTextures library;
    library.write("textures.o", object.bytes);
    library.open(link_command);
    Stimuli stimuli(7);
    for (const haptel_texture& expected : compiled.program->textures()) {
        CAPTURE(expected.name);
        const haptel_texture* const made = library.texture(expected.name);
        REQUIRE(made);
        check_equal_tables(*made, expected);
        size_t different = 0;
        for (int round = 0; round < 60; ++round) {
            const std::vector<double> block = stimuli.block(expected);
            std::vector<haptel_point> points(9);
            for (haptel_point& point : points) {
                point = stimuli.point();
                haptel_sample one = blank_sample, other = blank_sample;
                made->height(&point, block.data(), &one);
                expected.height(&point, block.data(), &other);
                different += !same_samples(one, other);
                made->height_gradient(&point, block.data(), &one);
                expected.height_gradient(&point, block.data(), &other);
                different += !same_samples(one, other);
            }
            for (const bool with_gradient : {false, true}) {
                Batch ours(points), theirs(points);
                const auto entry_of = [&](const haptel_texture& texture) {
                    return with_gradient ? texture.height_gradient_batch : texture.height_batch;
                };
                entry_of (*made)(&ours.points, ours.count, block.data(), &ours.samples);
                entry_of(expected)(&theirs.points, theirs.count, block.data(), &theirs.samples);
                for (size_t i = 0; i < points.size(); ++i) different += !same_samples(ours.sample(i), theirs.sample(i));
            }
        }
        CHECK(different == 0);
    }
}

} // namespace

TEST_CASE("textures compiled ahead of time have the bits of textures compiled at run time", "[code]")
{
    for (const auto& file : all_texture_files()) check_same_bits(file, {isa_of_engine()});
}

// Of many points the default precision fuses where the processor can: another set than the largest has other bits.
TEST_CASE("of several sets in one library the largest that this processor has is chosen at load", "[code]")
{
    std::vector<std::string> sets{"baseline"};
    for (const char* isa : {"avx2", "avx512"})
        if (sets.back() != isa_of_engine()) sets.emplace_back(isa);
    if (sets.back() != isa_of_engine()) return; // another architecture, which has one
    const auto files = texture_files();
    for (size_t i = 0; i < files.size(); i += 20) check_same_bits(files[i], sets);
}

TEST_CASE("angles of any size have the same bits ahead of time and at run time", "[code]")
{
    const auto program = compiled("texture t() { return 1mm * (sin(p.x) + cos(p.y) + tan(p.z)); }");
    const jit::AheadResult object = jit::build_object(textures_of(*program), {{isa_of_engine()}, jit::Precision::f64});
    ForeignTextures library;
    library.write("textures.o", object.bytes);
    library.open(link_command);
    const haptel_texture &expected = program->textures()[0], &made = *library.texture("t");
    std::mt19937_64 random(3);
    const std::vector<double> block(8);
    for (int i = 0; i < 200000; ++i) {
        haptel_point point{};
        for (double& number : point.p) number = std::bit_cast<double>(random());
        haptel_sample a = blank_sample, b = blank_sample;
        made.height_gradient(&point, block.data(), &a);
        expected.height_gradient(&point, block.data(), &b);
        REQUIRE(same_samples(a, b));
    }
}

TEST_CASE("equal textures give equal bytes, other sets other code, and what is not there is said")
{
    const auto program = compiled("texture t(float depth = 1mm) { return depth * fbm(p / 1mm, 3); }");
    const std::vector<emit_c::LibraryTexture> textures = textures_of(*program);
    const jit::AheadResult object = jit::build_object(textures, {{"baseline"}});
    REQUIRE(object.error.empty());
    CHECK(jit::build_object(textures, {{"baseline"}}).bytes == object.bytes);
    CHECK(jit::archive_of(object.bytes, "t.o").bytes == jit::archive_of(object.bytes, "t.o").bytes);
    CHECK(contains(jit::archive_of(object.bytes, "t.o").bytes, "t.o/"));
    CHECK(contains(jit::build_llvm_text(textures).bytes, "@haptel_texture_t ="));
    CHECK(contains(jit::build_object(textures, {{"mmx"}}).error, "expected baseline, avx2, avx512 or aarch64"));
    CHECK(contains(jit::build_object(textures, {{"avx2", "aarch64"}}).error, "are of different architectures"));
    CHECK(contains(jit::build_object(textures, {{"avx2", "avx2"}}).error, "'avx2' is named twice"));
    if (isa_of_engine() != "aarch64") // whichever is named first
        CHECK(jit::build_object(textures, {{"avx2", "baseline"}}).bytes ==
              jit::build_object(textures, {{"baseline", "avx2"}}).bytes);
}
