// One mistake makes one message: tokens of the library and the examples left out, doubled and exchanged.
#include "lang/compile.h"
#include "lang/text/lexer.h"
#include "stdlib/stdlib.h"
#include "tests/support/catch.h"
#include "tests/support/haptel_files.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

using namespace haptel;

namespace {

std::vector<std::string> texts_of(const char* folder)
{
    std::vector<std::string> texts;
    for (const auto& path : test::haptel_files({folder})) {
        std::ostringstream text;
        text << std::ifstream(path).rdbuf();
        texts.push_back(text.str());
    }
    return texts;
}

std::vector<lang::PlacedToken> tokens_of(const std::string& text)
{
    lang::SourceSet sources;
    lang::Diagnostics none;
    std::vector<lang::PlacedToken> tokens = lang::lex(sources, sources.add({"t.haptel", text}), none).tokens;
    tokens.pop_back(); // the end
    return tokens;
}

size_t errors_in(const std::string& text)
{
    lang::CompileOptions options;
    for (const stdlib::LibraryFile& file : stdlib::library())
        options.library.push_back({std::string(file.name), std::string(file.text)});
    const lang::CompileResult result = lang::compile({"t.haptel", text}, options);
    return static_cast<size_t>(
        std::ranges::count(result.diagnostics.all(), lang::Severity::error, &lang::Diagnostic::severity));
}

} // namespace

TEST_CASE("one mistake in a texture makes one message")
{
    size_t mistaken = 0, single = 0, place = 0;
    for (const char* folder : {"stdlib/tests", "examples/textures"})
        for (const std::string& text : texts_of(folder)) {
            REQUIRE(errors_in(text) == 0);
            const std::vector<lang::PlacedToken> tokens = tokens_of(text);
            for (size_t i = 0; i + 1 < tokens.size(); i += 11) {
                const auto [kind, begin, end] = tokens[i];
                const auto [next_kind, next_begin, next_end] = tokens[i + 1];
                const std::string token = text.substr(begin, end - begin),
                                  next = text.substr(next_begin, next_end - next_begin);
                std::string changed = text;
                switch (place++ % 3) {
                case 0: changed.replace(begin, end - begin, " "); break;
                case 1: changed.insert(end, " " + token); break;
                case 2: changed.replace(begin, next_end - begin, next + " " + token); break;
                }
                const size_t found = errors_in(changed);
                mistaken += found > 0;
                single += found == 1;
                CAPTURE(changed);
                CHECK(found <= 3);
            }
        }
    CAPTURE(single, mistaken);
    CHECK(mistaken > 300);
    CHECK(static_cast<double>(single) > 0.94 * static_cast<double>(mistaken));
}
