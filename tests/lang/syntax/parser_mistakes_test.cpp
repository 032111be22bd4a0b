// What is badly written: one message per mistake, where it is, with what was expected, and no more.
#include "tests/lang/syntax/tree_text.h"
#include "tests/support/catch.h"

using namespace haptel::lang;

namespace {

// Of a body that starts at line 2, column 1.
std::string in_body(std::string_view text)
{
    return parse_text("float f() {\n" + std::string(text) + "\n}").messages();
}

std::string in_file(std::string_view text)
{
    return parse_text(text).messages();
}

std::string first_hint(std::string_view text)
{
    const Parsed parsed = parse_text(text);
    return parsed.diagnostics.all().empty() ? "" : parsed.diagnostics.all()[0].hint;
}

} // namespace

TEST_CASE("a missing semicolon is reported at the end of its line and mended")
{
    CHECK(in_body("a = 1\nb = 2;") == "2:6 syntax: expected ';' at the end of the statement\n");
    CHECK(in_body("float a = 1\nb = 2 c;") == "2:12 syntax: expected ';' at the end of the declaration\n"
                                              "3:7 syntax: expected ';' at the end of the statement, found 'c'\n");
    CHECK(in_body("return a") == "2:9 syntax: expected ';' at the end of 'return'\n");
    const Parsed parsed = parse_text("import \"oak.haptel\"\n");
    CHECK(parsed.messages() == "1:20 syntax: expected ';' at the end of the import\n");
    REQUIRE(parsed.diagnostics.all().at(0).fix);
    CHECK(parsed.diagnostics.all()[0].fix->replacement == ";");
}

TEST_CASE("a bracket left open names where it was opened")
{
    CHECK(in_body("a = (b + c;") == "2:11 syntax: expected ')' to close '(' at column 5, found ';'\n");
    CHECK(in_body("a = f(b c);") == "2:9 syntax: expected ',' or ')' to close '(' at column 6, found 'c'\n");
    CHECK(in_body("a = f(b,\n c;\nd = 1 1;") == "3:3 syntax: expected ',' or ')' to close '(' at line 2, found ';'\n"
                                                "4:7 syntax: expected ';' at the end of the statement, found '1'\n");
    CHECK(in_body("a = A[1;") == "2:8 syntax: expected ']' to close '[' at column 6, found ';'\n");
    CHECK(in_file("float f() {\n if (a) {\n b = 1;\n}\n") ==
          "5:1 syntax: expected '}' to close '{' at line 1, found the end of the file\n");
    const Parsed parsed = parse_text("float f() {\n a = (b\n;\n}");
    REQUIRE(parsed.diagnostics.all().at(0).related.size() == 1);
    CHECK(parsed.sources.position(0, parsed.diagnostics.all()[0].related[0].span.begin).line == 2);
}

TEST_CASE("a body left open ends where the next texture or function begins")
{
    const Parsed parsed = parse_text(
        "texture a() {\n return 1;\n\ntexture b() { return 2; }\nfloat c(vec3 q) {\n\nfloat d() { return 1.0; }");
    CHECK(parsed.messages() == "4:1-8 syntax: expected '}' to close '{' at line 1, found 'texture'\n"
                               "7:1-6 syntax: expected '}' to close '{' at line 5, found 'float'\n");
    CHECK(parsed.file.textures.size() == 2);
    CHECK(parsed.file.functions.size() == 2);
    CHECK(parsed.file.textures[0].damage.any);
    CHECK_FALSE(parsed.file.textures[1].damage.any);
}

TEST_CASE("expressions that are none")
{
    CHECK(in_body("a = ;") == "2:5 expected-expression: expected an expression, found ';'\n");
    CHECK(in_body("a = b + * c;") ==
          "2:9 no-pointers: expected an expression, found '*'; there are no pointers in Haptel\n");
    CHECK(in_body("a = f(b, , c);") == "2:10 expected-expression: expected an expression, found ','\n");
    CHECK(in_body(") a = 1;") == "2:1 syntax: expected a statement, found ')'\n");
    CHECK(in_body("a = b ? c;") ==
          "2:10 syntax: expected ':' and a value for when the condition is false, found ';'\n");
    CHECK(in_body("a = q.;") == "2:7 syntax: expected a name after '.': components such as x or xyz, found ';'\n");
    CHECK(in_body("a = (b, c);") == "2:7 syntax: expected ')', found ','\n");
    CHECK(in_body("a = {1, 2};") == "2:5 syntax: braces may only stand behind '=' of a constant table\n");
    CHECK(in_body("a = f(x)(y);") == "2:9 not-callable: only a name can be called\n");
}

TEST_CASE("an assignment is a statement")
{
    CHECK(in_body("if (a = b) c = 1;\nd = 1 1;") ==
          "2:7 assignment-in-expression: expected the end of the expression, found '='\n"
          "3:7 syntax: expected ';' at the end of the statement, found '1'\n");
    CHECK(in_body("a = b++;") == "2:6-8 syntax: expected ';' at the end of the statement, found '++'\n");
    CHECK(in_body("a = ++b;") ==
          "2:5-7 assignment-in-expression: '++' is a statement of its own, not part of an expression\n");
}

TEST_CASE("statements that are incomplete")
{
    CHECK(in_body("else a = 1;") == "2:1-5 else-without-if: this 'else' belongs to no 'if'\n");
    CHECK(in_body("if a > b { c = 1; }\nd = 1;") == "2:4 syntax: expected '(' after 'if', found 'a'\n");
    CHECK(in_body("if (a)") == "3:1 syntax: expected a statement after the condition, found '}'\n");
    CHECK(in_body("for (int i : 3) a = 1;\nb = 2;") ==
          "2:12 syntax: expected ';' after the start of the loop, found ':'\n");
    CHECK(in_body("for (int i = 0; i < 3) a = 1;") ==
          "2:22 syntax: expected ';' after the condition of the loop, found ')'\n");
    CHECK(in_body("for (int i = 0; i < 3; i++; j++) a = 1;\nb = 2;") ==
          "2:27 syntax: expected ')' to close '(' at column 5, found ';'\n");
    CHECK(in_body("for (int i = 0, j = 0; i < 3; i++) a = 1;") ==
          "2:17-22 syntax: a loop has one variable, found a second\n");
    CHECK(in_body("for (int i = 0; i < 3; i++, j++) a = 1;") == "2:27 syntax: a loop has one step, found a second\n");
    CHECK(in_body("float = 3;\nfloat 3x;\nfloat texture;") ==
          "2:7 syntax: expected a name after 'float', found '='\n"
          "3:7-9 syntax: expected a name after 'float', found '3x'\n"
          "4:7-14 syntax: expected a name after 'float', found 'texture'\n");
}

TEST_CASE("textures and functions that are incomplete")
{
    CHECK(in_file("texture { }") == "1:9 syntax: expected a name after 'texture', found '{'\n");
    CHECK(in_file("texture t { return 1; }") == "1:9 syntax: expected '(' after the name of the texture\n");
    CHECK(in_file("texture t();") == "1:12 syntax: expected '{' and the body of the texture 't', found ';'\n");
    CHECK(in_file("texture t(float a, float b = 1 in 2,\n int = 3) {}") ==
          "1:17 missing-default: the parameter 'a' needs a default value\n"
          "1:36 range: expected '..' and the upper end of the range, found ','\n"
          "2:6 syntax: expected a name after 'int', found '='\n");
    CHECK(in_file("textur t() { return 1; }") ==
          "1:1-7 syntax: expected 'texture' or the type of a function, found 'textur'\n");
    CHECK(in_file("float g = 1;") == "1:1-6 global-variable: a variable of a whole file is read as a constant\n");
    CHECK(in_file("const float A;") == "1:13 syntax: expected '=' and the value of the constant 'A'\n");
    CHECK(in_file("float f(float a = ) { return a; }") ==
          "1:19 expected-expression: expected an expression, found ')'\n");
    CHECK(in_file("float f(out) { return a; }").starts_with("1:12 syntax: expected a name of a type, found ')'"));
    CHECK(in_file("float f(float a, b) { return a; }") == "1:19 syntax: expected a name after 'b', found ')'\n");
    CHECK(in_file("float grad(float a) { return a; }") == "");
    CHECK(in_file("float f(float a);\n") ==
          "1:1-18 prototype: functions may stand in any order: a prototype does nothing\n");
    CHECK(in_file("import 3;\nimport wood.;") == "1:8 import: expected a path in quotes, or a file of a library, after "
                                                 "'import', found '3'\n"
                                                 "2:8-12 import: expected a path in quotes, or a file of a library, "
                                                 "after 'import', found 'wood'\n");
    CHECK(in_file("a = 3;\ntexture t() { return 1 1; }") ==
          "1:1 syntax: expected a texture, function, constant, struct or import, found 'a'\n"
          "2:24 syntax: expected ';' at the end of 'return', found '1'\n");
    CHECK(in_file("} float f() {}") ==
          "1:1 syntax: expected a texture, function, constant, struct or import, found '}'\n");
}

TEST_CASE("facts that cannot be read")
{
    CHECK(in_file("/// @facts value 1, slop 2\nfloat f() {}") ==
          "1:19 syntax: expected '..' between least and greatest value, found ','\n");
    CHECK(in_file("/// @facts slop 2\nfloat f() {}") ==
          "1:5-18 facts: expected value, slope, curvature or class in the facts\n");
    CHECK(in_file("/// @facts class C7\nfloat f() {}") == "1:18-20 facts: expected jump, C0, C1 or C2, found 'C7'\n");
    CHECK(in_file("/// @facts slope big\nfloat f() {}") == "1:18-21 facts: expected a number, found 'big'\n");
    CHECK(in_file("/// @facts value 1 .. -1\nfloat f() {}") ==
          "1:18-25 facts: expected the least value before the greatest, found 1 .. -1\n");
    CHECK(in_file("/// @facts class C1, slope -3\nfloat f() {}") ==
          "1:28-30 facts: expected a slope of 0 or more, found -3\n");
    CHECK(in_file("/// @facts curvature -2\nfloat f() {}") ==
          "1:22-24 facts: expected a curvature of 0 or more, found -2\n");
    CHECK(in_file("/// @facts slope 1\ntexture t() {}") ==
          "1:5-19 facts: facts belong to functions; those of a texture are found by the compiler\n");
}

TEST_CASE("habits of other languages get one message each, and what to write")
{
    CHECK(in_body("float3 q = float3(1, 2, 3);") == "2:1-7 foreign-word: 'float3' is not a type of Haptel\n");
    CHECK(in_body("while (a < b) { a = 1; }\nc = 1;") ==
          "2:1-6 unbounded-loop: cannot tell how often this loop runs\n");
    CHECK(in_body("do { a = 1; } while (a < b);\nc = 1;") == "2:1-3 foreign-word: there is no 'do' in Haptel\n");
    CHECK(in_body("discard;\nc = 1;") == "2:1-8 foreign-word: there is no 'discard' in Haptel\n");
    CHECK(in_body("bool2 b = lessThan(p.xy, q.xy);") == "2:1-6 foreign-word: 'bool2' is not a type of Haptel\n");
    CHECK(in_body("float *a = &b;") == "2:7 no-pointers: there are no pointers or references in Haptel\n");
    CHECK(in_body("a = b->c;") == "2:6-8 no-pointers: there are no pointers in Haptel\n");
    CHECK(in_body("float A[2][2][2];") == "2:14 nested-table: tables have at most two dimensions\n");
    CHECK(in_body("float[2][2] A[2];") == "2:14 nested-table: tables have at most two dimensions\n");
    CHECK(in_body("const float A[2][2] = {{1, {2}}, {3, 4}};") ==
          "2:28 nested-table: tables have at most two dimensions\n");
    CHECK(in_file("#include \"a\"\nfloat f() { return 1.0; }") == "1:1-9 preprocessor: Haptel has no '#include'\n");
    CHECK(in_file("struct S { float a; vec3 b; } s;\nfloat f() { return 1.0; }") ==
          "1:31 struct: a struct is declared on its own, found 's'\n");
    CHECK(in_file("uniform float u;\nprecision highp float;\nlayout(location = 0) out vec4 c;\n") ==
          "1:1-8 foreign-word: there is no 'uniform' in Haptel\n"
          "2:1-23 no-effect: 'precision' changes nothing here\n"
          "3:1-7 foreign-word: there is no 'layout' in Haptel\n");
    CHECK(first_hint("float f() { float3 q; }") == "write vec3");
    CHECK(first_hint("float f() { while (a) b = 1; }") ==
          "write /// @bound 64 above it: it then ends after 64 turns at the latest");
    // The right word stands in the tree, so that nothing follows from the slip.
    CHECK(tree_text(parse_text("float3 f(half a) { return a.xxx; }").file) ==
          "function vec3 f (float a) {(return (. a xxx))}\n");
}

TEST_CASE("ten mistakes are ten messages")
{
    const Parsed parsed = parse_text(R"(texture ten(float a, float b = 1mn in 0 .. 2)
{
    float x = ;
    float3 y = vec3(1.0);
    y.x = (a + b;
    if (x = 1.0) x = 2.0;
    while (x < 3.0) x += 1.0;
    x = f(a b);
    float z = 1.0
    return x $ z;
}
)");
    CHECK(parsed.diagnostics.all().size() == 10);
    std::string lines;
    for (const Diagnostic& d : parsed.diagnostics.all())
        lines += std::to_string(parsed.sources.position(0, d.span.begin).line) + " ";
    CHECK(lines == "1 1 3 4 5 6 7 8 9 10 ");
}
