#include "tools/library/reference.h"

#include "lang/program/scope.h"
#include "lang/syntax/parser.h"
#include "lang/text/lexer.h"
#include "stdlib/stdlib.h"

#include <algorithm>

namespace haptel::tools {

namespace {

// Runs of space are one.
std::string in_one_line(std::string_view text)
{
    std::string line;
    for (const char c : text) {
        const bool space = c == ' ' || c == '\n' || c == '\r' || c == '\t';
        if (!space) line += c;
        if (space && !line.empty() && line.back() != ' ') line += ' ';
    }
    while (line.ends_with(' ')) line.pop_back();
    return line;
}

std::string stem(std::string_view file)
{
    return std::string(file.substr(0, file.rfind('.')));
}

struct TestTexture {
    Example example;
    std::vector<std::string> names; // in its body
};

std::vector<TestTexture> test_textures()
{
    std::vector<TestTexture> all;
    for (const stdlib::LibraryFile& file : stdlib::tests()) {
        lang::SourceSet sources;
        const uint32_t index = sources.add({std::string(file.name), std::string(file.text)});
        lang::Diagnostics diagnostics;
        const lang::ast::File tree = lang::parse(sources, index, diagnostics);
        for (const lang::ast::Texture& texture : tree.textures) {
            TestTexture& made = all.emplace_back();
            if (!texture.body) continue;
            for (const lang::PlacedToken& token : lang::lex(sources, texture.body->span, diagnostics).tokens)
                if (token.kind == lang::Token::name)
                    made.names.emplace_back(sources.text({index, token.begin, token.end}));
            const auto reads = [&](std::string_view name) {
                return std::find(made.names.begin(), made.names.end(), name) != made.names.end();
            };
            std::string helpers; // the file's own functions that it calls
            for (const lang::ast::Function& function : tree.functions)
                if (reads(function.name.text)) helpers += std::string(sources.text(function.span)) + "\n\n";
            made.example = {stem(file.name), texture.name.text, helpers + std::string(sources.text(texture.span)),
                            !reads("footprint_in")};
        }
    }
    return all;
}

// Of the tests of its own file if there is one, and the shortest, which says most about the function itself.
std::optional<Example> example_of(const Entry& entry, const std::vector<TestTexture>& textures)
{
    const TestTexture* best = nullptr;
    const auto better = [&](const TestTexture& a, const TestTexture& b) {
        const bool own_a = a.example.file == entry.group, own_b = b.example.file == entry.group;
        return own_a != own_b ? own_a : a.example.text.size() < b.example.text.size();
    };
    for (const TestTexture& texture : textures) {
        if (std::find(texture.names.begin(), texture.names.end(), entry.name) == texture.names.end()) continue;
        if (!best || better(texture, *best)) best = &texture;
    }
    return best ? std::optional(best->example) : std::nullopt;
}

void add_library_file(const stdlib::LibraryFile& file, std::vector<Entry>& entries)
{
    lang::SourceSet sources;
    const uint32_t index = sources.add({std::string(file.name), std::string(file.text)});
    lang::Diagnostics diagnostics;
    const lang::ast::File tree = lang::parse(sources, index, diagnostics);
    std::optional<uint32_t> last; // of one that is read for several sizes, the first
    for (const lang::ast::Function& function : tree.functions) {
        if (function.doc.empty() || !function.body || last == function.span.begin) continue;
        last = function.span.begin;
        Overload overload;
        overload.signature = in_one_line(sources.text({index, function.span.begin, function.body->span.begin}));
        overload.doc = function.doc;
        if (function.facts) {
            const ir::Facts& facts = *function.facts;
            std::string_view text = sources.text(facts.span);
            if (const size_t marker = text.find("@facts"); marker != text.npos) text.remove_prefix(marker + 6);
            overload.facts = Facts{facts.value_minimum,
                                   facts.value_maximum,
                                   facts.slope,
                                   facts.curvature,
                                   std::string(facts.continuity ? to_string(*facts.continuity) : ""),
                                   in_one_line(text.substr(text.find_first_not_of(' ')))};
        }
        const auto known = std::find_if(entries.begin(), entries.end(),
                                        [&](const Entry& entry) { return entry.name == function.name.text; });
        if (known != entries.end())
            known->overloads.push_back(std::move(overload));
        else
            entries.push_back({function.name.text, stem(file.name), {std::move(overload)}, std::nullopt});
    }
}

} // namespace

std::string Entry::summary() const
{
    const std::string doc = in_one_line(overloads.front().doc);
    size_t end = doc.find(". ");
    while (end != std::string::npos && end > 0 && doc[end - 1] == '.') end = doc.find(". ", end + 1); // 0 .. 1
    return end == std::string::npos ? doc : doc.substr(0, end + 1);
}

std::vector<Entry> reference()
{
    std::vector<Entry> entries;
    for (const stdlib::LibraryFile& file : stdlib::library()) add_library_file(file, entries);
    const std::vector<TestTexture> textures = test_textures();
    for (Entry& entry : entries) entry.example = example_of(entry, textures);
    std::vector<std::string_view> seen;
    for (const lang::Builtin& builtin : lang::all_builtins()) {
        if (std::find(seen.begin(), seen.end(), builtin.name) != seen.end()) continue;
        seen.push_back(builtin.name);
        Entry entry{std::string(builtin.name), std::string(built_in_group), {}, std::nullopt};
        for (const lang::BuiltinOverload& overload : lang::builtin_overloads(builtin.name))
            entry.overloads.push_back(
                {lang::to_string(lang::Candidate(overload)), std::string(overload.builtin->doc), std::nullopt});
        entries.push_back(std::move(entry));
    }
    return entries;
}

} // namespace haptel::tools
