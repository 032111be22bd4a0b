// What a text costs: twice the text, about twice the work, at every stage. Work is counted in bytes allocated.
#include "lang/compile.h"
#include "lang/format/format.h"
#include "runtime/servo/allocation_count.h"
#include "tests/support/catch.h"

#include <functional>
#include <string>

using namespace haptel;
using namespace haptel::lang;

namespace {

using Text = std::function<std::string(size_t)>;

// f(0) ... f(count - 1), joined.
std::string numbered(size_t count, const std::function<std::string(std::string)>& f)
{
    std::string all;
    for (size_t i = 0; i < count; ++i) all += f(std::to_string(i));
    return all;
}

std::string repeated(size_t count, const std::string& text)
{
    return numbered(count, [&](const std::string&) { return text; });
}

uint64_t work_of(const std::string& text)
{
    const uint64_t before = runtime::allocated_bytes_of_this_thread();
    compile({"main.haptel", text}, {});
    return runtime::allocated_bytes_of_this_thread() - before;
}

// How much more twice as much text costs: 2 where the work is linear, 4 where it is quadratic.
double growth(const Text& text, size_t count)
{
    return static_cast<double>(work_of(text(2 * count))) / static_cast<double>(work_of(text(count)));
}

} // namespace

TEST_CASE("work: what many constants read of a table is not made anew for each")
{
    const auto constants = [](size_t count) {
        return "const float A[] = {" + repeated(count, "1.5, ") + "};\nconst float B[] = {" +
               numbered(count, [](auto i) { return "A[" + i + "], "; }) + "};\n";
    };
    CHECK(growth(constants, 500) < 2.5);
    const auto exponents = [](size_t count) {
        return "const float A[] = {" + repeated(count, "1.5, ") + "};\ntexture t() { float x = 1.0;" +
               numbered(count, [](auto i) { return "x += pow(uv.x, A[" + i + "]);"; }) + " return 1um * x; }";
    };
    CHECK(growth(exponents, 500) < 2.5);
}

TEST_CASE("work: a call looks up the choice that it gives among all, and makes none anew")
{
    const auto calls = [](size_t count) {
        return "texture wall(int bond = c0 in {" + numbered(count, [](auto i) { return "c" + i + ","; }) +
               "}) { return 1mm * bond; }\ntexture t() { float h = 0.0;" + repeated(count, "h += wall(bond = c7);") +
               " return h; }";
    };
    CHECK(growth(calls, 400) < 2.5);
}

TEST_CASE("work: the type of many names is read once")
{
    const auto names = [](const std::string& before, const std::string& after) {
        return [=](size_t count) {
            return before + repeated(count, "+1") + "] a" + numbered(count, [](auto i) { return ", b" + i; }) + after;
        };
    };
    CHECK(growth(names("texture t() { const float[1", "; return 0.0; }"), 400) < 2.5);
    CHECK(growth(names("texture t() { float[1", "; return 0.0; }"), 400) < 2.5);
    CHECK(growth(names("const float[1", ";"), 400) < 2.5);
    CHECK(growth(
              [](size_t count) {
                  return repeated(count, "/// what they are\n") + "const float a = 1.0" +
                         numbered(count, [](auto i) { return ", b" + i + " = 1.0"; }) + ";";
              },
              400) < 2.5);
}

TEST_CASE("work: unknown names are looked for a few times, not each among all that are known")
{
    const auto constants = [](size_t count) {
        return numbered(count, [](auto i) { return "const float known" + i + " = 1.0;\n"; });
    };
    CHECK(growth(
              [&](size_t count) {
                  return constants(count) + "texture t() { return 0.0" +
                         numbered(count, [](auto i) { return " + unknown" + i; }) + "; }";
              },
              2000) < 2.5);
    CHECK(growth(
              [&](size_t count) {
                  return constants(count) + "texture t() { float a = (1.0;\n return 0.0" + // an error that hides others
                         numbered(count, [](auto i) { return " + unknown" + i; }) + "; }";
              },
              2000) < 2.5);
    CHECK(growth(
              [&](size_t count) {
                  return "texture t() { return 0.0" + numbered(count, [](auto i) { return " + f" + i + "(1.0)"; }) +
                         "; }";
              },
              2000) < 2.5);
}

TEST_CASE("work: a file that is imported again is not read again, and many imports are no more than their number")
{
    size_t reads = 0;
    CompileOptions options;
    options.load_import = [&](std::string_view path, std::string_view) {
        ++reads;
        return std::optional(SourceFile{std::string(path), "float f(float x) { return x; }\n"});
    };
    const CompileResult result = compile(
        {"main.haptel", repeated(1000, "import \"a.haptel\";\n") + "texture t() { return 1mm * f(1.0); }"}, options);
    CHECK(result.program);
    CHECK(reads == 1);

    std::string prefixed;
    for (int i = 0; i < 20'000; ++i) prefixed += "import \"a.haptel\" as a" + std::to_string(i) + ";\n";
    CHECK(compile({"main.haptel", prefixed + "texture t() { return 1mm * a7.f(1.0); }"}, options).program);
    CHECK(reads == 2);
}

TEST_CASE("limits: what is imported is read up to 64 MiB, and the same file in many ways of writing its path too")
{
    size_t reads = 0;
    CompileOptions options;
    options.load_import = [&](std::string_view path, std::string_view) {
        ++reads;
        return std::optional(SourceFile{path.back() == 'a' ? "a" : std::string(path), std::string(16 << 20, ' ')});
    };
    const auto result_of = [&](const Text& path) {
        reads = 0;
        std::string imports;
        for (size_t i = 0; i < 200; ++i) imports += "import \"" + path(i) + "\";\n";
        const auto said = compile({"main.haptel", imports + "texture t() { return 0.0; }"}, options).diagnostics;
        return std::to_string(reads) + " " + said.all().front().code;
    };
    CHECK(result_of([](size_t i) { return std::to_string(i); }) == "5 too-large");
    CHECK(result_of([](size_t i) { return std::string(i, '/') + "a"; }) == "5 too-large");
}

TEST_CASE("limits: functions that are bound to each other are there as often as that")
{
    const auto chain = [](size_t length) { // each binds what it has been passed twice
        std::string all = "float both(float a(float), float b(float), float x) { return a(x) + b(x); }\n";
        for (size_t i = 0; i < length; ++i)
            all += "float f" + std::to_string(i) + "(float f(float), float x) { return " +
                   (i == 0 ? "f(x)" : "f" + std::to_string(i - 1) + "(both(f, f, _), x)") + "; }\n";
        return all + "texture t() { return 1m * f" + std::to_string(length - 1) + "(sin, p.x / 1m); }";
    };
    CHECK(compile({"main.haptel", chain(6)}, {}).program);
    const CompileResult result = compile({"main.haptel", chain(100)}, {});
    REQUIRE(result.diagnostics.has_errors());
    CHECK(result.diagnostics.all().front().code == "too-large");
}

TEST_CASE("limits: what is too large to compile is refused by the formatter")
{
    SourceSet sources;
    Diagnostics diagnostics;
    const uint32_t file = sources.add({"main.haptel", "const int A[] = {" + repeated(1'000'000, "1,") + "};"});
    const uint64_t before = runtime::allocated_bytes_of_this_thread();
    CHECK(!format(sources, file, diagnostics));
    CHECK(runtime::allocated_bytes_of_this_thread() - before < 100 << 20);
    CHECK(diagnostics.all().front().code == "too-large");
}

namespace {

// "3:7 too-large" of the only error, or what there is instead.
std::string refusal(const std::string& text)
{
    const CompileResult result = compile({"main.haptel", text}, {});
    std::string errors;
    for (const Diagnostic& said : result.diagnostics.all()) {
        if (said.severity != Severity::error) continue;
        const Position place = result.sources.position(said.span.file, said.span.begin);
        errors += std::to_string(place.line) + ":" + std::to_string(place.column) + " " + said.code + "\n";
    }
    return errors;
}

} // namespace

TEST_CASE("limits: what is too much is refused at its place, and what is at the limit is not")
{
    const std::string texture = "texture t() { return 0.0; }";
    const auto textures = [](size_t count) {
        return numbered(count, [](auto i) { return "texture t" + i + "() { return 0.0; }\n"; });
    };
    CHECK(refusal(textures(1000)) == "");
    CHECK(refusal(textures(20'000)) == "1001:9 too-large\n");

    const auto overloads = [&](size_t count) { // told apart by the bits of their number
        std::string all;
        for (size_t i = 0; i < count; ++i) {
            all += "float f(";
            for (int bit = 0; bit < 15; ++bit)
                all += (i >> bit & 1 ? "vec2 a" : "float a") + std::to_string(bit) + ", ";
            all += "float b) { return b; }\n";
        }
        return all + texture;
    };
    CHECK(refusal(overloads(256)) == "");
    CHECK(refusal(overloads(257)) == "257:7 too-large\n");
    CHECK(refusal(overloads(5'000)).starts_with("257:7 too-large\n258:7 too-large\n"));

    const auto parameters = [](size_t count) {
        return numbered(count - 1, [](auto i) { return "float a" + i + ",\n"; }) + "float b";
    };
    CHECK(refusal("float f(" + parameters(1000) + ") { return b; }\n" + texture) == "");
    CHECK(refusal("float f(" + parameters(20'000) + ") { return b; }\n" + texture) == "1001:7 too-large\n");
    const auto sliders = [](size_t count) {
        return "texture t(" + numbered(count - 1, [](auto i) { return "float a" + i + " = 1.0,\n"; }) +
               "float b = 1.0) { return 1mm * b; }";
    };
    CHECK(refusal(sliders(1000)) == "");
    CHECK(refusal(sliders(20'000)) == "1001:7 too-large\n");
    const auto choices = [](size_t count) {
        return "texture t(int a = 0 in {" + numbered(count, [](auto i) { return "c" + i + ","; }) +
               "}) { return 1mm * a; }";
    };
    CHECK(refusal(choices(999)) == "");
    CHECK(refusal(choices(1000)) == "1:15 too-large\n");
    const auto vectors = [](size_t count) {
        return "texture t(" + numbered(count, [](auto i) { return "vec4 a" + i + " = vec4(1.0),\n"; }) +
               ") { return 1mm * a0.x; }";
    };
    CHECK(refusal(vectors(250)) == "");
    CHECK(refusal(vectors(251)) == "251:6 too-large\n");

    const auto variables = [](size_t count) {
        return "texture t() {\n" + numbered(count, [](auto i) { return "float a" + i + " = 1.0;\n"; }) +
               "return 1mm * a0; }";
    };
    CHECK(refusal(variables(1000)) == "");
    CHECK(refusal(variables(50'000)) == "1002:7 too-large\n");

    const auto factors = [](size_t count) {
        return "texture t(float a = 1.0) { return 1mm" + repeated(count, " * a") + "; }";
    };
    CHECK(refusal(factors(9'990)) == "");
    CHECK(refusal(factors(10'010)) == "1:9 too-large\n");
    CHECK(refusal(factors(100'000)) == "1:9 too-large\n");

    std::string tables;
    for (int i = 0; i < 50; ++i)
        tables += "const int A" + std::to_string(i) + "[] = {" + repeated(65'535, "1,") + "1};\n";
    CHECK(refusal(tables + texture) == "8:82452 too-large\n"); // 1 000 000 tokens further on
    CHECK(refusal(repeated(999'000, "//\n") + texture) == "");
    CHECK(refusal(repeated(1'000'000, "//\n") + texture) == "1000001:1 too-large\n");
    CHECK(refusal(repeated(1'000'000, "/**/\n") + texture) == "1000001:1 too-large\n");
    CHECK(refusal(repeated(1'000'000, "///\n") + texture) == "1000001:1 too-large\n");

    const std::string letters(4096, 'a');
    CHECK(refusal("const float " + letters + " = 1.0;\n" + texture) == "");
    CHECK(refusal("const float a" + letters + " = 1.0;\n" + texture) == "1:13 too-large\n");
    CHECK(refusal("const float a = 0." + std::string(4095, '1') + ";\n" + texture) == "1:17 too-large\n");
    CHECK(refusal("import \"" + letters + "\";\n" + texture) == "1:8 too-large\n");
}
