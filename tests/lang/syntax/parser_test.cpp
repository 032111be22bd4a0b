// What is well written: text in, tree out.
#include "tests/lang/syntax/tree_text.h"
#include "tests/support/catch.h"

using namespace haptel::lang;

TEST_CASE("operators bind as in GLSL; those of one precedence make a flat chain")
{
    CHECK(expression_tree("a + b * c - d") == "(+ a (* b c) - d)");
    CHECK(expression_tree("a * b + c * d / e % f") == "(+ (* a b) (* c d / e % f))");
    CHECK(expression_tree("a || b ^^ c && d | e ^ f & g == h < i << j + k * l") ==
          "(|| a (^^ b (&& c (| d (^ e (& f (== g (< h (<< i (+ j (* k l)))))))))))");
    CHECK(expression_tree("a * b + c << d < e == f & g ^ h | i && j ^^ k || l") ==
          "(|| (^^ (&& (| (^ (& (== (< (<< (+ (* a b) c) d) e) f) g) h) i) j) k) l)");
    CHECK(expression_tree("a - b - c") == "(- a b c)");
    CHECK(expression_tree("(a + b) * c") == "(* (+ a b) c)");
    CHECK(expression_tree("-a * !b + ~c") == "(+ (* (- a) (! b)) (~ c))");
    CHECK(expression_tree("a - -b") == "(- a (- b))");
    CHECK(expression_tree("a ? b : c ? d : e") == "(? a b (? c d e))");
    CHECK(expression_tree("a ? b ? c : d : e || f") == "(? a (? b c d) (|| e f))");
    CHECK(expression_tree("-q.x") == "(- (. q x))");
}

TEST_CASE("postfix, calls, derivatives and literals")
{
    CHECK(expression_tree("q.xyz.x") == "(. (. q xyz) x)");
    CHECK(expression_tree("A[i + 1].x") == "(. ([] A (+ i 1)) x)");
    CHECK(expression_tree("vec3(p.x, 0.08 * p.yz)") == "(call vec3 (. p x) (* 0.08 (. p yz)))");
    CHECK(expression_tree("f()") == "(call f)");
    CHECK(expression_tree("fbm(noise, q, 4, 2.0, 0.5)") == "(call fbm noise q 4 2.0 0.5)");
    CHECK(expression_tree("grad(f)(q, 1)") == "(grad1 f q 1)");
    CHECK(expression_tree("grad(grad(f))(q).x") == "(. (grad2 f q) x)");
    CHECK(expression_tree("grad(hash, x, y)") == "(call grad hash x y)"); // for the checker
    CHECK(expression_tree("true ^^ false") == "(^^ true false)");
    CHECK(expression_tree("60um + 1.0f + 1u + 0xFFu") == "(+ 60um 1.0f 1u 0xFFu)");
}

TEST_CASE("literals carry their value in SI")
{
    const Parsed parsed = parse_text("const float A = 0.8mm; const int B = 0x10; const uint C = 7u;");
    const auto literal = [&](size_t i) {
        return std::get<ast::NumberLiteral>(parsed.file.constants.at(i).declaration.initializer->node);
    };
    CHECK(literal(0).value == 0.0008);
    CHECK(literal(0).unit == "mm");
    CHECK(literal(1).integer == 16);
    CHECK(literal(1).kind == ast::NumberLiteral::Kind::integer);
    CHECK(literal(2).kind == ast::NumberLiteral::Kind::unsigned_integer);
}

TEST_CASE("structs and switches")
{
    CHECK(tree_text(parse_text("struct S { float a, b[2]; vec3[2] c; T d; }; S f(S s) { return s; }").file) ==
          "struct S (float a) (float[2] b) (vec3[2] c) (T d)\nfunction S f (S s) {(return s)}\n");
    CHECK(body_tree("switch (i) { case 0: a = 1; break; case 1: case N + 1: { b; } default: return; }") ==
          "(switch i [0 {(= a 1) (break)}] [1 (+ N 1) {{(do b)}}] [default {(return)}])");
    CHECK(body_tree("switch (i) { case a ? 1 : 2: default: } s.a.b[1].x = 2;") ==
          "(switch i [(? a 1 2) default {}]) (= (. ([] (. (. s a) b) 1) x) 2)");
}

TEST_CASE("statements")
{
    CHECK(body_tree("float a = 1, b; const int n = 3;") == "(let float a 1) (let float b) (const int n 3)");
    CHECK(body_tree("const float A[3] = {1.0, 2.0, 3.0,}; float[2] B;") ==
          "(const float[3] A ({} 1.0 2.0 3.0)) (let float[2] B)");
    CHECK(body_tree("float A[] = {1.0}, b = 2;") == "(let float[] A ({} 1.0)) (let float b 2)");
    CHECK(body_tree("q.x += 2; a[1] = b; c <<= 1; d = e;") == "(+= (. q x) 2) (= ([] a 1) b) (<<= c 1) (= d e)");
    CHECK(body_tree("i++; --j; ++q.x;") == "(+= i 1) (-= j 1) (+= (. q x) 1)");
    CHECK(body_tree(";; {} { a = 1; }") == "{} {(= a 1)}");
    CHECK(body_tree("f(x);") == "(do (call f x))");
    CHECK(body_tree("return;") == "(return)");
    CHECK(body_tree("vec3(1.0).x;") == "(do (. (call vec3 1.0) x))");
    CHECK(body_tree("half = 2; discard = 3;") == "(= half 2) (= discard 3)"); // reserved elsewhere, names here
}

TEST_CASE("if and for, with and without braces")
{
    CHECK(body_tree("if (a) b = 1; else if (c) { b = 2; } else b = 3;") ==
          "(if [a (= b 1)] [c {(= b 2)}] [else (= b 3)])");
    CHECK(body_tree("if (a) if (b) c = 1; else c = 2;") == "(if [a (if [b (= c 1)] [else (= c 2)])])");
    CHECK(body_tree("for (int i = 0; i < 4; i++) { if (i > 2) break; s += i; }") ==
          "(for (let int i 0) (< i 4) (+= i 1) {(if [(> i 2) (break)]) (+= s i)})");
    CHECK(body_tree("for (i = 0; ; i += 2) s += i;") == "(for (= i 0) none (+= i 2) (+= s i))");
    CHECK(body_tree("for (;;) break;") == "(for none none none (break))");
    CHECK(body_tree("if (a) float x = 1, y = 2;") == "(if [a {(let float x 1) (let float y 2)}])");
}

TEST_CASE("a whole file")
{
    const Parsed parsed = parse_text(R"(
import "wood/oak.haptel";
/// Golden.
const float PHI = 1.618, E = 2.718;
const int M[] = {3, 1};

/// Sum of octaves.
/// @facts value -2 .. 2, slope 1.5e2, curvature 11.59, class C1
/// Second line.
float fbm(float basis(vec3), const in vec3 q, int n) { return basis(q); }
void nothing(void) {}
float two(float f(), float g(vec2 q, int n)) { return 1.0; }

/// Not this: a blank line parts it from the texture.

/// Long irregular grooves,
///   as left by a brush.
texture brushed(
    /// Distance of grooves.
    float pitch = 0.8mm in 0.2mm .. 5mm,
    int octaves = 4 in 1..8, // not documented
    bool rough = true,
    int edge = ridge in {flat, ridge,},
    vec2 size = vec2(1, 2) in vec2(0) .. 3.0,
    out float stiffness_scale)
{
    return pitch;
}
)");
    CHECK(parsed.messages() == "");
    CHECK(tree_text(parsed.file) == R"(import wood/oak.haptel
(const float PHI 1.618)
(const float E 2.718)
(const int[] M ({} 3 1))
function float fbm (float basis <- vec3) (vec3 q) (int n) "Sum of octaves.|Second line." {(return (call basis q))}
function void nothing {}
function float two (float f <-) (float g <- vec2 <- int) {(return 1.0)}
texture brushed "Long irregular grooves,|  as left by a brush."
  float pitch = 0.8mm in 0.2mm .. 5mm "Distance of grooves."
  int octaves = 4 in 1 .. 8
  bool rough = true
  int edge = ridge in {flat, ridge}
  vec2 size = (call vec2 1 2) in (call vec2 0) .. 3.0
  out float stiffness_scale
  {(return pitch)}
)");
    REQUIRE(parsed.file.functions[0].facts);
    const haptel::ir::Facts& facts = *parsed.file.functions[0].facts;
    CHECK(facts.value_minimum == -2.0);
    CHECK(facts.value_maximum == 2.0);
    CHECK(facts.slope == 150.0);
    CHECK(facts.curvature == 11.59);
    CHECK(facts.continuity == haptel::ir::Continuity::c1);
    CHECK(parsed.sources.text(facts.span) == "@facts value -2 .. 2, slope 1.5e2, curvature 11.59, class C1");
    CHECK_FALSE(parsed.file.functions[0].damage.any);
}

TEST_CASE("facts may have units and be given in part")
{
    const Parsed parsed = parse_text("/// @facts class jump, value -60um..60um\nfloat f() { return 0.0; }");
    CHECK(parsed.messages() == "");
    const haptel::ir::Facts& facts = *parsed.file.functions.at(0).facts;
    CHECK(facts.value_minimum == -60e-6);
    CHECK(facts.continuity == haptel::ir::Continuity::jump);
    CHECK_FALSE(facts.slope);
}

TEST_CASE("spans cover what was written, brackets too")
{
    const Parsed parsed = parse_text("const float A = (a + b) * f(c)[1].xy;");
    const ast::Expression& whole = *parsed.file.constants.at(0).declaration.initializer;
    CHECK(parsed.sources.text(whole.span) == "(a + b) * f(c)[1].xy");
    const ast::Chain& chain = std::get<ast::Chain>(whole.node);
    CHECK(parsed.sources.text(chain.first->span) == "(a + b)");
    CHECK(parsed.sources.text(chain.rest[0].op_span) == "*");
    CHECK(parsed.sources.text(chain.rest[0].operand->span) == "f(c)[1].xy");
    const Parsed body = parse_text("float f() { if (a) { return 1.0; } }");
    const ast::Scope& scope = std::get<ast::Scope>(body.file.functions.at(0).body->node);
    CHECK(body.sources.text(scope.statements.at(0)->span) == "if (a) { return 1.0; }");
}

TEST_CASE("an empty file is a tree without anything")
{
    CHECK(parse_text("").messages() == "");
    CHECK(tree_text(parse_text(" \n// nothing\n").file) == "");
}
