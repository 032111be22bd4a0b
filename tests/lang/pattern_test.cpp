// Patterns made of cells: which of them are told to jump, and which do. The truth is each pattern's own, by its closed
// form (patterns.haptel), and what a search along lines finds.
#include "lang/compile.h"
#include "lang/ir/bounds/bounds.h"
#include "lang/ir/run/interpret.h"
#include "tests/support/catch.h"
#include "tests/support/project_path.h"

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

using namespace haptel::lang;
namespace ir = haptel::ir;

namespace {

constexpr double box_m = 0.02; // half a side

std::shared_ptr<const Program> program_of(const std::string& text)
{
    const CompileResult result = compile({"patterns.haptel", text}, {});
    INFO(text << render(result.diagnostics.all(), result.sources));
    REQUIRE(result.program);
    return result.program;
}

ir::Continuity class_of(const ir::Module& module, const ir::Texture& texture)
{
    ir::BoundsBox box;
    for (const ir::Input input : {ir::Input::p_x, ir::Input::p_y})
        box.input[static_cast<size_t>(input)] = {-box_m, box_m};
    for (const ir::Parameter& parameter : texture.parameters)
        box.parameters.push_back({parameter.value, parameter.value});
    return ir::texture_bounds(module, texture, box, 16).continuity;
}

// Of a texture's height along lines: halves each towards where more changes, until two neighbouring numbers are left.
class SearchForJumps {
public:
    SearchForJumps(const ir::Module& module, const ir::Texture& what) : machine(module), texture(what)
    {
        for (const ir::Parameter& parameter : texture.parameters) inputs.parameters.push_back({parameter.value});
    }

    double greatest_jump(uint32_t seed, int lines)
    {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> place(-box_m, box_m), way(-5e-4, 5e-4);
        double greatest = 0;
        for (int line = 0; line < lines; ++line) {
            const double x = place(random), y = place(random), dx = way(random), dy = line % 2 ? way(random) : 0;
            const auto height = [&](double at) { return height_at(x + at * dx, y + at * dy); };
            double from = 0, to = 1;
            double first = height(from), last = height(to);
            for (int i = 0; i < 48; ++i) {
                const double middle = from + (to - from) / 2, between = height(middle);
                const bool is_left = std::fabs(between - first) > std::fabs(last - between);
                (is_left ? to : from) = middle;
                (is_left ? last : first) = between;
            }
            greatest = std::max(greatest, std::fabs(last - first));
        }
        return greatest;
    }

private:
    ir::Interpreter<double> machine;
    const ir::Texture& texture;
    ir::EntryInputs<double> inputs;

    double height_at(double x, double y)
    {
        inputs.input[static_cast<size_t>(ir::Input::p_x)] = x;
        inputs.input[static_cast<size_t>(ir::Input::p_y)] = y;
        return machine.run(texture.body, {}, &inputs)[0].real;
    }
};

// Texts of what authors do with cells, drawn by chance.
class RandomPattern {
public:
    explicit RandomPattern(uint32_t seed) : random(seed) {}

    std::string text()
    {
        return "float hash(vec2 c) { return fract(sin(dot(c, vec2(12.9898, 78.233))) * 437.5453); }\n"
               "float ease(float t) { return t * t * (3.0 - 2.0 * t); }\n"
               "texture t()\n{\n    vec2 q = p.xy / 4mm;\n    vec2 c = " +
               pick({"floor(q)", "round(q)", "floor(q + 0.5)", "vec2(floor(q.x), round(q.y))", "floor(2.0 * q)"}) +
               ";\n    vec2 f = " + pick({"fract(q)", "q - c", "q - round(q)", "mod(q, 2.0) - 1.0", "fract(q) - 0.5"}) +
               ";\n    float k = 0.3;\n    if (" + condition() + ") k = " + value(3) + ";\n    return 1mm * (" +
               value(4) + ");\n}\n";
    }

private:
    std::mt19937 random;

    std::string pick(const std::vector<std::string>& from) { return from[random() % from.size()]; }
    std::string leaf()
    {
        return pick({"f.x", "f.y", "f.x", "f.y", "q.x", "q.y", "c.x", "c.y", "k", "hash(c)", "hash(c + vec2(1.0, 0.0))",
                     "length(f)", "dot(f, f)", "0.5", "1.0", "2.0", "0.3"});
    }
    std::string condition()
    {
        return pick({"mod(c.x, 2.0) < 1.0", "mod(q.y, 2.0) < 1.0", "f.x < f.y", "f.x < 0.5", "int(c.x) % 2 == 0",
                     "f.x > 0.0 && f.y > 0.0", "hash(c) < 0.5", "q.x < q.y"});
    }
    std::string value(int depth)
    {
        if (depth == 0) return leaf();
        const auto of = [&](const char* function) { return std::string(function) + "(" + value(depth - 1) + ")"; };
        const auto both = [&](const char* between) {
            return "(" + value(depth - 1) + between + value(depth - 1) + ")";
        };
        switch (random() % 20) {
        case 0: return of("fract");
        case 1: return of("floor");
        case 2: return of("abs");
        case 3: return of("abs");
        case 4: return of("cos");
        case 5: return of("sinturn");
        case 6: return of("costurn");
        case 7: return "min" + both(", ");
        case 8: return "max" + both(", ");
        case 9: return both(" + ");
        case 10: return both(" - ");
        case 11: return both(" * ");
        case 12: return both(" * ");
        case 13: return "smoothstep(0.0, 0.4, " + value(depth - 1) + ")";
        case 14: return "mix(" + value(depth - 1) + ", " + value(depth - 1) + ", ease(" + pick({"f.x", "f.y"}) + "))";
        case 15: return "(" + condition() + " ? " + value(depth - 1) + " : " + value(depth - 1) + ")";
        case 16: return "mod(" + value(depth - 1) + ", 2.0)";
        case 17: return of("round");
        case 18:
            return pick({"(f.x * (1.0 - f.x))", "abs(f.x)", "abs(f.y - 0.5)", "max(0.4 - length(f), 0.0)"}) + " * " +
                   value(depth - 1);
        default: return leaf();
        }
    }
};

} // namespace

TEST_CASE("patterns: told to jump are those that do, but for those that say so")
{
    std::ifstream file(haptel::test::project_path("tests/lang/patterns.haptel"));
    std::stringstream text;
    text << file.rdbuf();
    const auto program = program_of(text.str());
    REQUIRE(program->module.textures.size() >= 30);
    int jumps = 0, not_seen = 0;
    for (const ir::Texture& texture : program->module.textures) {
        CAPTURE(texture.name);
        const bool does_jump = texture.doc.starts_with("Jumps");
        const bool is_not_seen = texture.doc.starts_with("Continuous, not seen");
        REQUIRE((does_jump || texture.doc.starts_with("Continuous")));
        CHECK((class_of(program->module, texture) <= ir::Continuity::jump) == (does_jump || is_not_seen));
        const double found = SearchForJumps(program->module, texture).greatest_jump(7, 4000);
        CHECK((found > 1e-6) == does_jump); // of heights of 20 um and more
        jumps += does_jump;
        not_seen += is_not_seen;
    }
    CHECK(jumps >= 8);
    CHECK(not_seen <= 3);
}

TEST_CASE("patterns: what is called continuous has no jump, whatever was drawn")
{
    int continuous = 0;
    for (uint32_t seed = 1; seed <= 900; ++seed) {
        const std::string text = RandomPattern(seed).text();
        const auto program = program_of(text);
        const ir::Texture& texture = program->module.textures[0];
        if (class_of(program->module, texture) <= ir::Continuity::jump) continue;
        ++continuous;
        CAPTURE(seed, text);
        CHECK(SearchForJumps(program->module, texture).greatest_jump(seed, 400) < 1e-8); // of heights of some mm
    }
    CHECK(continuous > 100);
}
