#include "tests/fuzz/random_expression.h"

namespace haptel::fuzz {

const char* type_of(Kind kind)
{
    switch (kind) {
    case Kind::real: return "float";
    case Kind::whole: return "int";
    case Kind::word: return "uint";
    case Kind::truth: return "bool";
    case Kind::vec2: return "vec2";
    case Kind::vec3: return "vec3";
    case Kind::vec4: return "vec4";
    case Kind::mat2: return "mat2";
    case Kind::mat3: return "mat3";
    case Kind::cell: return "ivec3";
    case Kind::words: return "uvec2";
    case Kind::truths: return "bvec2";
    }
    return "";
}

namespace {

Kind vector_of(int size)
{
    return size == 2 ? Kind::vec2 : size == 3 ? Kind::vec3 : Kind::vec4;
}

} // namespace

const Variable* ExpressionWriter::any_variable(const std::function<bool(const Variable&)>& fits)
{
    for (int attempt = 0; attempt < 10 && !scope.empty(); ++attempt) {
        const Variable& one = scope[below(scope.size())];
        if (fits(one)) return &one;
    }
    return nullptr;
}

const Callable* ExpressionWriter::any_callable(Shape shape)
{
    for (int attempt = 0; attempt < 4 && !callables.empty(); ++attempt) {
        const Callable& one = callables[below(callables.size())];
        if (one.shape == shape) return &one;
    }
    return nullptr;
}

std::string ExpressionWriter::variable_or(Kind kind, const std::function<std::string()>& other)
{
    const Variable* const one = any_variable([&](const Variable& variable) { return variable.kind == kind; });
    return one ? one->name : other();
}

std::string ExpressionWriter::number()
{
    return one_of({"0.5", "-1.5", "2.0", "0.1", "3.0", "-0.7", "0.0", "-0.0", "1.0", "0.333", "-2.25", "7.5",
                   "(3mm / 2mm)", "(90deg / 1rad)", ".25", "1e-3"});
}

std::string ExpressionWriter::whole_number()
{
    return one_of({"0", "1", "2", "5", "(-3)", "17", "100", "2147483647", "(-2147483648)", "(-1)", "0x55AA"});
}

std::string ExpressionWriter::of(Kind kind, int depth)
{
    switch (kind) {
    case Kind::real: return real(depth);
    case Kind::whole: return whole(depth);
    case Kind::word: return word(depth);
    case Kind::truth: return truth(depth);
    case Kind::vec2: return vector(2, depth);
    case Kind::vec3: return vector(3, depth);
    case Kind::vec4: return vector(4, depth);
    case Kind::mat2: return matrix(2, depth);
    case Kind::mat3: return matrix(3, depth);
    case Kind::cell: return cell(depth);
    case Kind::words: return words(depth);
    case Kind::truths: return truths(depth);
    }
    return "";
}

std::string ExpressionWriter::choice(Kind kind, int depth)
{
    return "(" + truth(depth - 1) + " ? " + of(kind, depth - 1) + " : " + of(kind, depth - 1) + ")";
}

std::string ExpressionWriter::reals(int size, int depth)
{
    std::string list = real(depth);
    while (--size > 0) list += ", " + real(depth);
    return list;
}

std::string ExpressionWriter::swizzle(int from, int size)
{
    const std::string letters = one_of({"xyzw", "rgba", "stpq"});
    std::string text = ".";
    for (int i = 0; i < size; ++i) text += letters[below(static_cast<uint64_t>(from))];
    return text;
}

std::string ExpressionWriter::tame(int depth)
{
    const std::string inner = real(depth - 1);
    return one_of({"sin(" + inner + ")", "tanh(" + inner + ")", "clamp(" + inner + ", -1.5, 2.0)",
                   "fract(" + inner + ")", "(" + inner + ")", "+(" + inner + ")"});
}

std::string ExpressionWriter::real(int depth)
{
    if (depth <= 0) return below(4) ? variable_or(Kind::real, [&] { return number(); }) : number();
    const auto a = [&] { return real(depth - 1); };
    switch (below(26)) {
    case 0:
    case 1: return "(" + a() + " + " + a() + ")";
    case 2:
    case 3: return "(" + a() + " - " + a() + ")";
    case 4:
    case 5: return "(" + a() + " * " + a() + ")";
    case 6: return "(" + a() + " / (1.25 + abs(" + a() + ")))";
    // By whole numbers, which may be 0: close to 0 rounding would be all that is left.
    case 7: return "(" + a() + one_of({" / floor(", " / round(2.5 * ", " / sign("}) + a() + "))";
    case 8: return one_of({"sin(", "cos(", "tanh(", "atan(", "sinturn(", "costurn(", "asinh("}) + a() + ")";
    case 9: return "exp(-abs(" + a() + "))";
    case 10:
        return one_of(
                   {"sqrt(abs(", "log(0.5 + abs(", "log2(1.0 + abs(", "inversesqrt(0.3 + abs(", "acosh(1.5 + abs("}) +
               a() + "))";
    case 11: return "pow(0.2 + abs(" + tame(depth) + "), " + one_of({"0.5", "2.0", "-1.5", "3.0", tame(depth)}) + ")";
    case 12: return one_of({"asin(", "acos(", "atanh("}) + "0.9 * sin(" + a() + "))";
    case 13: return one_of({"min(", "max("}) + a() + ", " + a() + ")";
    case 14: return "clamp(" + a() + ", -0.5, " + one_of({"1.5", "2.0"}) + ")";
    case 15: return "mix(" + a() + ", " + a() + ", " + tame(depth) + ")";
    case 16: return "smoothstep(-0.75, 1.25, " + a() + ")";
    case 17:
        return one_of({"abs(", "fract(", "floor(", "round(", "sign(", "ceil(", "trunc(", "detach(", "-("}) + a() + ")";
    case 18: return "mod(" + a() + ", " + one_of({"1.5", "0.7", "-2.0"}) + ")";
    case 19: return "atan(" + a() + ", " + a() + ")";
    case 20: return choice(Kind::real, depth);
    case 21:
        if (below(2)) return "R[" + index(2, depth) + "][" + index(3, depth) + "]";
        return "T[" + index(4, depth) + "]";
    case 22: return one_of({"float(", "1e-3 * float(", "sin("}) + "(" + whole(depth - 1) + ") & 15)";
    case 23: return "fma(" + a() + ", " + a() + ", " + a() + ")";
    case 24: return real_of_calls(depth);
    default: return real_of_parts(depth);
    }
}

std::string ExpressionWriter::real_of_parts(int depth)
{
    const int size = 2 + static_cast<int>(below(3));
    const std::string v = vector(size, depth - 1), w = vector(size, depth - 1);
    switch (below(11)) {
    case 8: return "dot(" + cell(depth - 1) + " & 15, " + vector(3, depth - 1) + ")";
    case 9: return "half_of(" + v + swizzle(size, 1) + ", " + number() + ")";
    case 0: return "length(" + v + ")";
    case 1: return "dot(" + v + ", " + w + ")";
    case 2: return "distance(" + v + ", " + w + ")";
    case 3: return "determinant(" + matrix(2 + static_cast<int>(below(2)), depth - 1) + ")";
    case 4: return "(" + v + ")[" + index(size, depth) + "]";
    case 5: return "float[3](" + reals(3, depth - 1) + ")[" + index(3, depth) + "]";
    case 6: return "(" + matrix(3, depth - 1) + ")[" + index(3, depth) + "][" + index(3, depth) + "]";
    case 7: return "V[" + index(3, depth) + "]" + swizzle(2, 1);
    default: return "(" + v + ")" + swizzle(size, 3) + swizzle(3, 1);
    }
}

std::string ExpressionWriter::real_of_calls(int depth)
{
    if (const Callable* const two = any_callable(Shape::of_two)) {
        const std::string x = tame(depth), y = tame(depth);
        switch (below(6)) {
        case 4:
            return one_of({"by_one(", "slope_of("}) + two->name + one_of({"(_, " + y + ")", "(" + y + ", _)"}) + ", " +
                   x + ")";
        case 5: // of what is bound itself, and of what is built in
            return one_of({"by_one(by_one(" + two->name + "(_, " + y + "), _)", "slope_of(by_two(" + two->name + ", _)",
                           "by_two(clamp(_, -0.5, _)", "by_one(mix(" + y + ", _, 0.25)"}) +
                   ", " + x + ")";
        case 0: return "grad(" + two->name + ")(" + x + ", " + y + ")";
        case 1: return "by_two(" + two->name + ", " + x + ")";
        default: return two->name + "(" + x + ", " + y + ")";
        }
    }
    if (const Callable* const field = any_callable(Shape::field)) {
        const std::string v = vector(3, depth - 1);
        switch (below(8)) {
        case 0: return "over(" + field->name + ", " + v + ")";
        case 1: return "across(" + field->name + ", " + v + ")";
        case 2: return "across(length, " + vector(2, depth - 1) + ")";
        default: return field->name + "(" + v + ")";
        }
    }
    if (const Callable* const list = any_callable(Shape::of_array))
        return list->name + "(float[3](" + reals(3, depth - 1) + "), " + truth(depth - 1) + ")";
    return tame(depth);
}

// Constants among them lie inside, as the language wants; what depends on the point may be anything.
std::string ExpressionWriter::index(int size, int depth)
{
    return one_of({"int(9.0 * n.x)", "int(" + real(depth - 1) + " + 4.0 * n.y)",
                   std::to_string(size == 4 ? 3 : 1) + " & " + whole(depth - 1), "uint(7.0 * n.z)"});
}

std::string ExpressionWriter::whole(int depth)
{
    if (depth <= 0) return below(4) ? variable_or(Kind::whole, [&] { return whole_number(); }) : whole_number();
    const auto a = [&] { return whole(depth - 1); };
    switch (below(13)) {
    case 11: return "(" + cell(depth - 1) + ")" + swizzle(3, 1);
    case 12: return "C[" + index(2, depth) + "][" + index(3, depth) + "]";
    case 8: return choice(Kind::whole, depth);
    case 9: return below(2) ? "clamp(" + a() + ", -5, " + one_of({"3", "90"}) + ")" : "int(" + truth(depth - 1) + ")";
    case 0: return "(" + a() + one_of({" + ", " - ", " * "}) + a() + ")";
    case 1: return "(" + a() + one_of({" / ", " % "}) + a() + ")";
    case 2: return "(" + a() + one_of({" & ", " | ", " ^ "}) + a() + ")";
    case 3: return "(" + a() + one_of({" << ", " >> "}) + a() + ")";
    case 4: return one_of({"min(", "max("}) + a() + ", " + a() + ")";
    case 5: return one_of({"abs(", "~(", "sign(", "-("}) + a() + ")";
    case 6: return "int(" + one_of({"3.0 * ", "1e9 * ", ""}) + real(depth - 1) + ")";
    case 7: return below(2) ? "P[" + index(2, depth) + "][" + index(2, depth) + "]" : "W[" + index(4, depth) + "]";
    default:
        if (const Callable* const one = any_callable(Shape::of_ints))
            return one->name + "(" + a() + ", " + word(depth - 1) + ")";
        return "int(" + word(depth - 1) + ")";
    }
}

std::string ExpressionWriter::word(int depth)
{
    if (depth <= 0)
        return below(4) ? variable_or(Kind::word, [] { return std::string("9u"); })
                        : one_of({"0u", "3u", "4294967295u", "0xffu"});
    const auto a = [&] { return word(depth - 1); };
    switch (below(9)) {
    case 7: return "(" + words(depth - 1) + ")" + swizzle(2, 1);
    case 4: return choice(Kind::word, depth);
    case 5: return one_of({"min(", "max("}) + a() + ", " + a() + ")";
    case 6: return below(2) ? "U[" + index(3, depth) + "]" : "~" + a();
    case 0: return "(" + a() + one_of({" + ", " - ", " * "}) + a() + ")";
    case 1: return "(" + a() + one_of({" / ", " % ", " >> ", " << "}) + a() + ")";
    case 2: return "(" + a() + one_of({" & ", " | ", " ^ "}) + a() + ")";
    case 3: return "uint(" + whole(depth - 1) + ")";
    default: return "uint(" + real(depth - 1) + ")";
    }
}

std::string ExpressionWriter::truth(int depth)
{
    if (depth <= 0)
        return below(2) ? variable_or(Kind::truth, [&] { return truth(1); })
                        : variable_or(Kind::real, [&] { return number(); }) + one_of({" < ", " > "}) + number();
    switch (below(13)) {
    case 10: return one_of({"any(", "all("}) + truths(depth - 1) + ")";
    case 11: return "(" + cell(depth - 1) + one_of({" == ", " != "}) + cell(depth - 1) + ")";
    case 0: return "(" + truth(depth - 1) + one_of({" && ", " || ", " ^^ ", " == ", " != "}) + truth(depth - 1) + ")";
    case 1: return "!(" + truth(depth - 1) + ")";
    case 2:
        return "(" + whole(depth - 1) + one_of({" < ", " <= ", " > ", " >= ", " == ", " != "}) + whole(depth - 1) + ")";
    case 3:
        return "(" + word(depth - 1) + one_of({" < ", " <= ", " > ", " >= ", " == ", " != "}) + word(depth - 1) + ")";
    case 4: return choice(Kind::truth, depth);
    case 5:
        return one_of({"true", "false", "(M[" + index(2, depth) + "] == mat2(2.0))", "bool(" + whole(depth - 1) + ")"});
    case 6:
        if (const Callable* const test = any_callable(Shape::test)) return test->name + "(" + real(depth - 1) + ")";
        return "(" + vector(2, depth - 1) + one_of({" == ", " != "}) + vector(2, depth - 1) + ")";
    default: return "(" + real(depth - 1) + one_of({" < ", " <= ", " > ", " >= "}) + real(depth - 1) + ")";
    }
}

std::string ExpressionWriter::vector(int size, int depth)
{
    const Kind kind = vector_of(size);
    const std::string type = type_of(kind);
    if (depth <= 0) return variable_or(kind, [&] { return type + "(" + number() + ")"; });
    const auto v = [&] { return vector(size, depth - 1); };
    switch (below(14)) {
    case 12:
        if (size == 2) return "mix(" + v() + ", " + v() + ", " + truths(depth - 1) + ")";
        return size == 3 ? "(" + v() + " - (" + cell(depth - 1) + " & 7))"
                         : "vec4(" + words(depth - 1) + " % 9u, 1, 2)";
    case 0: return type + "(" + reals(size, depth - 1) + ")";
    case 1: return "(" + v() + one_of({" + ", " - ", " * "}) + v() + ")";
    case 2: return "(" + v() + " * " + tame(depth) + ")";
    case 3: return one_of({"sin(", "abs(", "fract(", "tanh(", "floor(", "-("}) + v() + ")";
    case 4: return "normalize(" + v() + ")";
    case 5: return one_of({"min(", "max(", "reflect("}) + v() + ", " + v() + ")";
    case 6: {
        const int from = 2 + static_cast<int>(below(3));
        return "(" + vector(from, depth - 1) + ")" + swizzle(from, size);
    }
    case 7:
        if (size == 3 && below(2)) return "cross(" + v() + ", " + v() + ")";
        if (size == 4) return "vec4(" + vector(2, depth - 1) + ", " + vector(2, depth - 1) + ")";
        if (below(2)) return "(" + v() + " * " + matrix(size, depth - 1) + ")";
        return "(" + matrix(size, depth - 1) + " * " + v() + ")";
    case 8: // field: 3 components, map: 2
        if (const Callable* const one = size == 4 ? nullptr : any_callable(size == 3 ? Shape::field : Shape::map))
            return (size == 3 ? "grad(" + one->name + ")(" : one->name + "(") + v() + ")";
        return v();
    case 9: return choice(kind, depth);
    case 10:
        if (size < 4) return "(" + matrix(size, depth - 1) + ")[" + index(size, depth) + "]";
        return "vec4(" + vector(3, depth - 1) + ", " + real(depth - 1) + ")";
    case 11: return one_of({"clamp(" + v() + ", -0.5, 1.5)", "step(0.25, " + v() + ")", "mod(" + v() + ", 1.5)"});
    default: return "mix(" + v() + ", " + v() + ", " + tame(depth) + ")";
    }
}

std::string ExpressionWriter::cell(int depth)
{
    if (depth <= 0) return variable_or(Kind::cell, [&] { return "ivec3(" + whole_number() + ")"; });
    const auto a = [&] { return cell(depth - 1); };
    switch (below(9)) {
    case 0: return "ivec3(" + whole(depth - 1) + ", " + whole(depth - 1) + ", " + whole(depth - 1) + ")";
    case 1: return "ivec3(" + vector(3, depth - 1) + ")";
    case 2: return "(" + a() + one_of({" + ", " - ", " * ", " / ", " % ", " & ", " | ", " ^ "}) + a() + ")";
    case 3: return "(" + a() + one_of({" + ", " * ", " & "}) + whole(depth - 1) + ")";
    case 4: return "(" + a() + one_of({" << ", " >> "}) + one_of({a(), word(depth - 1), "3"}) + ")";
    case 5: return one_of({"abs(", "sign(", "-(", "~("}) + a() + ")";
    case 6: return one_of({"min(", "max("}) + a() + ", " + one_of({a(), "5"}) + ")";
    case 7: return choice(Kind::cell, depth);
    default: return "(" + a() + ")" + swizzle(3, 3);
    }
}

std::string ExpressionWriter::words(int depth)
{
    if (depth <= 0) return variable_or(Kind::words, [&] { return "uvec2(" + word(0) + ", 7)"; });
    const auto a = [&] { return words(depth - 1); };
    switch (below(6)) {
    case 0: return "uvec2(" + word(depth - 1) + ", " + word(depth - 1) + ")";
    case 1: return "uvec2(" + cell(depth - 1) + swizzle(3, 2) + ")";
    case 2: return "(" + a() + one_of({" + ", " * ", " / ", " % ", " ^ "}) + a() + ")";
    case 3: return "(" + a() + one_of({" * 1664525", " >> 16", " ^ 9u", " << 1u"}) + ")";
    case 4: return "clamp(" + a() + ", 1u, " + word(depth - 1) + ")";
    default: return "(" + a() + ")" + swizzle(2, 2);
    }
}

std::string ExpressionWriter::truths(int depth)
{
    if (depth <= 0) return variable_or(Kind::truths, [&] { return "bvec2(" + truth(0) + ", false)"; });
    switch (below(5)) {
    case 0: return "bvec2(" + truth(depth - 1) + ", " + truth(depth - 1) + ")";
    case 1:
        return one_of({"lessThan(", "greaterThanEqual(", "notEqual("}) + vector(2, depth - 1) + ", " +
               vector(2, depth - 1) + ")";
    case 2:
        return one_of({"lessThanEqual(", "greaterThan(", "equal("}) + words(depth - 1) + ", " + words(depth - 1) + ")";
    case 3: return "not(" + truths(depth - 1) + ")";
    default: return "lessThan(" + cell(depth - 1) + ".xy, ivec2(" + whole(depth - 1) + "))";
    }
}

std::string ExpressionWriter::matrix(int size, int depth)
{
    const Kind kind = size == 2 ? Kind::mat2 : Kind::mat3;
    const std::string type = type_of(kind);
    if (depth <= 0) return variable_or(kind, [&] { return type + "(" + number() + ")"; });
    const auto m = [&] { return matrix(size, depth - 1); };
    const auto v = [&] { return vector(size, depth - 1); };
    switch (below(9)) {
    case 0: return type + "(" + v() + ", " + v() + (size == 3 ? ", " + v() : "") + ")";
    case 1: return "(" + m() + one_of({" + ", " - ", " * "}) + m() + ")";
    case 2: return "transpose(" + m() + ")";
    case 3: return "outerProduct(" + v() + ", " + v() + ")";
    case 4:
        if (const Callable* const map = any_callable(size == 2 ? Shape::map : Shape::field))
            return (size == 2 ? "grad(" + map->name + ")(" : "grad(grad(" + map->name + "))(") + v() + ")";
        return m();
    case 5: return "matrixCompMult(" + m() + ", " + m() + ")";
    case 6:
        return size == 2 && below(2) ? "M[" + index(2, depth) + "]" : type + "(" + matrix(5 - size, depth - 1) + ")";
    case 7: return choice(kind, depth);
    default: return "(" + m() + " * " + tame(depth) + ")";
    }
}

} // namespace haptel::fuzz
