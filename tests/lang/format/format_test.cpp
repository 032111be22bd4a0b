// The formatter: its style line by line, that it is stable, and that it keeps every token and comment in order.
#include "lang/format/format.h"
#include "lang/text/lexer.h"
#include "tests/support/catch.h"

#include <random>

using namespace haptel::lang;

namespace {

std::string formatted(const std::string& text)
{
    SourceSet sources;
    const uint32_t file = sources.add({"t.haptel", text});
    Diagnostics diagnostics;
    const std::optional<std::string> result = format(sources, file, diagnostics);
    return result ? *result : "refused";
}

std::vector<std::string> tokens_of(const std::string& text)
{
    SourceSet sources;
    const uint32_t file = sources.add({"t.haptel", text});
    Diagnostics diagnostics;
    std::vector<std::string> all;
    for (const PlacedToken& token : lex(sources, file, diagnostics).tokens)
        all.push_back(text.substr(token.begin, token.end - token.begin));
    return all;
}

} // namespace

TEST_CASE("format: spaces")
{
    CHECK(formatted("float f( float x ){return -x* ( 2+x )/3.0 - -x;}") ==
          "float f(float x)\n{\n    return -x * (2 + x) / 3.0 - -x;\n}\n");
    CHECK(formatted("float f(vec3 q)\n{ float s=0.0; for(int i=0;i<3;i++)s+=q[ i ]; return grad ( n ) ( q ) . x ; }") ==
          "float f(vec3 q)\n{\n    float s = 0.0;\n    for (int i = 0; i < 3; i++) s += q[i];\n"
          "    return grad(n)(q).x;\n}\n");
    CHECK(formatted("bool f(bool a,int b){return!a&&(b&1)==~b||a?true:false;}") ==
          "bool f(bool a, int b)\n{\n    return !a && (b & 1) == ~b || a ? true : false;\n}\n");
    CHECK(formatted("import\"a.haptel\";import \"b.haptel\" ;const float A[2]={1.0,2.0,};") ==
          "import \"a.haptel\";\nimport \"b.haptel\";\nconst float A[2] = {1.0, 2.0,};\n");
    CHECK(formatted("const float A[ 2 ] [2]={ {1.0,2.0},{ 3.0 , 4.0 } , };") ==
          "const float A[2][2] = {{1.0, 2.0}, {3.0, 4.0},};\n");
    CHECK(formatted("import \"a.haptel\"as  a;float f(float x){return a . f(x)*a .K+grad( a.f )(x);}") ==
          "import \"a.haptel\" as a;\n\nfloat f(float x)\n{\n    return a.f(x) * a.K + grad(a.f)(x);\n}\n");
    CHECK(formatted("float f(float x){ if(x>0.0)++x;else--x; return x; }") ==
          "float f(float x)\n{\n    if (x > 0.0) ++x;\n    else --x;\n    return x;\n}\n");
}

TEST_CASE("format: braces of control flow stand in the line, those of functions below it")
{
    CHECK(
        formatted("float f(float x){if(x>0.0){return x;}else if(x<-1.0){return 1.0;}\nelse\n{return 0.0;}}") ==
        "float f(float x)\n{\n    if (x > 0.0) {\n        return x;\n    } else if (x < -1.0) {\n        return 1.0;\n"
        "    } else {\n        return 0.0;\n    }\n}\n");
    CHECK(formatted("void f(){for(;;)for(;;)if(a)b;else{c;}}") ==
          "void f()\n{\n    for (;;)\n        for (;;)\n            if (a) b;\n            else {\n"
          "                c;\n            }\n}\n");
}

TEST_CASE("format: labels stand as deep as their switch")
{
    const std::string text = "float f(int i, float x)\n{\n"
                             "    switch (i) {\n"
                             "    case 0: return x;\n"
                             "    // the two alike\n"
                             "    case 1:\n"
                             "    case N + 1: {\n"
                             "        x += 1.0;\n"
                             "        break;\n"
                             "    }\n"
                             "    case 4: case 5:\n"
                             "        /// @bound 4\n"
                             "        while (x > 1.0) x *= 0.5;\n"
                             "        switch (i) {\n"
                             "        default: ++x; break; // above\n"
                             "        }\n"
                             "        x = x > 0.0 ? 1.0 : 2.0;\n"
                             "    default:\n"
                             "    }\n"
                             "    return x;\n}\n";
    CHECK(formatted(text) == text);
    CHECK(
        formatted("float f(){switch(i){case 0 :x=1;break;case a?1:2 :{return -x;}default:++x;}}") ==
        "float f()\n{\n    switch (i) {\n    case 0: x = 1; break;\n    case a ? 1 : 2: {\n        return -x;\n    }\n"
        "    default: ++x;\n    }\n}\n");
}

TEST_CASE("format: a member of a struct per line")
{
    CHECK(formatted(
              "const int N=2;struct Cell{vec2 id,at ;float d[N];}; // here\nCell f(){return Cell[2]( a,b )[0] ;}") ==
          "const int N = 2;\n\nstruct Cell {\n    vec2 id, at;\n    float d[N];\n}; // here\n\nCell f()\n{\n"
          "    return Cell[2](a, b)[0];\n}\n");
}

TEST_CASE("format: at most one empty line in a row, one round every function, none inside of braces")
{
    CHECK(formatted("\n\n// a\n\n\n\n// b\nfloat f()\n{\n\n\n    float x = 1.0;\n\n\n\n    return x;\n\n}\nfloat g() { "
                    "return 1.0; }\n\n") ==
          "// a\n\n// b\nfloat f()\n{\n    float x = 1.0;\n\n    return x;\n}\n\nfloat g()\n{\n    return 1.0;\n}\n");
    CHECK(formatted("const float a = 1.0; float f() { return a; } const float b = 1.0;") ==
          "const float a = 1.0;\n\nfloat f()\n{\n    return a;\n}\n\nconst float b = 1.0;\n");
}

TEST_CASE("format: parameters of a texture one per line, ranges below one another")
{
    const std::string text = "/// Long irregular grooves, as left by a coarse brush.\n"
                             "texture brushed(\n"
                             "    float pitch = 0.8mm in 0.2mm .. 5mm,  // from groove to groove\n"
                             "    float depth = 60um  in 0um .. 200um,\n"
                             "    /// How many times finer.\n"
                             "    int octaves = 4     in 1 .. 8)\n"
                             "{\n"
                             "    return depth * fbm(p / pitch, octaves);\n"
                             "}\n";
    CHECK(formatted(text) == text);
    CHECK(
        formatted("texture t(int a=x in{x,y ,z,},vec2 b=vec2(1mm,2mm)in vec2(0mm)..3mm){return a*b.x;}") ==
        "texture t(int a = x in {x, y, z,}, vec2 b = vec2(1mm, 2mm) in vec2(0mm) .. 3mm)\n{\n    return a * b.x;\n}\n");
    CHECK(formatted("texture t(float depth = 60um in 0um..200um) { return depth; }") ==
          "texture t(float depth = 60um in 0um .. 200um)\n{\n    return depth;\n}\n");
}

TEST_CASE("format: long lines break where it hurts least and go on below what they belong to")
{
    CHECK(
        formatted(
            "float f(vec3 q)\n{\n    return first_of_all(q.x, q.y) * second_of_all(q.y, q.z) + third_of_all(q.z, q.x, "
            "fourth_of_all(q.x, q.y));\n}\n") ==
        "float f(vec3 q)\n{\n    return first_of_all(q.x, q.y) * second_of_all(q.y, q.z) +\n"
        "           third_of_all(q.z, q.x, fourth_of_all(q.x, q.y));\n}\n");
    CHECK(formatted("const int T[3] = {\n1,\n2,  3 };") == "const int T[3] = {\n    1,\n    2, 3\n};\n");
}

TEST_CASE("format: a line end between the arguments of an element begins no row of a table")
{
    const std::string text =
        "const float T[2] = {\n"
        "    the_first_of_all_the_elements_is_a_call(second_of_all_the_functions(1.0, 2.0, 3.0, 4.0),\n"
        "                                            third_of_all_the_functions(5.0)), 6.0\n"
        "};\n";
    CHECK(formatted("const float T[2]={the_first_of_all_the_elements_is_a_call(second_of_all_the_functions(1.0,2.0,3.0,"
                    "4.0),third_of_all_the_functions(5.0)),6.0};") == text);
    CHECK(formatted(text) == text);
}

TEST_CASE("format: comments stay with what they are at")
{
    CHECK(formatted("float f(float x /* in m */, // first\n float y)\n// below\n{ // opens\n return x  // sum\n + y; "
                    "/* end */ }\n// last") ==
          "float f(float x /* in m */, // first\n        float y)\n// below\n{ // opens\n"
          "    return x // sum\n           + y; /* end */\n}\n\n// last\n");
    CHECK(
        formatted(
            "float f(bool a) {\n float x = 1.0; // one\n float long_name = 2.0; // two\n if (a) { x = 2.0; } // then\n"
            " // why\n else x = 3.0;\n return x;\n // end\n }") ==
        "float f(bool a)\n{\n    float x = 1.0;         // one\n    float long_name = 2.0; // two\n    if (a) {\n"
        "        x = 2.0;\n    } // then\n    // why\n    else x = 3.0;\n    return x;\n    // end\n}\n");
}

TEST_CASE("format: a semicolon that does nothing stays at its brace")
{
    CHECK(formatted("float f()\n{\n    return 1.0;\n}; // end\nconst float A = 1.0;") ==
          "float f()\n{\n    return 1.0;\n}; // end\n\nconst float A = 1.0;\n");
}

TEST_CASE("format: what is no Haptel is refused")
{
    CHECK(formatted("float f( { return 1.0; }") == "refused");
    CHECK(formatted("texture t() { return 1mm }") == "refused");
    CHECK(formatted("") == "");
}

// Tokens of a text that has everything, with random space and comments between them: each result is stable and has the
// same tokens and comments in the same order.
TEST_CASE("format: stable, and loses nothing, however the text is spaced")
{
    const std::vector<std::string> tokens = tokens_of(
        "import \"b.haptel\"; const float T[3] = {1.0, -2.0, 3.0,}, S = 1e-3; float g(int i, float basis(vec3), vec3 "
        "q) { "
        "if (i < 3) return basis(q); else if (!(i == 4)) { i += 1; } else for (int k = 0; k < 4; ++k) { break; } "
        "float[2] a = float[2](1.0, - -q.x), b; { ; } return a[i & 1] * T[2] + (i > 0 ? q.xy.x : grad(f)(q).y); } "
        "texture t(float depth = 60um in -1um .. 200um, int n = 3 in 1 .. 8, out float stiffness_scale) "
        "{ return depth * g(n, perlin, p / 1mm); }");
    const std::string between[] = {" ", " ", " ", "\n", "\n\n\n", "\t", "\r\n"};
    std::mt19937 random(7);
    for (int round = 0; round < 400; ++round) {
        std::string text;
        std::vector<std::string> words; // tokens and comments as they must come
        int number = 0;
        for (const std::string& token : tokens) {
            text += token;
            words.push_back(token);
            text += between[random() % std::size(between)];
            const auto kind = random() % (round % 2 == 0 ? 12 : 60);
            if (kind > 2) continue;
            const std::string mark = std::to_string(number++);
            words.push_back(kind == 0 ? "//" + mark : kind == 1 ? "/*" + mark + "*/" : "///" + mark);
            text += words.back() + (kind == 1 ? between[random() % std::size(between)] : "\n");
        }
        CAPTURE(text);
        const std::string once = formatted(text);
        REQUIRE(once != "refused");
        REQUIRE(formatted(once) == once);
        size_t at = 0;
        for (const std::string& word : words) {
            const size_t found = once.find(word, at);
            REQUIRE(found != std::string::npos);
            CHECK(once.substr(at, found - at).find_first_not_of(" \n") == std::string::npos);
            at = found + word.size();
        }
        CHECK(once.find("\n\n\n") == std::string::npos);
        CHECK(once.find(" \n") == std::string::npos);
    }
}
