#include "tests/fuzz/random_statement.h"

namespace haptel::fuzz {

void StatementWriter::statements(int how_many, int depth)
{
    for (; how_many > 0; --how_many) statement(depth);
}

void StatementWriter::body(int depth)
{
    const size_t outer = scope.size();
    ++indent;
    statements(1 + static_cast<int>(below(3)), depth + 1);
    --indent;
    scope.resize(outer);
}

void StatementWriter::statement(int depth)
{
    switch (below(23)) {
    case 20: return record();
    case 21:
    case 22:
        if (depth < 3) return choose(depth);
        break;
    case 11: return call();
    case 12:
        if (loops > 0 && depth > 0) return line("if (" + truth(1) + ") continue;");
        break;
    case 13:
        if (depth < 3 && loops < 2) return turns(depth);
        break;
    case 14: return several();
    case 15:
        if (depth > 0 && below(3) == 0) return line("if (" + truth(1) + ") { return " + returned(1) + "; }");
        break;
    case 0:
    case 1:
        if (depth < 3) return branch(depth);
        break;
    case 2:
    case 3:
        if (depth < 3 && loops < 2) return loop(depth);
        break;
    case 4:
        if (depth < 3) return array();
        break;
    case 5:
    case 6:
    case 7: return assignment();
    case 8:
        if (depth > 0 && below(3) == 0) return line("if (" + truth(1) + ") return " + returned(2) + ";");
        break;
    case 9:
        if (depth < 3) return block(depth);
        break;
    case 10: return late();
    default: break;
    }
    declaration();
}

void StatementWriter::declaration()
{
    const auto kind = static_cast<Kind>(below(kinds));
    const std::string name = fresh(), value = of(kind, 3);
    const bool is_const = below(5) == 0;
    if (!is_const && below(5) == 0) {
        const std::string other = fresh();
        line(std::string(type_of(kind)) + " " + name + " = " + value + ", " + other + " = " + of(kind, 1) + ";");
        scope.push_back({other, kind, true});
    } else {
        line((is_const ? "const " : "") + std::string(type_of(kind)) + " " + name + " = " + value + ";");
    }
    scope.push_back({name, kind, !is_const});
}

// Declared first, then given a value on every path.
void StatementWriter::late()
{
    const auto kind = static_cast<Kind>(below(kinds));
    const std::string name = fresh();
    line(std::string(type_of(kind)) + " " + name + ";");
    line("if (" + truth(2) + ") " + name + " = " + of(kind, 2) + ";");
    line("else if (" + truth(1) + ") { " + name + " = " + of(kind, 1) + "; }");
    line("else " + name + " = " + of(kind, 2) + ";");
    scope.push_back({name, kind, true});
}

void StatementWriter::block(int depth)
{
    line("{;");
    body(depth);
    line("}");
}

void StatementWriter::assignment()
{
    const Variable* const target = any_variable([](const Variable& one) { return one.assignable; });
    if (!target) return declaration();
    const std::string name = target->name;
    switch (target->kind) {
    case Kind::real:
        if (below(8) == 0)
            return line(one_of({"++" + name, name + "--", name + " /= (1.5 + abs(" + tame(2) + "))"}) + ";");
        return line(name + one_of({" = ", " += ", " -= ", " *= "}) + tame(3) + ";");
    case Kind::whole:
        if (below(5) == 0) return line(one_of({"++" + name, name + "++", "--" + name}) + ";");
        return line(name + one_of({" = ", " += ", " -= ", " *= ", " /= ", " ^= ", " <<= ", " %= "}) + whole(2) + ";");
    case Kind::word:
        return line(name + one_of({" = ", " += ", " -= ", " *= ", " >>= ", " |= ", " &= ", " %= "}) + word(2) + ";");
    case Kind::truth: return line(name + " = " + truth(2) + ";");
    case Kind::vec2:
        if (below(4) == 0) return line(name + "[" + index(2, 1) + "] = " + real(2) + ";");
        return line(name + one_of({" = ", " += ", ".yx = ", " /= 2.0 + "}) + vector(2, 2) + ";");
    case Kind::vec3:
        if (below(2)) return line(name + one_of({".xz = ", ".yx += ", ".gb *= "}) + vector(2, 2) + ";");
        return line(name + one_of({" = ", " += ", ".zxy = "}) + vector(3, 2) + ";");
    case Kind::vec4: return line(name + one_of({".wx = ", ".st -= ", ".br *= "}) + vector(2, 2) + ";");
    case Kind::mat2: return line(name + "[" + index(2, 1) + "] = " + vector(2, 2) + ";");
    case Kind::mat3:
        if (below(2)) return line(name + " *= " + tame(2) + ";");
        return line(name + "[" + std::to_string(below(3)) + "][" + index(3, 1) + "] = " + real(2) + ";");
    case Kind::cell:
        if (below(3) == 0) return line(name + one_of({".zx = ", ".xy -= ", ".zy ^= "}) + cell(1) + swizzle(3, 2) + ";");
        return line(name + one_of({" = ", " += ", " *= ", " >>= ", " %= "}) + cell(2) + ";");
    case Kind::words: return line(name + one_of({" = ", " ^= ", ".yx += "}) + words(2) + ";");
    case Kind::truths: return line(name + one_of({" = ", ".yx = "}) + truths(2) + ";");
    }
}

void StatementWriter::branch(int depth)
{
    line("if (" + truth(2) + ") {");
    body(depth);
    if (below(3) == 0) {
        line("} else if (" + truth(1) + ") {");
        body(depth);
    }
    if (below(2)) {
        line("} else {");
        body(depth);
    }
    line("}");
}

void StatementWriter::choose(int depth)
{
    const bool is_word = below(4) == 0;
    line("switch (" + (is_word ? word(2) + " % 5" : one_of({whole(2), whole(1) + " & 3", "int(" + index(4, 2) + ")"})) +
         ") {");
    const auto one_case = [&](const std::string& labels, bool is_last) {
        line(labels);
        if (below(4) == 0) line("    if (" + truth(1) + ") break;");
        body(depth);
        if (!is_last || below(2)) line(below(6) ? "    break;" : "    return " + returned(1) + ";");
    };
    const bool has_default = below(3) > 0, is_default_first = has_default && below(3) == 0;
    if (is_default_first) one_case(below(2) ? "default:" : "case 7: default:", false);
    one_case("case 0:", false);
    one_case(is_word ? "case 1: case 2u:" : "case 1: case FEW: case -1:", !has_default || is_default_first);
    if (has_default && !is_default_first) one_case("default:", true);
    line("}");
}

// A struct, whose members are variables like others.
void StatementWriter::record()
{
    const std::string name = fresh(), mark = fresh();
    line("Pair " + name + " = pair(" +
         one_of({"MARKS[" + index(2, 1) + "]",
                 "Mark(" + cell(1) + ", " + truth(1) + ", " + vector(2, 1) + ", " + word(1) + ")",
                 "(" + truth(1) + " ? MARKS[0] : MARKS[1])"}) +
         ", " + tame(2) + ");");
    line("Mark " + mark + ";");
    if (below(2)) {
        line("swap(" + name + ", " + mark + ");");
    } else {
        line(mark + ".c = " + cell(1) + ";");
        line(mark + ".v.x = " + tame(1) + ";");
        line(mark + ".v.y = " + tame(1) + ";");
        line(mark + ".t = " + name + ".mark " + one_of({"==", "!="}) + " MARKS[" + index(2, 1) + "];");
        line(mark + ".u = " + name + ".mark.u;");
    }
    if (below(2)) line(name + ".w[" + index(2, 1) + "] = " + tame(1) + ";");
    if (below(3) == 0) line(name + ".mark = " + mark + ";");
    scope.push_back({name + ".r", Kind::real, true});
    scope.push_back({name + ".w[1]", Kind::real, true});
    scope.push_back({name + ".mark.c", Kind::cell, true});
    scope.push_back({name + ".mark.v", Kind::vec2, true});
    scope.push_back({mark + ".t", Kind::truth, true});
    scope.push_back({mark + ".u", Kind::word, true});
}

// Between -1 and 5 for certain, from what the body of no loop changes.
std::string StatementWriter::small()
{
    return below(2) ? std::to_string(below(6)) : few[below(few.size())];
}

// A start or bound from -2 to 10: a small number, a sum of two, or a variable of its own that is held between.
std::string StatementWriter::end_of_loop()
{
    switch (below(4)) {
    case 0: return small() + " + " + small();
    case 1: {
        const std::string own = fresh(); // in no scope: the body leaves it alone
        line("int " + own + " = " + whole(2) + ";");
        return one_of({"clamp(" + own + ", -2, 4)", "min(max(" + own + ", 0), 4)", "(" + own + " & 3)"});
    }
    default: return small();
    }
}

void StatementWriter::loop(int depth)
{
    const bool is_odd_here = is_odd && below(3) > 0, is_word = !is_odd_here && below(4) == 0, up = below(3) > 0;
    const std::string counter = fresh();
    const auto end = [&] { return is_word ? "uint(clamp(" + end_of_loop() + ", 0, 9))" : end_of_loop(); };
    std::string start = end(), bound = end();
    if (!is_word && below(5) == 0) { // each held on its own side only
        const std::string first = fresh(), last = fresh();
        line("int " + first + " = " + whole(2) + ", " + last + " = " + whole(2) + ";");
        start = (up ? "max(" : "min(") + first + (up ? ", -2)" : ", 4)");
        bound = (up ? "min(" : "max(") + last + (up ? ", 4)" : ", -2)");
    }
    std::string step = up ? one_of({"++" + counter, counter + "++", counter + " += 2", counter + " += FEW"})
                          : one_of({"--" + counter, counter + "--", counter + " -= 2"});
    if (is_word && step.ends_with("FEW")) step = counter + " += 2u";
    scope.push_back({counter, Kind::whole, false});
    if (is_odd_here) { // what is refused must be told, whatever stands there
        if (below(2)) bound = one_of({counter + " + 2", "10 - " + counter, "min(" + whole(1) + ", 4)", whole(2)});
        if (below(4) == 0) step = counter + " += " + one_of({counter, whole(1)});
        if (below(4) == 0) start = whole(1);
    }
    const std::string compare = up ? one_of({" < ", " <= "}) : one_of({" > ", " >= "});
    const std::string mirrored = compare == " < "    ? " > "
                                 : compare == " <= " ? " >= "
                                 : compare == " > "  ? " < "
                                                     : " <= ";
    const std::string condition = below(4) ? counter + compare + bound : "(" + bound + ")" + mirrored + counter;
    line("for (" + std::string(is_word ? "uint " : "int ") + counter + " = " + start + "; " + condition + "; " + step +
         ") {");
    scope.back().kind = is_word ? Kind::word : Kind::whole;
    const std::vector<std::string> outer_few = few;
    if (!is_word) few.push_back("clamp(" + counter + ", -1, 5)");
    if (!is_word) few.push_back("(FEW - clamp(" + counter + ", 0, 2))");
    ++loops;
    if (below(3) == 0) {
        ++indent;
        line("if (" + truth(1) + ") break;");
        --indent;
    }
    body(depth);
    --loops;
    few = outer_few;
    scope.pop_back();
    line("}");
}

// A loop that counts no whole number.
void StatementWriter::turns(int depth)
{
    const std::string counter = fresh();
    const bool counts = below(2);
    if (counts) {
        line("for (float " + counter + " = -1.0; " + counter + one_of({" < ", " <= "}) + "0.5; " + counter +
             one_of({"++", " += 0.5", " += HALF"}) + ") {");
        scope.push_back({counter, Kind::real, false});
    } else {
        line("/// @bound " + one_of({"3", "FEW", "1 + 1"}));
        line("while (" + truth(2) + ") {");
    }
    ++loops;
    body(depth);
    --loops;
    if (counts) scope.pop_back();
    line("}");
}

// A call that writes its arguments: variables and parts of one.
void StatementWriter::call()
{
    const Callable* const writer = any_callable(Shape::writer);
    if (!writer) return declaration();
    const std::string result_of = fresh(), written = fresh(), cells = fresh();
    const bool in_part = below(2);
    line(in_part ? "vec2 " + written + " = " + vector(2, 1) + ";" : "float " + written + ";");
    line("ivec3 " + cells + "[2] = {" + cell(1) + ", " + cell(1) + "};");
    const std::string arguments = tame(2) + ", " + written + (in_part ? swizzle(2, 1) : "") + ", " + cells + "[" +
                                  index(2, 1) + "]" + (below(2) ? ", " + number() : "");
    if (below(3) == 0)
        line(writer->name + "(" + arguments + ");");
    else
        line("float " + result_of + " = " + tame(1) + " + " + writer->name + "(" + arguments + ");"),
            scope.push_back({result_of, Kind::real, true});
    scope.push_back({written, in_part ? Kind::vec2 : Kind::real, true});
    const std::string one = fresh();
    line("ivec3 " + one + " = " + cells + "[1] ^ " + cells + "[0];");
    scope.push_back({one, Kind::cell, true});
}

// Assignments in a row.
void StatementWriter::several()
{
    const std::string first = fresh(), second = fresh();
    line("float " + first + " = " + number() + ", " + second + ";");
    line(first + one_of({" = ", " += ", " *= "}) + second + " = " + tame(2) + ";");
    scope.push_back({first, Kind::real, true});
    scope.push_back({second, Kind::real, true});
}

// Elements are read back into a variable: expressions need not know of arrays.
void StatementWriter::list(const std::string& name)
{
    const std::string element = fresh();
    line("float " + element + " = " + name + "[" + index(3, 1) + "] + " + name + "[1];");
    scope.push_back({element, Kind::real, true});
}

// Its elements, like those of a list.
void StatementWriter::rows()
{
    const std::string name = fresh(), element = fresh();
    line("float " + name + "[2][3]" +
         one_of({";", " = R;", " = {{" + reals(3, 1) + "}, float[3](" + reals(3, 1) + ")};"}));
    line("for (int i = 0; i < 2; ++i) for (int j = 0; j < 3; ++j) " + name + "[i][j] = " + tame(1) + ";");
    line(name + "[" + index(2, 2) + "][" + index(3, 1) + "]" + one_of({" = ", " += "}) + tame(2) + ";");
    line(name + "[" + index(2, 1) + "] = float[3](" + reals(3, 1) + ");");
    line("float " + element + " = " + name + "[" + index(2, 1) + "][" + index(3, 1) + "] - " + name + "[1][2];");
    scope.push_back({element, Kind::real, true});
}

void StatementWriter::array()
{
    if (below(3) == 0) return rows();
    const std::string name = fresh(), whole_copy = fresh();
    line(one_of({"float " + name + "[3]", "float[3] " + name, "float[] " + name}) + " = {" + real(2) + ", " + real(1) +
         ", " + number() + "};");
    line(name + "[" + index(3, 2) + "]" + one_of({" = ", " += ", " *= "}) + tame(2) + ";");
    line("float " + whole_copy + "[3] = " + name + ";");
    line(whole_copy + "[2] = " + real(1) + ";");
    list(below(2) ? name : whole_copy);
}

} // namespace haptel::fuzz
