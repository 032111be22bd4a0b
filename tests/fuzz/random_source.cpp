#include "tests/fuzz/random_source.h"

#include "tests/fuzz/random_statement.h"

namespace haptel::fuzz {
namespace {

class Writer : public StatementWriter {
public:
    Writer(uint64_t seed, bool odd) : StatementWriter(seed, odd), has_directives(seed % 2 == 1) {}

    std::string program()
    {
        line("const float T[4] = {0.5, -1.25, 2.0, " + number() + "};");
        line("const int W[] = {3, -7, 2147483647, " + whole_number() + ",};");
        line("const uint[3] U = {1u, 4294967295u, 0x10u};");
        line("const vec2 V[3] = {vec2(0.5), vec2(1.0, -2.0), vec2(" + number() + ")};");
        line("const mat2 M[2] = {mat2(0.6, 0.8, -0.8, 0.6), mat2(2.0)};");
        line("const float R[2][3] = {{0.5, " + number() + ", -1.0}, {2.0, 0.25, " + number() + "},};");
        line("const int P[][] = {{1, -2}, {3, " + whole_number() + "}, {0, 7}};");
        line("const float C1 = " + number() + " * 0.5, C2 = 1.0 - " + number() + ";");
        line("const int FEW = 1 + 2;");
        line("const ivec3 C[2] = {ivec3(1, -2, 3), ivec3(2147483647, " + whole_number() + ", 0)};");
        names_of_half();
        line("struct Pair { Mark mark; float r, w[2]; };");
        line("struct Mark { ivec3 c; bool t; vec2 v; uint u; };");
        line("const Mark MARKS[2] = {Mark(C[1], false, V[1], 7u), Mark(ivec3(2), true, vec2(0.5, C1), 1)};");
        line("Pair pair(Mark m, float x) { return Pair(m, x, float[2](0.5 * x, x)); }");
        line("void swap(inout Pair a, out Mark b) { b = a.mark; b.c.zx = a.mark.c.xy; a.r += a.w[1]; }");
        line("float by_two(float f(float, float), float x) { return f(x, 0.5) - f(0.25, x); }");
        line("float by_one(float f(float), float x) { return f(0.5 * x) - 0.25 * f(f(x)); }");
        line("float slope_of(float f(float), float x) { return grad(f)(0.5 - x); }");
        line("float over(float f(vec3), const vec3 v) { return f(v.zxy) - 0.5 * f(v); }");
        line("float across(float f(vecN), const vecN v) { vecN w = vecN(0.5) - v; return f(w) - 0.5 * f(v); }");
        for (int i = static_cast<int>(below(4)); i > 0; --i) function();
        has_output = below(3) == 0;
        line("texture t(float a = 0.7 in 0.1 .. 2.0, int k = 3 in 1 .. 5, bool b = true, uint m = 2 in 0 .. 4,");
        line("    int e = ribbed in {plain, ribbed, dotted}, vec2 s = vec2(0.3, -1.7) in -2.0 .. 2.0,");
        line("    vec3 r = vec3(0.5, 1.5, HALF) in vec3(0.1) .. vec3(1.0, 2.0, 4.0)" +
             std::string(has_output ? ", out float friction_scale)\n{" : ",)\n{"));
        ++indent;
        line("vec3 q = p / 1m;");
        scope = {{"q", Kind::vec3, true},     {"a", Kind::real, false},  {"k", Kind::whole, false},
                 {"b", Kind::truth, false},   {"m", Kind::word, false},  {"n", Kind::vec3, false},
                 {"uv", Kind::vec2, false},   {"C1", Kind::real, false}, {"C2", Kind::real, false},
                 {"FEW", Kind::whole, false}, {"e", Kind::whole, false}, {"dotted", Kind::whole, false},
                 {"s", Kind::vec2, false},    {"r", Kind::vec3, false}};
        few = {"k", "FEW", "int(m)", "k - 1", "e", "dotted - e"};
        if (has_output) {
            line("friction_scale = 1.0 + abs(" + tame(2) + ");");
            scope.push_back({"friction_scale", Kind::real, true});
        }
        in_texture = true;
        statements(2 + static_cast<int>(below(5)), 0);
        line("return " + returned(3) + ";");
        --indent;
        line("}");
        return text;
    }

private:
    const bool has_directives;
    bool has_output = false;

    void names_of_half()
    {
        if (!has_directives) {
            line("const float HALF = 0.5;");
            return line("float half_of(float x, float y) { return HALF * x + HALF * y; }");
        }
        line("#define HALF 0.5");
        line("#define half_of(x, y) \\");
        line("    (HALF * (x) + HALF * (y))");
        line("#ifdef HALF");
        line("#define REAL float");
        line("#else");
        line("nothing (");
        line("#endif");
    }

    // One of the shapes that expressions know to call.
    void function()
    {
        static const struct {
            Kind result;
            const char* parameters;
            std::vector<Variable> variables;
        } shapes[] = {
            {Kind::real, "float x, const in float y", {{"x", Kind::real, true}, {"y", Kind::real, false}}},
            {Kind::real, "vec3 v", {{"v", Kind::vec3, true}}},
            {Kind::vec2, "in vec2 w", {{"w", Kind::vec2, true}}},
            {Kind::whole, "int i, uint j", {{"i", Kind::whole, true}, {"j", Kind::word, true}}},
            {Kind::truth, "float x", {{"x", Kind::real, true}}},
            {Kind::real, "REAL l[3], bool c", {{"c", Kind::truth, true}}},
            {Kind::real,
             "float x, out float y, inout ivec3 c, float z = 0.25 + HALF",
             {{"x", Kind::real, true}, {"y", Kind::real, true}, {"c", Kind::cell, true}, {"z", Kind::real, false}}},
        };
        const size_t shape = below(std::size(shapes));
        const std::string name = "f" + std::to_string(callables.size());
        result = shapes[shape].result;
        std::string parameters = shapes[shape].parameters;
        if (!has_directives && parameters.starts_with("REAL")) parameters.replace(0, 4, "float");
        line(std::string(type_of(result)) + " " + name + "(" + parameters + ")\n{");
        ++indent;
        scope = shapes[shape].variables;
        few = {"2", "FEW", "int(3u)"};
        if (static_cast<Shape>(shape) == Shape::of_array) list("l");
        if (static_cast<Shape>(shape) == Shape::writer) line(one_of({"y = x;", "y = 0.5 * x;"}));
        if (below(2)) scope.push_back({"C2", Kind::real, false});
        statements(static_cast<int>(below(4)), 0);
        line("return " + returned(3) + ";");
        --indent;
        line("}");
        callables.push_back({name, static_cast<Shape>(shape)});
    }
};

} // namespace

std::string random_source(uint64_t seed)
{
    return (seed % 8 == 2 ? "language 1;\n" : "") + Writer(seed, false).program();
}

std::string odd_source(uint64_t seed)
{
    return Writer(seed, true).program();
}

} // namespace haptel::fuzz
