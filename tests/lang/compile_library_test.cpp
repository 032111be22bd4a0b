// The library beside a program: who sees it, what of it is read, and who shares it.
#include "lang/check/library.h"
#include "lang/compile.h"
#include "lang/ir/print.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <atomic>
#include <thread>

using namespace haptel;
using namespace haptel::lang;

TEST_CASE("compile: the library is seen by all, lowered only where it is reached, and can be replaced")
{
    CompileOptions options;
    options.library = {
        {"library/base.haptel", "/// @facts value -1 .. 1, slope 2, curvature 3, class C1\nfloat base(vec3 q) { return "
                                "sin(q.x); }\nconst float K = 2.0;\n"},
        {"library/over.haptel",
         "float over(vec3 q) { return K * base(q); }\nfloat never(vec3 q, float unused) { return q.x; }\n"}};
    CompileResult result = compile({"main.haptel", "texture t() { return 1mm * over(p / 1mm); }"}, options);
    REQUIRE(result.program);
    CHECK(result.diagnostics.all().empty()); // no warnings about what is not the user's
    CHECK(result.files == std::vector<std::string>{"main.haptel"});
    const auto named = [&](const std::string& name) {
        const auto& functions = result.program->module.functions;
        return std::find_if(functions.begin(), functions.end(), [&](const auto& f) { return f.name == name; });
    };
    CHECK(named("never(vec3,float)") == result.program->module.functions.end());
    const auto base = named("base(vec3)");
    REQUIRE(base != result.program->module.functions.end());
    CHECK(base->first_argument_size == 3);
    CHECK(base->facts[0].proven);
    CHECK(base->facts[0].value_minimum == -1.0);
    CHECK(base->facts[0].value_maximum == 1.0);
    CHECK(base->facts[0].slope == 2.0);
    CHECK(base->facts[0].curvature == 3.0);
    CHECK(base->facts[0].continuity == ir::Continuity::c1);

    // The user's base is used by the user; the library goes on with its own.
    result = compile({"main.haptel", "float base(vec3 q) { return 7.0; }\ntexture t() { return base(p) + over(p); }"},
                     options);
    REQUIRE(result.program);
    std::vector<std::string> notes;
    for (const Diagnostic& d : result.diagnostics.all())
        if (d.severity == Severity::note) notes.push_back(d.code);
    CHECK(notes == std::vector<std::string>{"replaces-library"});
    CHECK(named("base(vec3)") != result.program->module.functions.end());
    CHECK(named("base(vec3) #2") != result.program->module.functions.end());
    const std::string text = ir::print(result.program->module);
    CHECK(text.find("real 7") != std::string::npos);
    CHECK(text.find("sin") != std::string::npos);
}

TEST_CASE("compile: programs share the library and do not change it for one another")
{
    CompileOptions options;
    options.library = {{"library/base.haptel", "const float K = 2.0;\nfloat base(vec3 q) { return K * q.x; }\n"}};
    const std::vector<std::string> texts = {
        "texture t() { return 1mm * base(p / 1mm); }",
        "float base(vec3 q) { return 7.0; }\ntexture t() { return 1mm * base(p / 1mm); }",
        "const float K = 5.0;\ntexture t() { return 1mm * K * base(p / 1mm); }",
        "texture t() { return 1mm * bse(p / 1mm); }",
        "float again(vec3 q) { return base(again(q) * q); }\ntexture t() { return 1mm * again(p / 1mm); }"};
    const auto answer = [&](const std::string& text) {
        const CompileResult result = compile({"main.haptel", text}, options);
        return render(result.diagnostics.all(), result.sources) +
               (result.program ? ir::print(result.program->module) : "");
    };
    std::vector<std::string> alone;
    for (const std::string& text : texts) {
        answer("texture other() { return 1mm; }");
        alone.push_back(answer(text));
    }
    CHECK(alone[3].find("did you mean 'base'?") != std::string::npos);
    CHECK(alone[4].find("ends up calling itself") != std::string::npos);
    // All of them at once, many times.
    std::atomic<size_t> differences = 0;
    std::vector<std::thread> threads;
    for (size_t i = 0; i < 4; ++i)
        threads.emplace_back([&, i] {
            for (size_t round = 0; round < 20; ++round) {
                const size_t which = (round + i) % texts.size();
                differences += answer(texts[which]) != alone[which];
            }
        });
    for (std::thread& thread : threads) thread.join();
    CHECK(differences == 0);

    // Another text of the library is another library; what is wrong with it is said with every program.
    options.library[0].text = "const float K = 3.0;\nfloat base(vec3 q) { return K * q.x; }\n";
    CHECK(answer(texts[0]) != alone[0]);
    options.library[0].text = "float base(vec3 q) { return q; }\n";
    for (size_t i = 0; i < 2; ++i) {
        const std::string said = answer(texts[0]);
        INFO(said);
        CHECK(said.find("library/base.haptel:1:29: error:") != std::string::npos);
    }
    options.library[0].text = "const float K = 2.0;\nfloat base(vec3 q) { return K * q.x; }\n";
    CHECK(answer(texts[0]) == alone[0]);
}

TEST_CASE("compile: of the library only what is named is read, and what that calls")
{
    const std::vector<SourceFile> texts = {
        {"library/a.haptel",
         "/// Of a.\n/// @facts value 0 .. 1\nfloat a(vec3 q) { return B * c(q); }\n"
         "float a(vec2 q) { return q.x; }\n// d in a comment\nfloat unused(vec3 q) { return d(q); }\n"},
        {"library/b.haptel", "const float B = 2.0, E[2] = float[](1.0, 2.0);\nfloat c(vec3 q) { return E[0] * q.x; }\n"
                             "float d(vec3 q) { for (int i = 0; i < 2; ++i) { } return q.x; }\n"
                             "const int F[] = {1, 2};\n"}};
    const auto read = [](const std::shared_ptr<const CheckedLibrary>& library) {
        std::string names;
        for (const auto& [name, overloads] : library->declarations.functions)
            names += name + ":" + std::to_string(overloads.size()) + " ";
        for (const auto& [name, symbol] : library->declarations.constants) names += name + " ";
        return names;
    };
    CHECK(read(checked_library(texts, {"F"})) == "F ");
    const auto first = checked_library(texts, {"c"});
    CHECK(read(first) == "c:1 B E F ");
    CHECK(checked_library(texts, {"B", "nobody"}) == first); // what has been read is there
    const auto second = checked_library(texts, {"a"});
    CHECK(read(second) == "a:2 c:1 B E F ");
    CHECK(second->declarations.functions.at("a")[0]->tree->doc == "Of a.");
    CHECK(second->declarations.functions.at("a")[0]->tree->facts->value_maximum == 1.0);
    CHECK(!second->is_whole);
    const auto whole = whole_library(texts);
    CHECK(whole->is_whole);
    CHECK(read(whole) == "a:2 c:1 d:1 unused:1 B E F ");
    CHECK(whole_library(texts) == whole);

    // Other texts are another library. Who mistypes a name is told of all that there are.
    CompileOptions options;
    options.library = {texts[0], texts[1], {"library/none.haptel", ""}};
    CHECK(read(checked_library(options.library, {})).empty());
    const CompileResult mistyped = compile({"main.haptel", "texture t() { return 1mm * unsed(p / 1mm); }"}, options);
    CHECK(render(mistyped.diagnostics.all(), mistyped.sources).find("did you mean 'unused'?") != std::string::npos);
    CHECK(checked_library(options.library, {})->is_whole);
}

TEST_CASE("compile: mistakes in the library are told where they are read, and where they are in nothing's way")
{
    CompileOptions options;
    const auto said = [&](const std::string& library) {
        options.library = {{"library/a.haptel", library}};
        const CompileResult result = compile({"main.haptel", "texture t() { return 1mm * a(p / 1mm); }"}, options);
        return render(result.diagnostics.all(), result.sources);
    };
    const std::string good = "float a(vec3 q) { return q.x; }\n";
    CHECK(said(good).empty());
    CHECK(said(good + "float wrong(vec3 q) { return q; }\n").empty());
    CHECK(said(good + "float a(vec2 q) { return q; }\n").find("library/a.haptel:2:") != std::string::npos);
    CHECK(said(good + "}\n").find("library/a.haptel:2:1") != std::string::npos);
    CHECK(said(good + "float a(vec2 q) { return (q.x; }\n").find("library/a.haptel:2:") != std::string::npos);
    CHECK(said("float $;\n" + good).find("library/a.haptel:1:7") != std::string::npos);
}
