// Iterations of a loop side by side, for one point: which loops allow it, and that it changes nothing but the order of
// additions.
#include "jit/codegen/iteration_lanes.h"
#include "tests/jit/codegen/samples.h"
#include "tests/support/haptel_files.h"
#include "tests/support/project_path.h"
#include "tests/support/tries.h"

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <random>

using namespace haptel;

namespace {

struct Case {
    const char* name;
    const char* body; // of a function of (vec3 p, int n) that returns a float; p and n are whole numbers
    bool in_lanes;
    std::function<double(const double*, int)> truth;
};

// Whole numbers below 2^24, so that every order of additions is exact, in f32 as well.
const std::vector<Case>& cases()
{
    static const std::vector<Case> all = {
        {"factor",
         "float s = 1.0; float f = 1.0; for (int i = 0; i < min(n, 20); ++i) { s += p.x * f; f *= 2.0; } return s;",
         true, [](const double* p, int n) { return 1 + p[0] * (std::exp2(std::min(n, 20)) - 1); }},
        {"steps",
         "float s = p.y; float a = 7.0; float b = 0.0; for (int i = 0; i < min(n, 40); ++i) { s += a * p.x - b; "
         "a += 3.0; b = b - 2.0; } return s;",
         true,
         [](const double* p, int n) {
             double sum = p[1];
             for (int i = 0; i < std::min(n, 40); ++i) sum += (7 + 3.0 * i) * p[0] + 2.0 * i;
             return sum;
         }},
        {"the iteration's number", "float s = 0.0; for (int i = 0; i < min(n, 40); ++i) s += float(i) * p.x; return s;",
         true, [](const double* p, int n) { return p[0] * std::min(n, 40) * (std::min(n, 40) - 1) / 2; }},
        {"another value from the second on",
         "float s = 0.0; float w = 9.0; for (int i = 0; i < min(n, 20); ++i) { s += w * p.x; "
         "w = 2.0; } return s;",
         true, [](const double* p, int n) { return std::min(n, 20) == 0 ? 0 : p[0] * (7 + 2 * std::min(n, 20)); }},
        {"a branch, two sums, a sum of two",
         "float s = 0.0; float t = 0.0; for (int i = 0; i < min(n, 20); ++i) { if (i % 3 == 1) "
         "{ s += p.x; s += 2.0; } else { t -= p.y; } } return s + 100.0 * t;",
         true,
         [](const double* p, int n) {
             double s = 0, t = 0;
             for (int i = 0; i < std::min(n, 20); ++i) i % 3 == 1 ? s += p[0] + 2 : t -= p[1];
             return s + 100 * t;
         }},
        {"a branch on the point",
         "float s = 0.0; for (int i = 0; i < min(n, 20); ++i) { if (p.x < float(i)) s += float(i); } return s;", true,
         [](const double* p, int n) {
             double s = 0;
             for (int i = 0; i < std::min(n, 20); ++i) s += p[0] < i ? i : 0;
             return s;
         }},
        {"tables at whole steps",
         "const float t[5] = float[](3.0, 1.0, 4.0, 1.0, 5.0); float s = 0.0; int k = 4; int m = 1; "
         "for (int i = 0; i < min(n, 20); ++i) { s += t[k % 5] * p.x + t[m % 5] + t[i % 5]; k += 3; m *= 3; } return "
         "s;",
         true,
         [](const double* p, int n) {
             const double t[] = {3, 1, 4, 1, 5};
             double s = 0;
             int32_t k = 4;
             uint32_t m = 1;
             for (int i = 0; i < std::min(n, 20); ++i, k += 3, m *= 3) {
                 const int32_t at = static_cast<int32_t>(m) % 5;
                 s += t[k % 5] * p[0] + t[std::max(at, 0)] + t[i % 5];
             }
             return s;
         }},
        {"a loop in the loop",
         "float s = 0.0; for (int i = 0; i < min(n, 20); ++i) { float q = 1.0; for (int j = 0; j < min(i, 4); ++j) "
         "q *= 2.0; s += q * p.x; } return s;",
         true,
         [](const double* p, int n) {
             double s = 0;
             for (int i = 0; i < std::min(n, 20); ++i) s += std::exp2(std::min(i, 4)) * p[0];
             return s;
         }},
        {"the point's own factor",
         "float s = 0.0; float f = 1.0; for (int i = 0; i < min(n, 5); ++i) { s += f; f *= p.x; } return s;", false,
         [](const double* p, int n) {
             double s = 0, f = 1;
             for (int i = 0; i < std::min(n, 5); ++i, f *= p[0]) s += f;
             return s;
         }},
        {"a sum that its terms see",
         "float s = 1.0; for (int i = 0; i < min(n, 10); ++i) s += s * 1.0 + p.x; return s;", false,
         [](const double* p, int n) {
             double s = 1;
             for (int i = 0; i < std::min(n, 10); ++i) s += s + p[0];
             return s;
         }},
        {"a factor that is used after",
         "float s = 0.0; float f = 1.0; for (int i = 0; i < min(n, 10); ++i) { s += p.x; f *= 2.0; } "
         "return s + f;",
         false, [](const double* p, int n) { return p[0] * std::min(n, 10) + std::exp2(std::min(n, 10)); }},
        {"split: a product and a maximum",
         "float a = 1.0; float b = -9.0; for (int i = 0; i < min(n, 20); ++i) { float t = term(p, float(i)); "
         "a *= t > 0.0 ? -1.0 : 1.0; b = max(b, t); } return 10.0 * a + b;",
         true,
         [](const double* p, int n) {
             double a = 1, b = -9;
             for (int i = 0; i < std::min(n, 20); ++i) {
                 const double t = (p[0] - i) * (p[1] - i) - i;
                 a *= t > 0 ? -1 : 1;
                 b = std::max(b, t);
             }
             return 10 * a + b;
         }},
        {"split: a weight, a branch that waits around work that does not, a factor used after, a loop inside",
         "float s = 0.0; float w = 1.0; float f = 1.0; bool odd = false; for (int i = 0; i < min(n, 20); ++i) { "
         "if (w < 50.0) { float t = term(p, f); s += w * t; w = min(abs(t) + w, 60.0); } else { w -= term(p.yxz, 3.0); "
         "} "
         "odd = odd != (term(p, float(i)) > 2.0); f += 2.0; "
         "for (int j = 0; j < i % 3; ++j) s = s - float(j) * w; } return s + f + (odd ? 0.5 : 0.0);",
         true,
         [](const double* p, int n) {
             const auto term = [](double x, double y, double k) { return (x - k) * (y - k) - k; };
             double s = 0, w = 1, f = 1;
             bool odd = false;
             for (int i = 0; i < std::min(n, 20); ++i) {
                 if (w < 50) {
                     const double t = term(p[0], p[1], f);
                     s += w * t;
                     w = std::min(std::fabs(t) + w, 60.0);
                 } else {
                     w -= term(p[1], p[0], 3);
                 }
                 odd = odd != (term(p[0], p[1], i) > 2);
                 f += 2;
                 for (int j = 0; j < i % 3; ++j) s -= j * w;
             }
             return s + f + (odd ? 0.5 : 0.0);
         }},
        {"split: it leaves when it has enough",
         "float s = 0.0; for (int i = 0; i < min(n, 20); ++i) { s += abs(term(p, float(i))); if (s > 40.0) break; } "
         "return s;",
         true,
         [](const double* p, int n) {
             double s = 0;
             for (int i = 0; i < std::min(n, 20) && s <= 40; ++i) s += std::fabs((p[0] - i) * (p[1] - i) - i);
             return s;
         }},
        {"too few to fill lanes", "float s = 0.0; for (int i = 0; i < min(n, 2); ++i) s += p.x * float(i); return s;",
         false, [](const double* p, int n) { return n >= 2 ? p[0] : 0; }},
    };
    return all;
}

std::string source(const std::string& body)
{
    return "float term(vec3 q, float k) { return (q.x - k) * (q.y - k) - k; }\n"
           "float sum(vec3 q, float k) { float s = 0.1; float f = 0.7; for (int i = 0; i < 11; ++i) "
           "{ s += term(q, k) * f; f *= 0.9; } return s; }\nfloat f(vec3 p, int n) { " +
           body + " }\ntexture t(int n = 0 in 0 .. 100) { return 1m * f(p / 1m, n); }";
}

size_t loops_in_lanes(const ir::Module& module, const std::string& name_part)
{
    for (const ir::Function& function : module.functions)
        if (function.name.find(name_part) != std::string::npos && function.name.rfind("d ", 0) != 0)
            return jit::lane_loops(function, jit::varying_values(function, {true, true, true, false})).size();
    return 99;
}

} // namespace

TEST_CASE("loops whose iterations need not wait for one another run in lanes and give the same numbers", "[code]")
{
    const jit::Precision precision = GENERATE(jit::Precision::f64, jit::Precision::mixed, jit::Precision::f32);
    const jit::Effort effort = GENERATE(jit::Effort::draft, jit::Effort::quick);
    const std::vector<Case> all = cases();
    for (std::size_t c = 0; c < all.size(); c += test::is_sanitized ? 5 : 1) { // what compiles them is slow then
        const Case& one = all[c];
        jit::TextureOptions options;
        options.precision = precision;
        options.effort = effort;
        options.iterations_in_lanes = true;
        const jit::CompiledTextures compiled = jit::compile_texture(source(one.body), options);
        INFO(one.name << "\n" << compiled.rendered());
        REQUIRE(compiled.program);
        CHECK(loops_in_lanes(compiled.program->module(), "f(") == (one.in_lanes ? 1 : 0));
        for (const int n : {0, 1, 2, 3, 7, 8, 9, 15, 16, 17, 20, 40}) {
            TextureRequest request = test::request_over(20);
            request.parameters = {{"n", std::to_string(n)}};
            const TextureResult bound = jit::make_binding(compiled.program, "t", request, jit::For::figures);
            INFO(bound.diagnostics);
            REQUIRE(bound.binding);
            for (const std::array<double, 3>& p : {std::array{0.0, 0.0, 0.0}, {3, -2, 5}, {-1, 4, 2}, {6, 1, -7}}) {
                INFO("n " << n << ", p.x " << p[0]);
                const haptel_sample sample = test::sample_at(*bound.binding, p);
                CHECK(sample.height_m == one.truth(p.data(), n));
                haptel_sample alone{};
                haptel_point point{};
                std::copy(p.begin(), p.end(), point.p);
                bound.binding->texture->height(&point, bound.binding->block, &alone);
                CHECK(alone.height_m == sample.height_m);
            }
        }
    }
}

// Of three iterations, in lanes of any number, one lane at least is idle. Did it go on to iteration 3, it would read
// 14 million cells on, where nothing is mapped.
TEST_CASE("a lane that is idle reads nothing behind the table that the last iteration ends", "[code]")
{
    constexpr int last = 1 << 15;
    std::string cells = "2.0, 3.0";
    for (int i = 2; i < last; ++i) cells += ", 0.0";
    const std::string text =
        source("const float t[" + std::to_string(last + 1) + "] = float[](" + cells +
               ", 5.0); float s = 0.0; for (int i = 0; i < 3; ++i) { int c = i * i * i; int b = c * c * c * i; "
               "s += t[b * c * i * i] * p.x; } return s;");
    for (const jit::Precision precision : {jit::Precision::f64, jit::Precision::f32}) {
        jit::TextureOptions options;
        options.precision = precision;
        options.effort = jit::Effort::quick;
        options.iterations_in_lanes = true;
        const jit::CompiledTextures compiled = jit::compile_texture(text, options);
        INFO(compiled.rendered());
        REQUIRE(compiled.program);
        CHECK(loops_in_lanes(compiled.program->module(), "f(") == 1);
        const TextureResult bound = jit::make_binding(compiled.program, "t", test::request_over(1), jit::For::figures);
        REQUIRE(bound.binding);
        CHECK(test::sample_at(*bound.binding, {0.25, 0, 0}).height_m == 0.25 * (2 + 3 + 5));
    }
}

TEST_CASE("iterations in lanes: every texture's height is the same with and without its gradient, and close to the "
          "order of one by one",
          "[code]")
{
    const jit::Precision precision = GENERATE(jit::Precision::f64, jit::Precision::mixed, jit::Precision::f32);
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> place(-0.02, 0.02);
    std::vector<std::filesystem::path> files = test::texture_files();
    // Sums octaves, whichever part of the files is tried.
    files.push_back(test::project_path("examples/textures/rock.haptel"));
    size_t in_another_order = 0;
    for (const std::filesystem::path& file : files) {
        jit::TextureOptions options;
        options.precision = precision;
        options.iterations_in_lanes = true;
        const jit::CompiledTextures lanes = jit::compile_texture_file(file, options);
        options.iterations_in_lanes = false;
        options.effort = jit::Effort::draft; // soonest, and of the same bits
        const jit::CompiledTextures serial = jit::compile_texture_file(file, options);
        REQUIRE((lanes.program && serial.program));
        for (size_t i = 0; i < lanes.program->textures().size(); ++i) {
            const haptel_texture& texture = lanes.program->textures()[i];
            INFO(file << " " << texture.name);
            const TextureResult bound =
                jit::make_binding(lanes.program, texture.name, test::request_over(0.04), jit::For::figures);
            REQUIRE(bound.binding);
            size_t unequal = 0, differs = 0;
            double largest = 0, off = 0;
            for (int k = 0; k < 300; ++k) {
                const haptel_point point{
                    {place(random), place(random), place(random)}, {0, 0, 1}, {}, 0, {}, {}, {}, 0, 0, {}, {}, 0};
                haptel_sample both{}, height{}, in_order{};
                texture.height_gradient(&point, bound.binding->block, &both);
                texture.height(&point, bound.binding->block, &height);
                serial.program->textures()[i].height_gradient(&point, bound.binding->block, &in_order);
                unequal += !test::same(both.height_m, height.height_m);
                differs += !test::same(both.height_m, in_order.height_m);
                largest = std::max(largest, std::fabs(in_order.height_m));
                off = std::max(off, std::fabs(both.height_m - in_order.height_m));
            }
            CHECK(unequal == 0);
            CHECK(off <= (precision == jit::Precision::f64 ? 4e-15 : 2e-6) * largest);
            in_another_order += differs > 0;
        }
    }
    CHECK(5 * in_another_order >= files.size());
}

// Bits, not numbers: no sum here is exact, so that any other order of operations would show.
TEST_CASE("a draft, which has no lanes, gives the bits of lanes", "[code]")
{
    const jit::Precision precision = GENERATE(jit::Precision::f64, jit::Precision::mixed);
    std::vector<std::string> texts, files;
    for (const Case& one : cases()) texts.push_back(source(one.body));
    for (const char* body : {
             "float s = 0.1; float f = 1.3; float a = 0.3; float b = 2.0; for (int i = 0; i < min(n, 40); ++i) "
             "{ s += sin(p.x * f) * a - b; f *= 1.07; a += 0.13; b = b - 0.77; } return s;",
             "float s = p.x; float t = 0.3; float w = 0.9; for (int i = 0; i < min(n, 40); ++i) { if (i % 3 == 1) "
             "{ s += p.y * w; s += 0.2; } else { t -= exp(w * p.z) / 3.0; } w = 0.31; } return s * t;",
             "float s = 0.0; float f = 1.0; for (int i = 0; i < min(n, 20); ++i) { s += sum(p, 0.3) * f; f *= 0.8; } "
             "return s;",
             "float s = 0.0; float f = 1.0; for (int i = 0; i < min(n, 20); ++i) { s += sum(p * f, f); f *= 0.8; } "
             "return s + sum(p, 0.1);",
             "float s = 0.0; float f = 1.0; for (int i = 0; i < min(n, 20); ++i) { s += fbm(p * f, 5); f *= 0.8; } "
             "return s + fbm(p, 9);",
             "float s = 0.0; float f = 1.0; for (int i = 0; i < min(n, 20); ++i) { s += fbm(p, 5) / f; f *= 0.8; } "
             "return s;",
             "float s = 0.0; for (int j = 0; j < 3; ++j) { float t = 0.0; float f = s + 0.1; for (int i = 0; i < "
             "min(n, 20); ++i) { t += p.x * f; f *= 0.7; } s = s * t + sin(t); } return s;",
         })
        texts.push_back(source(body));
    for (const std::filesystem::path& file : test::texture_files()) files.push_back(file);

    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> place(-3, 3);
    const size_t text_count = texts.size();
    texts.insert(texts.end(), files.begin(), files.end());
    // Some where it is slow to compile them, or where an instruction set is chosen, as of the files.
    const size_t step = test::is_sanitized ? 15 : std::getenv("HAPTEL_ISA") ? 4 : 1;
    for (size_t t = 0; t < texts.size(); t += step) {
        const bool has_n = t < text_count; // else a file
        if (!has_n && precision != jit::Precision::f64) continue;
        const auto compile = [&](const jit::TextureOptions& options) {
            return has_n ? jit::compile_texture(texts[t], options) : jit::compile_texture_file(texts[t], options);
        };
        INFO(texts[t]);
        jit::TextureOptions options;
        options.precision = precision;
        options.iterations_in_lanes = true;
        options.kernels = false;
        options.effort = jit::Effort::quick;
        const jit::CompiledTextures lanes = compile(options);
        REQUIRE(lanes.program);
        options.effort = jit::Effort::draft;
        for (const bool kernels : {false, true}) {
            if (!has_n && !kernels) continue;
            options.kernels = kernels;
            const jit::CompiledTextures draft = compile(options);
            REQUIRE(draft.program);
            for (size_t i = 0; i < lanes.program->textures().size(); ++i) {
                const haptel_texture &a = lanes.program->textures()[i], &b = draft.program->textures()[i];
                for (const int n : {0, 1, 3, 8, 9, 16, 20, 40}) {
                    TextureRequest request = test::request_over(6);
                    if (has_n) request.parameters = {{"n", std::to_string(n)}};
                    if (n > 0 && !has_n) continue;
                    const TextureResult bound = jit::make_binding(lanes.program, a.name, request, jit::For::figures);
                    INFO(a.name << ", n " << n << "\n" << bound.diagnostics);
                    REQUIRE(bound.binding);
                    size_t unequal = 0;
                    for (int k = 0; k < 20; ++k) {
                        const double scale = k < 10 ? 1 : 0.01;
                        const haptel_point point{{scale * place(random), scale * place(random), place(random)},
                                                 {0, 0, 1},
                                                 {},
                                                 0,
                                                 {},
                                                 {},
                                                 {},
                                                 0,
                                                 0,
                                                 {},
                                                 {},
                                                 0};
                        haptel_sample of_lanes{}, of_draft{};
                        a.height_gradient(&point, bound.binding->block, &of_lanes);
                        b.height_gradient(&point, bound.binding->block, &of_draft);
                        unequal += std::memcmp(&of_lanes, &of_draft, sizeof of_lanes) != 0;
                    }
                    CHECK(unequal == 0);
                }
            }
        }
    }
}
