// --fix: which fixes are taken, that nothing gets worse, and how the file is replaced.
#include "tests/support/catch.h"
#include "tests/support/project_path.h"
#include "tests/tools/commands/run_command.h"
#include "tools/check/fixes.h"
#include "tools/output/replace_file.h"

#include <sys/stat.h>

using namespace haptel;
using namespace haptel::test;
using namespace haptel::tools;

namespace {

struct Proposed {
    uint32_t begin, end;
    std::string replacement;
};

// What a compiler would say of `text` that finds these errors, each with its fix.
lang::CompileResult found(const std::string& text, const std::vector<Proposed>& proposals, size_t more_errors = 0)
{
    lang::CompileResult result;
    result.sources.add({"t.haptel", text});
    for (const Proposed& p : proposals)
        result.diagnostics.error({0, p.begin, p.end}, "syntax", "x").fix =
            lang::FixIt{{0, p.begin, p.end}, p.replacement};
    for (uint32_t i = 0; i < more_errors; ++i) result.diagnostics.error({0, 1000 + i, 1001 + i}, "syntax", "x");
    return result;
}

std::string once(const std::string& text, const std::vector<Proposed>& proposals)
{
    return apply_fixes(text, fixes_of(found(text, proposals)));
}

lang::CompileResult compiled(const std::string& text)
{
    return lang::compile({"t.haptel", text}, {});
}

size_t errors(const lang::CompileResult& result)
{
    size_t count = 0;
    for (const lang::Diagnostic& d : result.diagnostics.all()) count += d.severity == lang::Severity::error;
    return count;
}

} // namespace

TEST_CASE("fixes: from the beginning on, the first of those that overlap")
{
    CHECK(once("abcdef", {{4, 5, "E"}, {1, 2, "B"}}) == "aBcdEf");
    CHECK(once("abcdef", {{1, 4, "X"}, {2, 3, "Y"}, {4, 4, "Z"}}) == "aXZef");
    CHECK(once("abcdef", {{0, 0, "<"}, {6, 6, ">"}}) == "<abcdef>");
    CHECK(once("abcdef", {{2, 4, ""}, {3, 6, "X"}}) == "abef");
    CHECK(once("abc", {{1, 9, "outside of the text"}}) == "abc");
    CHECK(once("abc", {}) == "abc");
}

TEST_CASE("fixes: what is hidden behind a mistake is mended in the next round")
{
    const auto compile = [](const std::string& text) {
        if (text == "aaa") return found(text, {{0, 1, "b"}});
        if (text == "baa") return found(text, {{1, 2, "b"}});
        return found(text, {});
    };
    const Mended mended = mend("aaa", compile);
    CHECK(mended.text == "bba");
    CHECK(mended.applied == 2);
    CHECK(mended.left_out == 0);
}

TEST_CASE("fixes: one that leads to more mistakes is left out, the others are taken")
{
    const auto compile = [](const std::string& text) {
        std::vector<Proposed> proposals;
        if (text[0] == 'a') proposals.push_back({0, 1, "x"});
        if (text[1] == 'b') proposals.push_back({1, 2, "y"});
        return found(text, proposals, text[0] == 'x' ? 3 : 0);
    };
    const Mended mended = mend("ab", compile);
    CHECK(mended.text == "ay");
    CHECK(mended.applied == 1);
    CHECK(mended.left_out == 1);
}

TEST_CASE("fixes: those that lead in a circle, or on without end, end")
{
    const auto circle = [](const std::string& text) { return found(text, {{0, 1, text == "a" ? "b" : "a"}}); };
    CHECK(mend("a", circle).applied == 1);
    const auto growth = [](const std::string& text) { return found(text, {{0, 0, "x"}}); };
    CHECK(mend("", growth).text.size() < 100);
}

TEST_CASE("fixes: line ends, marks and letters beside a fix are kept byte by byte")
{
    const std::string before =
        "\xEF\xBB\xBF// \xC3\xA9t\xC3\xA9\r\ntexture t(float depth = 1mm)\r\n{\r\n\t/* \xE2\x9C\x93 */ "
        "return dpeth;\r\n}";
    std::string after = before;
    after.replace(after.find("dpeth"), 5, "depth");
    CHECK(mend(before, compiled).text == after);
}

TEST_CASE("fixes: of every example and golden file, none makes it worse, and a second run finds nothing more")
{
    std::vector<std::string> texts;
    for (const lang::DiagnosticInfo& info : lang::all_diagnostics) texts.emplace_back(info.wrong);
    for (const auto& entry : std::filesystem::directory_iterator(project_path("tests/lang/golden")))
        texts.push_back(read_file(entry.path()));
    size_t fixed = 0;
    for (const std::string& text : texts) {
        CAPTURE(text);
        const Mended mended = mend(text, compiled);
        CHECK(errors(compiled(mended.text)) <= errors(compiled(text)));
        const Mended again = mend(mended.text, compiled);
        CHECK(again.text == mended.text);
        CHECK(again.applied == 0);
        fixed += mended.applied;
    }
    CHECK(fixed > 50);
}

TEST_CASE("a file is replaced whole: through links, with its permissions, and with nothing left beside it")
{
    const Folder folder;
    const std::string file = folder.write("a.haptel", "old");
    REQUIRE(chmod(file.c_str(), 0640) == 0);
    std::filesystem::create_symlink(file, folder.file("link.haptel"));
    CHECK(replace_file(folder.file("link.haptel"), "new\r\n") == "");
    CHECK(read_file(file) == "new\r\n");
    CHECK(std::filesystem::is_symlink(folder.file("link.haptel")));
    struct stat after = {};
    REQUIRE(stat(file.c_str(), &after) == 0);
    CHECK((after.st_mode & 07777) == 0640);
    CHECK(std::distance(std::filesystem::directory_iterator(folder.path), {}) == 2);

    CHECK(!replace_file(folder.file("nowhere.haptel"), "x").empty());
    CHECK(!std::filesystem::exists(folder.file("nowhere.haptel")));
    CHECK(!replace_file(folder.path.string(), "x").empty()); // a folder is no file
    CHECK(std::distance(std::filesystem::directory_iterator(folder.path), {}) == 2);
}
