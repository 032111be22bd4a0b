// The front door: files, imports, bad input of every kind.
#include "lang/abi/abi.h"
#include "lang/compile.h"

#include "tests/support/catch.h"

#include <algorithm>
#include <map>

using namespace haptel;
using namespace haptel::lang;

namespace {

std::string repeated(const std::string& text, size_t count)
{
    std::string all;
    all.reserve(text.size() * count);
    for (size_t i = 0; i < count; ++i) all += text;
    return all;
}

// f(0) ... f(count - 1), joined.
template <typename F>
std::string numbered(size_t count, F f)
{
    std::string all;
    for (size_t i = 0; i < count; ++i) all += f(std::to_string(i), std::to_string(i - 1));
    return all;
}

std::vector<std::string> codes(const CompileResult& result)
{
    std::vector<std::string> all;
    for (const Diagnostic& d : result.diagnostics.all())
        if (d.severity == Severity::error) all.push_back(d.code);
    return all;
}

std::string messages(const CompileResult& result)
{
    std::string all;
    for (const Diagnostic& d : result.diagnostics.all()) {
        const Position place = result.sources.position(d.span.file, d.span.begin);
        all += result.sources.file(d.span.file).name + ":" + std::to_string(place.line) + ":" +
               std::to_string(place.column) + ": " + d.message + "\n";
    }
    return all;
}

CompileResult compile_text(const std::string& text)
{
    return compile({"main.haptel", text}, {});
}

// A small file system.
CompileOptions with_files(const std::map<std::string, std::string>& files)
{
    CompileOptions options;
    options.load_import = [files](std::string_view path, std::string_view) -> std::optional<SourceFile> {
        const auto found = files.find(std::string(path));
        if (found == files.end()) return std::nullopt;
        return SourceFile{found->first, found->second};
    };
    return options;
}

} // namespace

TEST_CASE("compile: ten mistakes, ten messages, one go")
{
    const CompileResult result = compile_text(R"(const float WIDTH = 2parsecs;
const float STEPS[3] = {1.0, 2.0};
float ridge(vec3 q) { return 1.0 - abs(nois(q)); }
float slope(vec2 v) { return v.z; }
float tilt(float x) { if (x > 0.0) return x; }
float even(int n) { return even(n - 2); }
texture rock(float depth = 5mm in 0mm .. 3mm, int octaves = 4 in 1 .. 8)
{
    float h = vec3(1.0);
    int n = 0.5 * octaves;
    for (int i = 0; i < octaves; --i) h += ridge(p * i);
    p.x = 2.0;
    return h * depth + lerp(h, 1.0, 0.5) + n;
}
)");
    CHECK(!result.program);
    CHECK(messages(result) == R"(main.haptel:1:21: unknown unit 'parsecs'
main.haptel:2:19: 'STEPS' is declared with 3 elements and has 2
main.haptel:3:40: unknown function 'nois'
main.haptel:4:32: vec2 has no component 'z'
main.haptel:5:7: function 'tilt' can end without returning a float
main.haptel:6:28: function 'even' ends up calling itself: even -> even
main.haptel:7:28: the default 5mm of 'depth' is outside of its range 0mm .. 3mm
main.haptel:9:15: expected float for 'h', found vec3
main.haptel:10:13: expected int for 'n', found float
main.haptel:11:34: 'i' steps away from its bound
main.haptel:12:5: 'p' cannot be changed: it is an input
main.haptel:13:24: unknown function 'lerp'
)");
}

TEST_CASE("compile: the unit of a parameter is that of its first number with one")
{
    const CompileResult result = compile_text("texture t(float a = -1mm, float b = 2 * 3mm, float c = 0 in -1mm .. "
                                              "1mm, float d = 2.0) { return a + b + c * d; }");
    REQUIRE(result.program);
    std::string units;
    for (const ir::Parameter& parameter : result.program->module.textures[0].parameters) units += parameter.unit + ",";
    CHECK(units == "m,m,m,,");
}

TEST_CASE("compile: what a texture is made of")
{
    const CompileResult result = compile_text(R"(/// A grating.
texture grating(
    /// Distance of the grooves.
    float pitch = 0.8mm in 0.2mm .. 5mm,
    int n = 4 in 1 .. 8,
    float plain = 1.5,
    bool on = true,
    uint seed = 7u)
{
    return on ? sin(p.x / pitch) * n + plain * seed * time : 0.0;
}
texture other() { return uv.x * footprint; }
)");
    REQUIRE(result.program);
    CHECK(result.files == std::vector<std::string>{"main.haptel"});
    const auto& textures = result.program->module.textures;
    REQUIRE(textures.size() == 2);
    const ir::Texture& grating = textures[0];
    CHECK(grating.name == "grating");
    CHECK(grating.doc == "A grating.");
    CHECK(grating.reads == (HAPTEL_READS_POINT | HAPTEL_READS_TIME));
    CHECK(grating.writes == 0);
    CHECK(textures[1].reads == (HAPTEL_READS_UV | HAPTEL_READS_FOOTPRINT));
    REQUIRE(grating.parameters.size() == 5);
    const ir::Parameter& pitch = grating.parameters[0];
    CHECK(pitch.name == "pitch");
    CHECK(pitch.doc == "Distance of the grooves.");
    CHECK(pitch.unit == "m");
    CHECK(pitch.value == 0.0008);
    CHECK(pitch.minimum == 0.0002);
    CHECK(pitch.maximum == 0.005);
    CHECK(grating.parameters[2].minimum == -std::numeric_limits<double>::infinity());
    CHECK(grating.parameters[3].value == 1);
    // behind the head: double, int; double on its boundary of 8; bool, uint
    const uint32_t head = sizeof(haptel_block_head);
    const uint32_t offsets[] = {head, head + 8, head + 16, head + 24, head + 28};
    for (size_t i = 0; i < 5; ++i) CHECK(grating.parameters[i].offset == offsets[i]);
    CHECK(grating.block_size == head + 32);
    CHECK(textures[1].block_size == head);
}

TEST_CASE("compile: one texture alone, and one that is not there")
{
    CompileOptions options;
    options.only_texture = "b";
    const std::string text = "texture a() { return 0.0; }\ntexture b() { return 1.0; }\n";
    CompileResult result = compile({"main.haptel", text}, options);
    REQUIRE(result.program);
    REQUIRE(result.program->module.textures.size() == 1);
    CHECK(result.program->module.textures[0].name == "b");

    options.only_texture = "c";
    result = compile({"main.haptel", text}, options);
    CHECK(!result.program);
    CHECK(codes(result) == std::vector<std::string>{"unknown-texture"});
}

TEST_CASE("compile: imports bring functions and constants of a file, once, and not those it imports itself")
{
    const auto options =
        with_files({{"a.haptel", "import \"b.haptel\";\nconst float K = 2.0;\nfloat a(float x) { return b(x) * K; }"},
                    {"b.haptel", "float b(float x) { return x + 1.0; }\ntexture not_this() { return 0.0; }"}});
    CompileResult result = compile(
        {"main.haptel", "import \"a.haptel\";\nimport \"a.haptel\";\ntexture t() { return a(p.x) * K; }"}, options);
    INFO(messages(result));
    REQUIRE(result.program);
    CHECK(result.files == std::vector<std::string>{"main.haptel", "a.haptel", "b.haptel"});
    CHECK(result.program->module.textures.size() == 1);

    result = compile({"main.haptel", "import \"a.haptel\";\ntexture t() { return b(p.x); }"}, options);
    CHECK(codes(result) == std::vector<std::string>{"unknown-function"});

    result = compile({"main.haptel", "import \"broken.haptel\";\ntexture t() { return x(p.x); }"},
                     with_files({{"broken.haptel", "float x(float a) { return a + b; }"}}));
    CHECK(messages(result) == "broken.haptel:1:31: unknown name 'b'\n");
}

TEST_CASE("compile: a file of too many textures is told once, not at each preset of one that was left unread")
{
    std::string big;
    for (int i = 0; i < 1002; ++i) big += "texture t" + std::to_string(i) + "() { return 0.0; }\n";
    const auto of = [&](const std::string& name) {
        return codes(compile({"main.haptel", "import \"big.haptel\" as big;\ntexture t = big." + name + "();"},
                             with_files({{"big.haptel", big}})));
    };
    CHECK(of("t3") == std::vector<std::string>{"too-large"});
    CHECK(of("t1000") == std::vector<std::string>{"too-large"});
    CHECK(of("t1001") == std::vector<std::string>{"too-large"});
    CHECK(of("t1002") == std::vector<std::string>{"unknown-texture", "too-large"});
}

TEST_CASE("compile: imports that cannot be")
{
    CompileResult result =
        compile({"main.haptel", "import \"nowhere.haptel\";\ntexture t() { return 0.0; }"}, with_files({}));
    CHECK(messages(result) == "main.haptel:1:1: cannot read \"nowhere.haptel\"\n");
    CHECK(result.files == std::vector<std::string>{"main.haptel"});
    result = compile({"main.haptel", "import \"nowhere.haptel\";"}, {});
    CHECK(codes(result) == std::vector<std::string>{"missing-import"});

    const auto circle = with_files({{"a.haptel", "import \"b.haptel\";"},
                                    {"b.haptel", "import \"c.haptel\";"},
                                    {"c.haptel", "import \"a.haptel\";"},
                                    {"self.haptel", "import \"self.haptel\";"}});
    result = compile({"main.haptel", "import \"a.haptel\";\ntexture t() { return 0.0; }"}, circle);
    CHECK(messages(result) ==
          "a.haptel:1:1: this import leads back to its own file: a.haptel -> b.haptel -> c.haptel -> a.haptel\n");
    result = compile({"main.haptel", "import \"self.haptel\";"}, circle);
    CHECK(messages(result) == "self.haptel:1:1: this import leads back to its own file: self.haptel -> self.haptel\n");

    // A file system without end.
    CompileOptions endless;
    endless.load_import = [](std::string_view path, std::string_view) -> std::optional<SourceFile> {
        return SourceFile{std::string(path), "import \"" + std::string(path) + "x\";"};
    };
    result = compile({"main.haptel", "import \"x\";"}, endless);
    CHECK(codes(result) == std::vector<std::string>{"too-large"});
}

TEST_CASE("compile: nothing in, nothing out")
{
    const CompileResult result = compile_text("");
    REQUIRE(result.program);
    CHECK(result.program->module.textures.empty());
    REQUIRE(result.diagnostics.all().size() == 1);
    CHECK(result.diagnostics.all()[0].severity == Severity::warning);
    CHECK(result.diagnostics.all()[0].code == "empty-file");
    CHECK(compile_text("float twice(float x) { return 2.0 * x; }").diagnostics.all().empty());
}

TEST_CASE("compile: long but flat is fine")
{
    const std::string chain = "texture t() { return p.x" + repeated(" + p.y", 9'000) + "; }";
    CHECK(compile_text(chain).program);
    const std::string constant = "const float K = 1.0" + repeated(" + 1.0", 50'000) + ";\ntexture t() { return K; }";
    CHECK(compile_text(constant).program);
    const std::string variables =
        "texture t() { float a0 = p.x;\n" +
        numbered(900,
                 [](auto i, auto before) {
                     return i == "0" ? std::string{} : "float a" + i + " = a" + before + " * 1.5;\n";
                 }) +
        "return a899; }";
    CHECK(compile_text(variables).program);
    const std::string ifs = "texture t() { float s = 0.0;\n" +
                            numbered(2'000, [](auto i, auto) { return "if (p.x > " + i + ".0) s += 1.0;\n"; }) +
                            "return s; }";
    CHECK(compile_text(ifs).program);
    const std::string returns = "texture t() {\n" +
                                numbered(200, [](auto i, auto) { return "if (p.x > " + i + ".0) return 1.0;\n"; }) +
                                "return 0.0; }";
    CHECK(compile_text(returns).program);
}

TEST_CASE("compile: deep, large or endless is refused with a reason")
{
    const auto refused = [](const std::string& text, const std::string& code) {
        const CompileResult result = compile_text(text);
        CHECK(!result.program);
        const auto all = codes(result);
        CHECK(std::find(all.begin(), all.end(), code) != all.end());
        CHECK(!render(result.diagnostics.all(), result.sources).empty());
    };
    const auto functions = [](size_t count, const std::string& body) {
        return "float f0(float x) { return x; }\n" + numbered(count, [&](auto i, auto before) {
                   std::string made = "float f" + i + "(float x) { " + body + " }\n";
                   for (size_t at; (at = made.find('@')) != std::string::npos;) made.replace(at, 1, "f" + before);
                   return i == "0" ? std::string{} : made;
               });
    };
    refused("texture t() { return " + repeated("(", 20'000) + "1.0" + repeated(")", 20'000) + "; }", "too-deep");
    refused("texture t() {" + numbered(1'000, [](auto i, auto) { return "if (p.x > " + i + ".0) return 1.0;\n"; }) +
                "return 0.0; }",
            "too-deep");
    refused(functions(1'000, "return @(x) + 1.0;") + "texture t() { return f999(p.x); }", "too-deep");
    refused(functions(100, "float s = 0.0; " + repeated("if (x > 0.0) {", 100) + "s = @(x);" + repeated("}", 100) +
                               " return s;") +
                "texture t() { return f99(p.x); }",
            "too-deep");
    refused(functions(100, "return @(x) + @(x * 2.0);") + "texture t() { return f99(p.x); }", "too-costly");
    refused("texture t() { float s = 0.0; " +
                numbered(50, [](auto i, auto) { return "for (int i" + i + " = 0; i" + i + " < 2; ++i" + i + ") "; }) +
                "s += 1.0; return s; }",
            "too-costly");
    refused(functions(10, "return grad(@)(x) * x;") + "texture t() { return f9(p.x); }", "too-deep");
    refused("float f(float x) { return g(x); } float g(float x) { return f(x); } texture t() { return f(p.x); }",
            "recursion");
    refused("texture t(int k = 1 in 0 .. 15) { mat4 a[16]; for (int i = 0; i < 16; ++i) a[i] = mat4(1.0); " +
                repeated("a[k] += a[k + 1];", 1'000) + " return a[k][k][k] * 1mm; }",
            "too-large");
    refused(std::string(10'000, '\0'), "not-text");
    refused(std::string(10'000, '\xff'), "not-text");
}

TEST_CASE("compile: an avalanche of mistakes stops at the limit")
{
    const CompileResult result = compile_text(
        numbered(3'000, [](auto i, auto) { return "float f" + i + "(float x) { return g" + i + "(x); }\n"; }));
    CHECK(!result.program);
    CHECK(codes(result).size() == 50);
}

TEST_CASE("compile: any half of a program is answered, none crashes")
{
    const std::string whole = R"(import "a.haptel";
const vec2 V[] = {vec2(1.0, 2.0), vec2(3.0)};
/// Doc. @facts value -1 .. 1
float f(float g(vec3), vec3 q, int n) { float s; for (int i = 0; i < min(n, 8); ++i) { s += g(q * i); if (s > 1.0) break; } return s; }
float h(vec3 q) { vec3 r = q; r.xy *= V[1]; r[2] += 1.0; return r.x > 0.0 ? dot(grad(h2)(r), q) : -r.z; }
float h2(vec3 q) { if (q.x < 0.0) return 1.0; else { return length(q); } }
texture t(float a = 2mm in 1mm .. 3mm, int n = 3 in 1 .. 8) { const float K = 2.0; return f(h, p / a, n) * K + f(h2, p, 3); }
)";
    for (size_t length = 0; length < whole.size(); ++length) {
        const CompileResult result = compile_text(whole.substr(0, length));
        REQUIRE((result.program == nullptr) == result.diagnostics.has_errors());
    }
    // and without any one of its words
    for (size_t at = 0; at < whole.size(); ++at) {
        std::string cut = whole;
        cut.erase(at, 1 + at % 7);
        const CompileResult result = compile_text(cut);
        REQUIRE((result.program == nullptr) == result.diagnostics.has_errors());
    }
}
