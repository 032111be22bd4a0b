#include "tests/fuzz/random_source.h"

#include "tests/fuzz/random_expression.h"

namespace haptel::fuzz {
namespace {

class Writer : public ExpressionWriter {
public:
    using ExpressionWriter::ExpressionWriter;

    std::string program()
    {
        line("const float T[4] = {0.5, -1.25, 2.0, " + number() + "};");
        line("const int W[4] = {3, -7, 2147483647, " + whole_number() + "};");
        line("float by_two(float f(float, float), float x) { return f(x, 0.5) - f(0.25, x); }");
        for (int i = static_cast<int>(below(3)); i > 0; --i) function();
        line("texture t(float a = 0.7 in 0.1 .. 2.0, int k = 3 in 1 .. 5, bool b = true)\n{");
        ++indent;
        line("vec3 q = p / 1m;");
        scope = {{"q", Kind::vec3, true},   {"a", Kind::real, false}, {"k", Kind::whole, false},
                 {"b", Kind::truth, false}, {"n", Kind::vec3, false}, {"uv", Kind::vec2, false}};
        in_texture = true;
        statements(2 + static_cast<int>(below(5)), 0);
        line("return 1m * (" + real(3) + ");");
        --indent;
        line("}");
        return text;
    }

private:
    std::string text;
    int indent = 0, loops = 0;
    bool in_texture = false, in_loop = false;

    void line(const std::string& code) { text += std::string(static_cast<size_t>(indent) * 4, ' ') + code + "\n"; }

    // One of the shapes that expressions know to call.
    void function()
    {
        static const struct {
            Kind result;
            const char *type, *parameters;
            std::vector<Variable> variables;
        } shapes[] = {
            {Kind::real, "float", "float x, float y", {{"x", Kind::real, true}, {"y", Kind::real, true}}},
            {Kind::real, "float", "vec3 v", {{"v", Kind::vec3, true}}},
            {Kind::vec2, "vec2", "vec2 w", {{"w", Kind::vec2, true}}},
            {Kind::whole, "int", "int i, uint j", {{"i", Kind::whole, true}, {"j", Kind::word, true}}},
        };
        const size_t shape = below(std::size(shapes));
        const std::string name = "f" + std::to_string(callables.size());
        line(std::string(shapes[shape].type) + " " + name + "(" + shapes[shape].parameters + ")\n{");
        ++indent;
        scope = shapes[shape].variables;
        statements(static_cast<int>(below(4)), 0);
        line("return " + of(shapes[shape].result, 3) + ";");
        --indent;
        line("}");
        callables.push_back({name, static_cast<Shape>(shape)});
    }

    void statements(int how_many, int depth)
    {
        for (; how_many > 0; --how_many) statement(depth);
    }

    void body(int depth)
    {
        const size_t outer = scope.size();
        ++indent;
        statements(1 + static_cast<int>(below(3)), depth + 1);
        --indent;
        scope.resize(outer);
    }

    void statement(int depth)
    {
        switch (below(12)) {
        case 0:
        case 1:
            if (depth < 3) return branch(depth);
            break;
        case 2:
            if (depth < 3 && loops < 2) return loop(depth);
            break;
        case 3:
            if (depth < 3) return array();
            break;
        case 4:
        case 5:
        case 6: return assignment();
        case 7:
            if (depth > 0 && !in_loop && below(3) == 0 && in_texture)
                return line("if (" + truth(1) + ") return 1m * (" + real(2) + ");");
            break;
        default: break;
        }
        declaration();
    }

    void declaration()
    {
        const auto kind = static_cast<Kind>(below(kinds));
        const std::string name = fresh();
        line(std::string(type_of(kind)) + " " + name + " = " + of(kind, 3) + ";");
        scope.push_back({name, kind, true});
    }

    void assignment()
    {
        const Variable* const target = any_variable([](const Variable& one) { return one.assignable; });
        if (!target) return declaration();
        const std::string name = target->name;
        switch (target->kind) {
        case Kind::real: return line(name + one_of({" = ", " += ", " -= ", " *= "}) + tame(3) + ";");
        case Kind::whole: return line(name + one_of({" = ", " += ", " *= ", " ^= ", " <<= ", " %= "}) + whole(2) + ";");
        case Kind::word: return line(name + one_of({" = ", " += ", " -= ", " >>= ", " |= "}) + word(2) + ";");
        case Kind::truth: return line(name + " = " + truth(2) + ";");
        case Kind::vec2: return line(name + one_of({" = ", " += ", ".yx = "}) + vector(2, 2) + ";");
        case Kind::vec3:
            if (below(2)) return line(name + one_of({".xz = ", ".yx += "}) + vector(2, 2) + ";");
            return line(name + one_of({" = ", " += ", ".zxy = "}) + vector(3, 2) + ";");
        case Kind::mat2: return line(name + "[" + std::to_string(below(2)) + "] = " + vector(2, 2) + ";");
        }
    }

    void branch(int depth)
    {
        line("if (" + truth(2) + ") {");
        body(depth);
        if (below(2)) {
            line("} else {");
            body(depth);
        }
        line("}");
    }

    void loop(int depth)
    {
        const std::string counter = fresh();
        std::string bound = one_of({"4", "3", in_texture ? "k" : "5"});
        if (below(3) == 0) { // a variable of its own, which the body leaves alone
            const std::string turns = fresh();
            line("int " + turns + " = " + whole(2) + ";");
            bound = "min(" + turns + ", 4)";
        }
        line("for (int " + counter + " = 0; " + counter + " < " + bound + "; ++" + counter + ") {");
        scope.push_back({counter, Kind::whole, false});
        const bool outer = std::exchange(in_loop, true);
        ++loops;
        if (below(3) == 0) {
            ++indent;
            line("if (" + truth(1) + ") break;");
            --indent;
        }
        body(depth);
        --loops;
        in_loop = outer;
        scope.pop_back();
        line("}");
    }

    // Elements are read back into a variable: expressions need not know of arrays.
    void array()
    {
        const std::string name = fresh(), element = fresh();
        line("float " + name + "[3] = {" + real(2) + ", " + real(1) + ", " + number() + "};");
        line(name + "[" + index(3, 2) + "] = " + real(2) + ";");
        line("float " + element + " = " + name + "[" + index(3, 1) + "] + " + name + "[1];");
        scope.push_back({element, Kind::real, true});
    }
};

} // namespace

std::string random_source(uint64_t seed)
{
    return Writer(seed).program();
}

} // namespace haptel::fuzz
