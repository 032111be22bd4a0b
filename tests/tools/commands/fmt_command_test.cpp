// haptel fmt: that the style never changes what a text means, and what happens to files.
#include "lang/compile.h"
#include "lang/format/format.h"
#include "lang/ir/print.h"
#include "stdlib/stdlib.h"
#include "tests/fuzz/random_source.h"
#include "tests/support/catch.h"
#include "tests/support/haptel_files.h"
#include "tests/support/project_path.h"
#include "tests/support/tries.h"
#include "tests/tools/commands/run_command.h"

#include <sys/stat.h>

using namespace haptel;
using namespace haptel::test;

namespace {

// All that the compiler makes of a text, and says of it, but for places.
std::string meaning(const std::string& name, const std::string& text, bool with_library)
{
    lang::CompileOptions options;
    if (with_library)
        for (const stdlib::LibraryFile& file : stdlib::library())
            options.library.push_back({std::string(file.name), std::string(file.text)});
    const lang::CompileResult result = lang::compile({name, text}, options);
    std::string all = result.program ? ir::print(result.program->module) : "";
    for (const lang::Diagnostic& said : result.diagnostics.all()) all += said.code + ": " + said.message + "\n";
    return all;
}

std::string formatted(const std::string& text)
{
    lang::SourceSet sources;
    const uint32_t file = sources.add({"t.haptel", text});
    lang::Diagnostics diagnostics;
    return lang::format(sources, file, diagnostics).value_or("");
}

} // namespace

TEST_CASE("fmt: what a file means is what its formatted text means, and formatting twice changes nothing")
{
    size_t files = 0;
    for (const char* folder : {"stdlib", "stdlib/tests", "examples/textures", "tests/lang/golden"}) {
        const bool is_library = std::string(folder) == "stdlib", is_golden = std::string(folder) == "tests/lang/golden";
        for (const std::filesystem::path& path : test::haptel_files({folder})) {
            const std::string text = read_file(path), result = formatted(text);
            if (result.empty()) continue; // syntax errors, on purpose
            CAPTURE(path);
            ++files;
            CHECK(formatted(result) == result);
            CHECK(meaning(path, text, !is_library && !is_golden) == meaning(path, result, !is_library && !is_golden));
        }
    }
    CHECK(files > 30);
}

TEST_CASE("fmt: the library and the examples are in its style")
{
    for (const char* folder : {"stdlib", "stdlib/tests", "examples/textures"}) {
        const Ran ran = run_command("fmt --check " + project_path(folder) + "/*.haptel");
        CAPTURE(folder, ran.out, ran.err);
        CHECK(ran.code == 0);
    }
}

TEST_CASE("fmt: random programs mean what they meant")
{
    for (uint64_t seed = 1; seed <= tries(300u); ++seed) {
        const std::string text = fuzz::random_source(2 * seed), result = formatted(text);
        CAPTURE(text, result);
        REQUIRE(result != "");
        REQUIRE(formatted(result) == result);
        REQUIRE(meaning("t.haptel", text, false) == meaning("t.haptel", result, false));
    }
}

TEST_CASE("fmt: replaces a file, keeps its permissions, and says so; a second time there is nothing to do")
{
    const Folder folder;
    const std::string file = folder.write("a.haptel", "texture t(){return 1mm;}");
    chmod(file.c_str(), 0640);
    const Ran check = run_command("fmt --check '" + file + "'");
    CHECK(check.code == 1);
    CHECK(contains(check.err, "would change"));
    CHECK(read_file(file) == "texture t(){return 1mm;}");
    const Ran first = run_command("fmt '" + file + "'");
    CHECK(first.code == 0);
    CHECK(contains(first.err, "formatted"));
    CHECK(read_file(file) == "texture t()\n{\n    return 1mm;\n}\n");
    CHECK((std::filesystem::status(file).permissions() & std::filesystem::perms::mask) == std::filesystem::perms(0640));
    const Ran second = run_command("fmt '" + file + "'");
    CHECK(second.code == 0);
    CHECK(second.err.empty());
    CHECK(run_command("fmt --check '" + file + "'").code == 0);
}

TEST_CASE(
    "fmt: --upgrade writes the version, and refuses a text of a version to come, which the file or its library names")
{
    const Folder folder;
    const std::string file = folder.write("a.haptel", "/// Flat.\ntexture t(){return 1mm;}");
    CHECK(run_command("fmt --upgrade --check '" + file + "'").code == 1);
    CHECK(run_command("fmt --upgrade '" + file + "'").code == 0);
    const std::string with_version = "language 1;\n\n/// Flat.\ntexture t()\n{\n    return 1mm;\n}\n";
    CHECK(read_file(file) == with_version);
    CHECK(run_command("fmt --upgrade --check '" + file + "'").code == 0);
    CHECK(run_command("check --strict '" + file + "'").code == 0);

    const std::string later = folder.write("later.haptel", "language 9;\ntexture t() { return 1mm; }\n");
    const Ran refused = run_command("fmt --upgrade '" + later + "'");
    CHECK(refused.code == 1);
    CHECK(contains(refused.err, "later.haptel:1:10: error: this file is written in version 9 of the language"));
    folder.write("library.toml",
                 "schema = 1\nname = \"wood\"\nversion = \"1.0.0\"\ntagline = \"T\"\nauthors = [\"A\"]\n"
                 "license = \"MIT\"\ntextures = [\"a:t\"]\nhaptel = \"0.1\"\nlanguage = 8\n");
    const std::string silent = folder.write("silent.haptel", "texture t() { return 1mm; }\n");
    CHECK(contains(run_command("fmt --upgrade '" + silent + "'").err, "written in version 8 of the language"));
    CHECK(run_command("fmt --upgrade --check '" + file + "'").code == 0); // which says its own
}

TEST_CASE("fmt: --stdout prints and leaves the file alone")
{
    const Folder folder;
    const std::string file = folder.write("a.haptel", "const float A=1.0;");
    const Ran ran = run_command("fmt --stdout '" + file + "'");
    CHECK(ran.code == 0);
    CHECK(ran.out == "const float A = 1.0;\n");
    CHECK(read_file(file) == "const float A=1.0;");
}

TEST_CASE("fmt: a file with a mistake is shown and left alone, the others are done")
{
    const Folder folder;
    const std::string bad = folder.write("bad.haptel", "texture t( { return 1mm }");
    const std::string good = folder.write("good.haptel", "const float A=1.0;");
    const Ran ran = run_command("fmt '" + bad + "' '" + good + "' '" + folder.file("none.haptel") + "'");
    CHECK(ran.code == 1);
    CHECK(contains(ran.err, "bad.haptel:1:"));
    CHECK(contains(ran.err, "none.haptel"));
    CHECK(read_file(bad) == "texture t( { return 1mm }");
    CHECK(read_file(good) == "const float A = 1.0;\n");
    CHECK(run_command("fmt").code == 2);
}
