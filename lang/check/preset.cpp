#include "lang/check/preset.h"

#include "lang/check/body_checker.h"
#include "lang/check/call_order.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

namespace {

ExpressionPtr named(const Name& name)
{
    auto made = std::make_unique<Expression>();
    made->span = name.span;
    made->node = NameExpression{name.text};
    return made;
}

// "{ return wood(depth = depth, pitch = pitch); }"
StatementPtr body_of(const Preset& preset, const std::vector<TextureParameter>& parameters)
{
    CallExpression call{preset.of, {}};
    call.is_of_texture = true;
    for (const TextureParameter& parameter : parameters) {
        const Name here{parameter.name.text, preset.of.span};
        call.names.push_back(here);
        call.arguments.push_back(named(here));
    }
    auto value = std::make_unique<Expression>();
    value->span = preset.of.span;
    value->node = std::move(call);
    auto leave = std::make_unique<Statement>();
    leave->span = preset.span;
    leave->node = Return{std::move(value)};
    ast::Scope scope;
    scope.statements.push_back(std::move(leave));
    auto body = std::make_unique<Statement>();
    body->span = preset.span;
    body->node = std::move(scope);
    return body;
}

const Texture* find_texture(const std::vector<CheckFile>& files, const CheckFile& file, const std::string& written)
{
    const auto [prefix, name] = PrefixedName(written);
    const auto in = [name = name](const CheckFile& one) -> const Texture* {
        const auto found = std::ranges::find(one.tree.textures, name, [](const Texture& t) { return t.name.text; });
        return found == one.tree.textures.end() ? nullptr : &*found;
    };
    if (const Texture* own = prefix.empty() ? in(file) : nullptr) return own;
    for (const CheckFile::Imported& imported : file.imported)
        if (const Texture* found = imported.prefix == prefix ? in(files[imported.file]) : nullptr) return found;
    return nullptr;
}

// Of a texture that is not found. A file that could not be read may hold it, which is told.
void report_unknown(const std::vector<CheckFile>& files, const CheckFile& file, const Name& written,
                    Diagnostics& diagnostics)
{
    const auto [prefix, name] = PrefixedName(written.text);
    const auto is_read = [&](const Import& import) {
        return std::ranges::find(file.imported, import.prefix.text, &CheckFile::Imported::prefix) !=
               file.imported.end();
    };
    std::vector<std::string> known;
    for (const Import& import : file.tree.imports) {
        if (import.prefix.text.empty()) continue;
        if (import.prefix.text == prefix && !is_read(import)) return diagnostics.count_consequence();
        if (import.prefix.text != prefix) known.push_back(import.prefix.text + "." + std::string(name));
    }
    for (const CheckFile::Imported& imported : file.imported)
        if (imported.prefix == prefix && files[imported.file].tree.unread.contains(name))
            return diagnostics.count_consequence();
    for (const CheckFile::Imported& imported : file.imported)
        for (const Texture& texture : files[imported.file].tree.textures)
            if (!prefix.empty() && imported.prefix == prefix)
                known.push_back(imported.prefix + "." + texture.name.text);
    Diagnostic& reported = diagnostics.error(
        written.span, "unknown-texture",
        "there is no texture " + quoted(written.text) + (prefix.empty() ? " above or in an imported file" : ""),
        prefix.empty() ? "a preset stands below the texture or preset that it is of"
                       : "what stands before the '.' is the prefix of an import: import \"wood.haptel\" as wood;");
    if (!prefix.empty()) propose(reported, written.span, near_name(written.text, {known.begin(), known.end()}));
}

void give_defaults(Texture& made, Preset& preset, Diagnostics& diagnostics)
{
    std::vector<std::string_view> names;
    for (const TextureParameter& parameter : made.parameters) names.push_back(parameter.name.text);
    for (size_t i = 0; i < preset.values.size(); ++i) {
        const Name& name = preset.names[i];
        const auto parameter = std::ranges::find(names, name.text);
        const Span where = name.text.empty() ? preset.values[i]->span : name.span;
        if (name.text.empty() || parameter == names.end()) {
            Diagnostic& reported = diagnostics.error(
                where, "named-argument",
                name.text.empty() ? "a default of a preset has no name"
                                  : "the texture " + quoted(preset.of.text) + " has no parameter " + quoted(name.text),
                name.text.empty() ? "write depth = ..." : "haptel info lists them");
            propose(reported, where, near_name(name.text, names));
            continue;
        }
        TextureParameter& changed = made.parameters[static_cast<size_t>(parameter - names.begin())];
        if (std::exchange(*parameter, std::string_view{}).empty() || changed.is_output || !changed.value)
            diagnostics.error(where, "named-argument", quoted(name.text) + " has no default to be changed here",
                              "each parameter has one default; images and outputs have none");
        else
            changed.value = std::move(preset.values[i]);
    }
}

// To those of file i, whose imports have theirs.
void add_presets(std::vector<CheckFile>& files, size_t i, Diagnostics& diagnostics)
{
    std::vector<Texture>& textures = files[i].tree.textures;
    for (Preset& preset : files[i].tree.presets) {
        const Texture* of = find_texture(files, files[i], preset.of.text);
        if (!of) {
            files[i].tree.unread.insert(preset.name.text);
            report_unknown(files, files[i], preset.of, diagnostics);
            continue;
        }
        if (of->damage.any) { // told; what the preset would be is not known
            files[i].tree.unread.insert(preset.name.text);
            continue;
        }
        Texture made;
        made.doc = preset.doc.empty() ? of->doc : preset.doc;
        made.name = preset.name;
        made.parameters = of->parameters;
        made.span = preset.span;
        give_defaults(made, preset, diagnostics);
        made.body = body_of(preset, made.parameters);
        made.as_function = head_as_function(made);
        made.as_function.body = body_of(preset, made.parameters);
        textures.push_back(std::move(made));
    }
    std::ranges::stable_sort(textures, {}, [](const Texture& texture) { return texture.span.begin; });
}

} // namespace

void add_presets(std::vector<CheckFile>& files, Diagnostics& diagnostics)
{
    for (const uint32_t i : imported_first(files)) add_presets(files, i, diagnostics);
}

} // namespace haptel::lang
