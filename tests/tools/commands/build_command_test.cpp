// haptel build: what it writes is code that runs without Haptel, and what it refuses it says.
#include "tests/support/catch.h"
#include "tests/support/ir_parse.h"
#include "tests/tools/commands/run_command.h"

#include <fstream>
#include <nlohmann/json.hpp>

using namespace haptel::test;

namespace {

constexpr const char* ripples =
    "/// Rings.\ntexture ripples(float depth = 50um in 0um .. 200um, int rings = 3 in 1 .. 9) {\n"
    "  return depth * sinturn(float(rings) * length(p.xy) / 12mm);\n}\n";

// Prints the height that the texture's table gives for another depth.
constexpr const char* program = R"(#include "ripples.h"
#include <stdio.h>
int main(void)
{
    haptel_block_ripples block = haptel_defaults_ripples;
    static haptel_point point;
    haptel_sample sample;
    point.p[0] = 3.1e-3;
    point.p[1] = 4.2e-3;
    block.depth = 80e-6;
    if (haptel_texture_ripples.abi != HAPTEL_ABI_VERSION) return 1;
    haptel_texture_ripples.height_gradient(&point, &block, &sample);
    printf("%.17g %.17g %.17g\n", sample.height_m, sample.gradient[0], sample.gradient[1]);
    return 0;
}
)";

std::string quoted_file(const Folder& folder, const std::string& name)
{
    return "'" + folder.file(name) + "'";
}

} // namespace

TEST_CASE("a C program gets of each kind of output what haptel eval says, and links nothing but libm")
{
    const Folder folder;
    const std::string file = folder.write("ripples.haptel", ripples);
    folder.write("main.c", program);
    const Ran truth = run_command("eval '" + file + ":ripples' --at 3.1mm,4.2mm,0 --set depth=80um --json");
    REQUIRE(truth.code == 0);
    const auto expected = nlohmann::json::parse(truth.out);
    REQUIRE(run_command("build '" + file + "' --emit header -o " + quoted_file(folder, "ripples.h")).code == 0);
    struct Kind {
        const char *emit, *file;
    };
    for (const Kind& kind : {Kind{"object", "ripples.o"},
                             {"static", "libripples.a"},
                             {"shared", "libripples.so"},
                             {"c", "ripples.c"},
                             {"asm", "ripples.s"}}) {
        CAPTURE(kind.emit);
        const Ran built = run_command("build '" + file + "' --emit " + kind.emit + " -o " +
                                      quoted_file(folder, kind.file) + " --json");
        INFO(built.err);
        REQUIRE(built.code == 0);
        const auto said = nlohmann::json::parse(built.out);
        CHECK(said["textures"][0]["symbol"] == "haptel_texture_ripples");
        CHECK(said["bytes"] == std::filesystem::file_size(folder.file(kind.file)));
        REQUIRE(shell("cd '" + folder.path.string() + "' && cc -std=c99 -Wall -Wextra -Wpedantic -Werror main.c " +
                      kind.file +
                      " -Wl,--no-undefined -Wl,-rpath,. -lm -o main && ./main >out && ldd main >libraries") == 0);
        double height = 0, gradient[2] = {};
        const std::string out = read_file(folder.file("out"));
        REQUIRE(std::sscanf(out.c_str(), "%lf %lf %lf", &height, &gradient[0], &gradient[1]) == 3);
        CHECK(height == expected["height_m"].get<double>());
        CHECK(gradient[0] == expected["gradient"][0].get<double>());
        CHECK(gradient[1] == expected["gradient"][1].get<double>());
        const std::string libraries = read_file(folder.file("libraries"));
        CHECK_FALSE(contains(libraries, "LLVM"));
        CHECK_FALSE(contains(libraries, "stdc++"));
        // The same again gives the same bytes.
        const std::string first = read_file(folder.file(kind.file));
        REQUIRE(
            run_command("build '" + file + "' --emit " + kind.emit + " -o " + quoted_file(folder, kind.file)).code ==
            0);
        CHECK(read_file(folder.file(kind.file)) == first);
    }
    CHECK(contains(run_command("build '" + file + "' --emit llvm -o /dev/null").err, "no regular file"));
}

TEST_CASE("a shader gets a texture under the name of its file")
{
    const Folder folder;
    const std::string file = folder.write("ripples.haptel", ripples);
    const Ran built = run_command("build '" + file + "' --emit glsl -o " + quoted_file(folder, "rings.glsl"));
    REQUIRE(built.code == 0);
    std::ifstream in(folder.file("rings.glsl"));
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    CHECK(text.starts_with("// rings: "));
    for (const char* declared : {"struct haptel_block_ripples {", "haptel_defaults_ripples", "haptel_height_ripples(",
                                 "haptel_height_gradient_ripples("})
        CHECK(text.find(declared) != std::string::npos);
    CHECK(text.find("\n#version") == std::string::npos); // it is the shader's
}

TEST_CASE("the intermediate representation of a texture reads back as itself, and shows its derivatives")
{
    const Folder folder;
    const std::string file = folder.write("ripples.haptel", ripples);
    const std::string out = folder.file("ripples.ir");
    REQUIRE(run_command("build '" + file + "' --emit ir -o '" + out + "'").code == 0);
    const std::string text = read_file(out);
    CHECK(contains(text, "texture \"ripples\" {"));
    CHECK(contains(text, "  height_gradient \""));
    const auto module = haptel::ir::parse(text);
    REQUIRE(module.module);
    CHECK(haptel::ir::print(*module.module) == text);
}

TEST_CASE("an option that would change nothing of what is emitted is refused, with what it changes")
{
    const Folder folder;
    const std::string file = folder.write("ripples.haptel", ripples), out = folder.file("out");
    const auto refused = [&](const std::string& options) {
        const Ran ran = run_command("build '" + file + "' -o '" + out + "' --emit " + options);
        CHECK(ran.code == 2);
        CHECK_FALSE(std::filesystem::exists(out));
        return ran.err;
    };
    for (const char* emit : {"header", "c", "ir"}) {
        CAPTURE(emit);
        const std::string said = refused(emit + std::string(" --isa baseline"));
        CHECK(contains(said, "--isa changes nothing of --emit " + std::string(emit)));
        CHECK(contains(said, "leave it out, or emit one of object, static, shared, asm, llvm"));
    }
    for (const char* emit : {"header", "ir"})
        CHECK(contains(refused(emit + std::string(" --precision f32")), "emit one of object, static, shared, c, asm"));
    const Ran header = run_command("build '" + file + "' -o '" + out + "' --emit header --json");
    REQUIRE(header.code == 0);
    CHECK_FALSE(nlohmann::json::parse(header.out).contains("isa"));
}

TEST_CASE("a folder becomes one library, and FILE:NAME one texture of it")
{
    const Folder folder;
    folder.write("one.haptel", "texture a() { return 1um; }\ntexture b() { return 2um; }\n");
    folder.write("two.haptel", "texture c() { return 3um; }\n");
    const std::string out = quoted_file(folder, "all.h");
    REQUIRE(run_command("build '" + folder.path.string() + "' --emit header -o " + out).code == 0);
    const std::string all = read_file(folder.file("all.h"));
    for (const char* name : {"haptel_texture_a;", "haptel_texture_b;", "haptel_texture_c;"}) CHECK(contains(all, name));
    REQUIRE(run_command("build " + quoted_file(folder, "one.haptel:b") + " --emit c -o " + out).code == 0);
    CHECK_FALSE(contains(read_file(folder.file("all.h")), "haptel_texture_a"));

    folder.write("three.haptel", "texture b() { return 4um; }\n");
    const Ran twice = run_command("build '" + folder.path.string() + "' --emit header -o " + out);
    CHECK(twice.code == 1);
    CHECK(contains(twice.err, "both have a texture 'b'"));
}

TEST_CASE("a rule for make names all that a library was made from")
{
    const Folder folder;
    folder.write("my part.haptel", "float f(float x) { return 2.0 * x; }\n");
    const std::string file =
        folder.write("t.haptel", "import \"my part.haptel\";\ntexture t() { return 1um * f(1.0); }\n");
    const std::string out = folder.file("t.h"), rule = folder.file("t.d");
    REQUIRE(run_command("build '" + file + "' --emit header -o '" + out + "' --depfile '" + rule + "'").code == 0);
    std::string part = folder.file("my part.haptel");
    part.insert(part.find(' '), "\\");
    CHECK(read_file(rule) == out + ": \\\n " + file + " \\\n " + part + "\n");
}

TEST_CASE("what cannot be built leaves the file as it was, and says why")
{
    const Folder folder;
    const std::string good = folder.write("good.haptel", "texture t() { return 1um; }\n"),
                      bad = folder.write("bad.haptel", "texture t() { return 1um }\n"),
                      none = folder.write("none.haptel", "float f(float x) { return x; }\n");
    const std::string out = folder.write("out", "as it was");
    const auto build = [&](const std::string& arguments) { return run_command("build " + arguments); };
    CHECK(build("'" + bad + "' --emit object -o '" + out + "'").code == 1);
    const Ran nothing = build("'" + none + "' --emit object -o '" + out + "'");
    CHECK(nothing.code == 1);
    CHECK(contains(nothing.err, "holds no texture"));
    CHECK(build("'" + folder.file("absent.haptel") + "' --emit object -o '" + out + "'").code == 1);
    CHECK(read_file(out) == "as it was");
    const Ran nowhere = build("'" + good + "' --emit object -o '" + folder.file("no/where.o") + "'");
    CHECK(nowhere.code == 1);
    CHECK(contains(nowhere.err, "make it first"));
    const Ran no_linker = run_command("build '" + good + "' --emit shared -o '" + out + "'", "CC=no-such-compiler");
    CHECK(no_linker.code == 1);
    CHECK(contains(no_linker.err, "'no-such-compiler' cannot be started"));
    for (const char* misuse : {"--emit binary -o x", "--emit object", "-o x", "--emit object -o x --isa mmx",
                               "--emit c -o x --precision mixed"}) {
        CAPTURE(misuse);
        CHECK(build("'" + good + "' " + misuse).code == 2);
    }
}

TEST_CASE("an object for another processor is one")
{
    const Folder folder;
    const std::string file = folder.write("t.haptel", ripples), out = folder.file("t.o");
    const Ran built = run_command("build '" + file + "' --emit object --isa aarch64 -o '" + out + "'");
    if (contains(built.err, "without a code generator")) return;
    REQUIRE(built.code == 0);
    const std::string object = read_file(out);
    REQUIRE(object.size() > 20);
    CHECK(object.substr(1, 3) == "ELF");
    CHECK(static_cast<unsigned char>(object[18]) == 183); // EM_AARCH64
}
