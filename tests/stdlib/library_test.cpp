// The library as a whole: what it offers is documented, tried and right.
#include "jit/check/check_gradient.h"
#include "jit/texture/texture.h"
#include "lang/check/library.h"
#include "lang/ir/print.h"
#include "lang/syntax/parser.h"
#include "stdlib/stdlib.h"
#include "tests/support/catch.h"
#include "tests/support/haptel_files.h"
#include "tests/support/project_path.h"

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

using namespace haptel;

namespace {

std::string read(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

lang::ast::File parsed(const std::string& name, std::string text)
{
    lang::SourceSet sources;
    lang::Diagnostics diagnostics;
    sources.add({name, std::move(text)});
    lang::ast::File file = lang::parse(sources, 0, diagnostics);
    INFO(lang::render(diagnostics.all(), sources));
    REQUIRE(diagnostics.all().empty());
    return file;
}

std::string signature(const lang::ast::Function& function)
{
    std::string text = function.name.text + "(";
    for (const lang::ast::FunctionParameter& parameter : function.parameters) {
        if (text.back() != '(') text += ",";
        text += parameter.type.base.text + (parameter.is_function ? "()" : "");
    }
    return text + ")";
}

} // namespace

TEST_CASE("the embedded text is the text of the files")
{
    CHECK(stdlib::library().size() == test::haptel_files({"stdlib"}).size());
    for (const stdlib::LibraryFile& file : stdlib::library()) {
        CAPTURE(file.name);
        CHECK(file.text == read(test::project_path("stdlib/" + std::string(file.name))));
    }
}

TEST_CASE("every documented function of the library is called by a texture of stdlib/tests")
{
    // The functions that the textures' modules hold: what is called, and what that calls.
    std::set<std::string> called;
    for (const std::filesystem::path& path : test::haptel_files({"stdlib/tests"})) {
        const jit::CompiledTextures compiled = jit::compile_texture_file(path.string());
        INFO(compiled.rendered());
        REQUIRE(compiled.program);
        CHECK(compiled.diagnostics.all().empty());
        for (const ir::Function& function : compiled.program->module().functions) {
            std::string name = function.name.substr(0, function.name.find_first_of("<["));
            if (name.ends_with(" ")) name.pop_back();
            for (const std::string made : {"d ", "resolved "}) // what is made of a function stands for it
                if (name.starts_with(made)) name.erase(0, made.size());
            called.insert(name + " ");
        }
    }
    std::string all;
    for (const std::string& name : called) all += name + "\n";
    size_t documented = 0;
    for (const stdlib::LibraryFile& file : stdlib::library()) {
        const lang::ast::File tree = parsed(std::string(file.name), std::string(file.text));
        for (const lang::ast::Function& function : tree.functions) {
            if (function.doc.empty()) continue;
            ++documented;
            INFO(signature(function) << " in\n" << all);
            CHECK((called.count(signature(function) + " ") || called.count(function.name.text + " ")));
            CHECK(function.doc.size() > 10);
        }
    }
    CHECK(documented > 40);
}

TEST_CASE("library and examples: gradients are those of the heights, heights stay within their bounds")
{
    const auto [footprint_m, folder] = GENERATE(table<double, std::string>(
        {{0.0, "stdlib/tests"}, {0.0, "examples/textures"}, {0.6e-3, "stdlib/tests"}, {0.6e-3, "examples/textures"}}));
    {
        for (const std::filesystem::path& path : test::texture_files({folder})) {
            const jit::CompiledTextures compiled = jit::compile_texture_file(path.string());
            INFO(compiled.rendered());
            REQUIRE(compiled.program);
            for (const haptel_texture& texture : compiled.program->textures()) {
                CAPTURE(path.filename().string(), texture.name, footprint_m);
                jit::CheckBox box;
                TextureRequest request;
                request.footprint_m = footprint_m;
                for (int a = 0; a < 3; ++a) {
                    request.box_minimum_m[a] = box.minimum_m[a];
                    request.box_maximum_m[a] = box.maximum_m[a];
                }
                const TextureResult result = jit::make_binding(compiled.program, texture.name, request);
                INFO(result.diagnostics);
                REQUIRE(result.binding);
                const jit::GradientCheck check = jit::check_gradient(compiled.program, *result.binding, box, 40);
                std::string failures;
                for (const std::string& failure : check.failures) failures += failure + "\n";
                CHECK(failures == "");
            }
        }
    }
}

TEST_CASE("a program is the same whether all of the library has been read or what it names")
{
    const auto options_of = [](const stdlib::LibraryFile& file) {
        lang::CompileOptions options;
        for (const stdlib::LibraryFile& text : stdlib::library())
            options.library.push_back({std::string(text.name), std::string(text.text)});
        options.library.push_back({std::string(file.name), ""}); // so that nothing of this library has been read
        return options;
    };
    const auto printed = [](const stdlib::LibraryFile& file, const lang::CompileOptions& options) {
        const lang::CompileResult result = lang::compile({std::string(file.name), std::string(file.text)}, options);
        REQUIRE(result.program);
        return lang::render(result.diagnostics.all(), result.sources) + ir::print(result.program->module);
    };
    for (const stdlib::LibraryFile& file : stdlib::tests()) {
        CAPTURE(file.name);
        const lang::CompileOptions options = options_of(file);
        const std::string of_part = printed(file, options);
        CHECK(!lang::checked_library(options.library, {})->is_whole);
        lang::whole_library(options.library);
        CHECK(printed(file, options) == of_part);
    }
}
