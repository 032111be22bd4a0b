// Library functions compiled apart change no bit, and are told apart by all that decides their code.
#include "jit/codegen/content_hash.h"
#include "tests/jit/codegen/parsed.h"
#include "tests/jit/codegen/samples.h"
#include "tests/support/catch.h"
#include "tests/support/haptel_files.h"
#include "tests/support/tries.h"

#include <cstring>
#include <random>
#include <set>

using namespace haptel;
using test::compiled;
using test::parsed;
using test::request_over;

namespace {

struct Arrays {
    explicit Arrays(size_t size) : count(size), numbers(4, std::vector<double>(size)), faults(size) {}
    size_t count;
    std::vector<std::vector<double>> numbers; // height, gradient
    std::vector<uint32_t> faults;
    haptel_samples samples()
    {
        haptel_samples all{};
        all.height_m = numbers[0].data();
        for (size_t i = 0; i < 3; ++i) all.gradient[i] = numbers[1 + i].data();
        all.faults = faults.data();
        return all;
    }
};

bool equal_bits(const std::vector<double>& a, const std::vector<double>& b)
{
    return std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

// One by one and in a batch, by two programs of one texture.
void check_equal(const haptel_texture& a, const haptel_texture& b, const void* block)
{
    constexpr size_t count = 40; // not a multiple of the lanes
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> place(-0.05, 0.05);
    constexpr size_t input_count = sizeof(haptel_point) / sizeof(double);
    static_assert(sizeof(haptel_points) == input_count * sizeof(double*));
    std::vector<std::vector<double>> inputs(input_count, std::vector<double>(count));
    for (auto& input : inputs)
        for (double& value : input) value = place(random);
    haptel_points points{};
    for (size_t i = 0; i < input_count; ++i) reinterpret_cast<const double**>(&points)[i] = inputs[i].data();

    Arrays of_a(count), of_b(count);
    haptel_samples samples_a = of_a.samples(), samples_b = of_b.samples();
    a.height_gradient_batch(&points, count, block, &samples_a);
    b.height_gradient_batch(&points, count, block, &samples_b);
    for (size_t i = 0; i < 4; ++i) CHECK(equal_bits(of_a.numbers[i], of_b.numbers[i]));
    CHECK(of_a.faults == of_b.faults);

    for (size_t i = 0; i < count; ++i) {
        haptel_point point{};
        for (size_t j = 0; j < input_count; ++j) reinterpret_cast<double*>(&point)[j] = inputs[j][i];
        haptel_sample one{}, other{};
        a.height_gradient(&point, block, &one);
        b.height_gradient(&point, block, &other);
        REQUIRE(std::memcmp(&one, &other, sizeof one) == 0);
        a.height(&point, block, &one);
        b.height(&point, block, &other);
        REQUIRE(std::memcmp(&one.height_m, &other.height_m, sizeof(double)) == 0);
    }
}

// Of the last function, which calls the others.
std::string hash_of(const std::string& text)
{
    return jit::to_text(jit::function_hashes(parsed(text)).back());
}

} // namespace

TEST_CASE("every texture of the library has the same bits with kernels and without, one by one and in lanes")
{
    const std::vector<std::filesystem::path> files = test::texture_files({"stdlib/tests"});
    for (std::size_t f = 0; f < files.size(); f += test::is_sanitized ? 4 : 1) // what compiles them is slow then
        for (jit::Precision precision : {jit::Precision::f64, jit::Precision::mixed}) {
            if (test::is_sanitized && precision == jit::Precision::f64) continue;
            const std::filesystem::path& file = files[f];
            INFO(file);
            jit::TextureOptions options;
            options.entries = jit::Entries::both_and_batches;
            options.precision = precision;
            const auto with = jit::compile_texture_file(file, options);
            options.kernels = false;
            const auto without = jit::compile_texture_file(file, options);
            REQUIRE(with.program);
            REQUIRE(without.program);
            for (size_t i = 0; i < with.program->textures().size(); ++i) {
                const haptel_texture& texture = with.program->textures()[i];
                INFO(texture.name);
                const TextureResult bound =
                    jit::make_binding(with.program, texture.name, request_over(0.1), jit::For::figures);
                REQUIRE(bound.binding);
                check_equal(texture, without.program->textures()[i], bound.binding->block);
            }
        }
}

TEST_CASE("one function in several forms: of what varies and of what does not, with results in f64 and in f32")
{
    const std::string text = "texture t(float depth = 3mm in 1mm .. 5mm) {\n"
                             "    float uniform_one = perlin(vec3(depth / 7mm, 0.25, 0.5));\n"
                             "    float wide = fract(1e4 * perlin(p / 3mm));\n"
                             "    float partly = perlin(vec3(p.x / 2mm, depth / 7mm, 0.5));\n"
                             "    return depth * (uniform_one + wide + partly + perlin(p / 1mm) * 0.5);\n}\n";
    for (int form = 0; form < 6; ++form) {
        jit::TextureOptions options;
        const auto precision = static_cast<jit::Precision>(form / 2);
        options.effort = form % 2 ? jit::Effort::quick : jit::Effort::draft;
        options.entries = jit::Entries::both_and_batches;
        options.precision = precision;
        const auto with = jit::compile_texture(text, options);
        options.kernels = false;
        options.effort = jit::Effort::full;
        const auto without = jit::compile_texture(text, options);
        REQUIRE((with.program && without.program));
        const TextureResult bound = jit::make_binding(with.program, "t", request_over(0.1), jit::For::figures);
        REQUIRE(bound.binding);
        check_equal(with.program->textures()[0], without.program->textures()[0], bound.binding->block);
    }
}

TEST_CASE("programs that call the same library function share its code")
{
    compiled("texture t() { return 1mm * fbm(p / 3mm, 5); }");
    const size_t before = jit::kernels_alive();
    CHECK(before > 0);
    compiled("texture other(float depth = 2mm) { return depth * fbm(p / 7mm, 3) + 1um; }");
    CHECK(jit::kernels_alive() == before);
    compiled("float mine(vec3 q) { return q.x; } texture t() { return 1mm * fbm(mine, p / 3mm, 5, 2.0, 0.5); }");
    CHECK(jit::kernels_alive() == before); // the user's own, with what is called with it
}

TEST_CASE("a file's own function takes the place of the library's inside no kernel")
{
    const std::string own = "float perlin(vec3 q) { return q.x; } ";
    for (const std::string& text : {own + "texture t() { return 1mm * perlin(p / 1m); }",
                                    own + "texture t() { return 1mm * fbm(perlin, p / 1m, 1, 2.0, 0.5); }"}) {
        jit::TextureOptions options;
        options.kernels = false;
        const auto with = compiled(text);
        const auto without = jit::compile_texture(text, options);
        const auto a = jit::make_binding(with, "t", request_over(1));
        const auto b = jit::make_binding(without.program, "t", request_over(1));
        REQUIRE((a.binding && b.binding));
        CHECK(test::sample_at(*a.binding, {0.25, 0, 0}).height_m == test::sample_at(*b.binding, {0.25, 0, 0}).height_m);
    }
}

TEST_CASE("the hash of a function covers all that decides its code, and neither names nor places")
{
    const auto text = [](const std::string& name, const std::string& constant, const std::string& op,
                         const std::string& cells, const std::string& trips) {
        return "table \"cells\" real [" + cells + "]\nfunction \"" + name + "\" (%x: real) {\n  %c = real " + constant +
               "\n  %r = " + op +
               " %x, %c\n  return %r\n}\nfunction \"caller\" (%x: real) {\n  %i = i32 0\n  %t = table 0 %i\n"
               "  %n = i32 " +
               trips + "\n  %y = call \"" + name + "\" (%x)\n  %z = add %y, %t\n  return %z\n}\n";
    };
    const std::string plain = hash_of(text("f", "2", "add", "1, 2", "3"));
    CHECK(hash_of(text("g", "2", "add", "1, 2", "3")) == plain);
    std::set<std::string> all{plain};
    all.insert(hash_of(text("f", "3", "add", "1, 2", "3")));
    all.insert(hash_of(text("f", "-2", "add", "1, 2", "3")));
    all.insert(hash_of(text("f", "2", "mul", "1, 2", "3")));
    all.insert(hash_of(text("f", "2", "add", "1, 3", "3")));
    all.insert(hash_of(text("f", "2", "add", "1, 2, 2", "3")));
    all.insert(hash_of(text("f", "2", "add", "1, 2", "4")));
    CHECK(all.size() == 7);

    ir::Module module = parsed(text("f", "2", "add", "1, 2", "3"));
    module.functions[0].facts.resize(1); // the choice of precision reads them
    ir::Facts& facts = module.functions[0].facts[0];
    const auto changed = [&](auto& of, auto to) {
        of = to;
        return jit::to_text(jit::function_hashes(module).back());
    };
    all.insert(changed(facts.value_maximum, 1.0));
    all.insert(changed(facts.value_minimum, 1.0));
    all.insert(changed(facts.slope, 1.0));
    all.insert(changed(facts.curvature, 1.0));
    all.insert(changed(facts.continuity, ir::Continuity::c1));
    all.insert(changed(facts.continuity, ir::Continuity::c2));
    all.insert(changed(facts.proven, !facts.proven));
    CHECK(all.size() == 14);
    module = parsed(text("f", "2", "add", "1, 2", "3"));
    module.functions[0].body.instructions[0].span = {3, 14, 15};
    CHECK(jit::to_text(jit::function_hashes(module).back()) == plain);
    module = parsed(text("f", "2", "add", "1, 2", "3"));
    module.functions[0].is_library = true; // the choice of what is called and what is written in reads it
    CHECK(jit::to_text(jit::function_hashes(module).back()) != plain);
}
