#include "lang/compile.h"

#include "lang/check/check.h"
#include "lang/check/dimension/check_dimensions.h"
#include "lang/check/library.h"
#include "lang/ir/verify.h"
#include "lang/lower/lower.h"
#include "lang/syntax/language_version.h"
#include "lang/syntax/parser.h"
#include "lang/text/limits.h"
#include "lang/text/near_name.h"

#include <algorithm>
#include <bitset>
#include <map>
#include <set>

namespace haptel::lang {
namespace {

constexpr uint32_t import_max = 256; // files

// Main file, its imports and theirs; parsed, with who imports whom.
struct Files {
    const CompileOptions& options;
    SourceSet& sources;
    Diagnostics& diagnostics;

    std::vector<CheckFile> files = {}; // by Span::file
    std::vector<std::string> names = {};
    Names named = {}; // in any of them

    struct Edge {
        uint32_t from, to;
        Span span;
    };
    std::vector<Edge> edges = {};
    std::map<std::string, uint32_t, std::less<>> by_name = {};
    // By file and path: what is imported again is not read again. Nothing: it could not be read.
    std::map<std::pair<uint32_t, std::string>, std::optional<uint32_t>> asked = {};
    std::set<std::pair<uint32_t, uint32_t>> plain = {}; // file and what it imports without a prefix
    size_t token_count = 0;                             // of all files
    size_t text_bytes = 0; // read for imports, again where a path is written in another way

    void load(SourceFile main)
    {
        add(std::move(main));
        // Breadth first; `files` grows as we go. Files are known by the name the loader gives them.
        for (uint32_t file = 0; file < files.size(); ++file)
            for (size_t i = 0; i < files[file].tree.imports.size() && !diagnostics.full(); ++i) import(file, i);
        report_cycles();
    }

    uint32_t add(SourceFile file)
    {
        const uint32_t index = sources.add(std::move(file));
        TokenList tokens = lex(sources, index, diagnostics, tokens_max - token_count);
        token_count += tokens.count;
        for (const PlacedToken& token : tokens.tokens)
            if (token.kind == Token::name) named.insert(sources.text({index, token.begin, token.end}));
        files.push_back({parse(sources, index, std::move(tokens), diagnostics), {}});
        check_version(files.back().tree.language);
        names.push_back(sources.file(index).name);
        by_name.emplace(sources.file(index).name, index);
        return index;
    }

    void check_version(Span number)
    {
        if (number.begin == number.end) return;
        const VersionFault fault = fault_of_version(sources.text(number));
        if (!fault.message.empty()) diagnostics.error(number, "language-version", fault.message, fault.hint);
    }

    void import(uint32_t file, size_t which)
    {
        const ast::Import import = files[file].tree.imports[which];
        const bool is_told = text_bytes > text_bytes_max || import.path.empty();
        if (is_told) return;
        const auto [place, is_new] = asked.try_emplace({file, import.path});
        if (is_new) place->second = read(file, import);
        if (!place->second) return;
        const CheckFile::Imported made{*place->second, import.prefix.text};
        auto& imported = files[file].imported; // of any prefix there is one
        if (made.prefix.empty() && !plain.emplace(file, made.file).second) return;
        imported.push_back(made);
        edges.push_back({file, made.file, import.span});
    }

    // What the import names; nothing, and reported, if it cannot be read.
    std::optional<uint32_t> read(uint32_t file, const ast::Import& import)
    {
        Imported found(std::nullopt, {}, "this program was given no way to read other files");
        if (options.load_import) found = options.load_import(import.path, sources.file(file).name);
        std::optional<SourceFile>& text = found.file;
        if (!text) {
            const std::string why = found.why.empty() ? "" : ": " + found.why;
            Diagnostic& reported =
                diagnostics.error(import.span, "missing-import", "cannot read \"" + printable(import.path) + "\"" + why,
                                  found.hint.empty() ? "the path is relative to the file that imports" : found.hint);
            const std::string_view name = std::string_view(import.path).substr(import.path.rfind('/') + 1);
            if (std::ranges::find(options.library, name, &SourceFile::name) != options.library.end())
                reported.hint = "the library needs no import: leave it out, and the names have no prefix";
            return std::nullopt;
        }
        text_bytes += text->text.size();
        if (by_name.size() >= import_max || text_bytes > text_bytes_max) {
            diagnostics.error(import.span, "too-large",
                              "expected imports of at most " + std::to_string(import_max) + " files, with " +
                                  std::to_string(text_bytes_max >> 20) + " MiB of text");
            return std::nullopt;
        }
        const auto known = by_name.find(text->name);
        return known != by_name.end() ? known->second : add(std::move(*text));
    }

    // An import that leads back to its own file, by the shortest way there is.
    void report_cycles()
    {
        // Who leads to whom, over any number of imports.
        std::vector<std::bitset<import_max>> leads(files.size());
        for (const Edge& edge : edges) leads[edge.from].set(edge.to);
        for (size_t over = 0; over < files.size(); ++over)
            for (std::bitset<import_max>& from : leads)
                if (from.test(over)) from |= leads[over];
        for (const Edge& edge : edges) {
            if (edge.to != edge.from && !leads[edge.to].test(edge.from)) continue;
            // Breadth first from where the edge leads; by file, the one that it was reached from.
            std::vector<uint32_t> reached{edge.to}, reached_from(files.size(), UINT32_MAX);
            for (size_t i = 0; i < reached.size(); ++i)
                for (const auto& [next, prefix] : files[reached[i]].imported)
                    if (next != edge.to && reached_from[next] == UINT32_MAX) {
                        reached_from[next] = reached[i];
                        reached.push_back(next);
                    }
            std::string cycle = printable(sources.file(edge.from).name);
            for (uint32_t at = edge.from; at != edge.to; at = reached_from[at])
                cycle = printable(sources.file(reached_from[at]).name) + " -> " + cycle;
            diagnostics.error(edge.span, "import-cycle",
                              "this import leads back to its own file: " + printable(sources.file(edge.from).name) +
                                  " -> " + cycle,
                              "move what both need into a third file");
            return; // the others are the same cycle, or wait
        }
    }
};

// With this library; where it is null, with what the files name of it, which is put there.
CompileResult compile(const SourceFile& main, const CompileOptions& options,
                      std::shared_ptr<const CheckedLibrary>& library)
{
    CompileResult result;
    if (library) result.diagnostics = library->diagnostics;
    Files files{options, result.sources, result.diagnostics};
    files.load(main);
    result.files = std::move(files.names);
    if (!library) {
        library = checked_library(options.library, files.named);
        if (library && !library->diagnostics.all().empty()) return result; // to begin anew with what is to be told
    }
    if (library) result.sources.share(library->sources);

    Diagnostics& diagnostics = result.diagnostics;
    const ast::File& tree = files.files.front().tree;
    const bool is_empty = tree.imports.empty() && tree.structs.empty() && tree.constants.empty() &&
                          tree.functions.empty() && tree.textures.empty() && tree.presets.empty();
    if (is_empty && !diagnostics.has_errors())
        diagnostics.warning({}, "empty-file", "expected a texture, found an empty file",
                            "the smallest one is: texture flat() { return 0.0; }");
    const CheckedProgram checked = check(result.sources, std::move(files.files), library, diagnostics);
    if (!options.only_texture.empty()) {
        std::vector<std::string_view> names;
        for (const CheckedTexture& texture : checked.textures) names.push_back(texture.tree->name.text);
        const std::string_view nearest = near_name(options.only_texture, names).name;
        if (std::ranges::find(names, options.only_texture) == names.end())
            diagnostics.error({}, "unknown-texture",
                              "this file has no texture '" + printable(options.only_texture) + "'",
                              nearest.empty() ? "" : "did you mean '" + std::string(nearest) + "'?");
    }
    if (!diagnostics.has_errors() && diagnostics.reports() > 0) // never: what is not said follows from what is
        diagnostics.error({}, "internal-error", "the compiler found a mistake and did not say which");
    if (!diagnostics.has_errors()) check_dimensions(result.sources, checked, diagnostics);
    ir::Module module;
    if (!diagnostics.has_errors()) {
        module = lower(checked, options.only_texture, diagnostics);
        const std::string broken = diagnostics.has_errors() ? "" : ir::verify(module);
        if (!broken.empty()) // a mistake of ours; the program must not run all the same
            diagnostics.error({}, "internal-error",
                              "the compiler made a program that does not pass its own check: " + broken);
    }
    if (options.strict) diagnostics.make_warnings_errors();
    if (!diagnostics.has_errors())
        result.program = std::make_shared<Program>(Program{result.sources, std::move(module)});
    diagnostics.sort_by_place();
    return result;
}

} // namespace

// Once as a rule; again where something is said that rests on the whole library, as who mistypes a name is told of
// names that nobody has written yet. What is too large is so beside any library.
CompileResult compile(SourceFile main, const CompileOptions& options)
{
    std::shared_ptr<const CheckedLibrary> library;
    CompileResult result = compile(main, options, library);
    if (!library) return result;
    const auto rests_on_names = [](const Diagnostic& said) {
        return said.severity == Severity::error && said.code != "too-large";
    };
    const bool is_all_known = library->is_whole || std::ranges::none_of(result.diagnostics.all(), rests_on_names);
    if (is_all_known && library->diagnostics.all().empty()) return result;
    library = whole_library(options.library);
    return compile(main, options, library);
}

} // namespace haptel::lang
