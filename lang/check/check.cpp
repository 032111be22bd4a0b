// The files of a program: what each declares and sees; then every body; then who calls whom.
#include "lang/check/check.h"

#include "lang/check/body_checker.h"
#include "lang/check/call_graph.h"
#include "lang/check/call_order.h"
#include "lang/check/import_prefix.h"
#include "lang/check/library.h"
#include "lang/check/preset.h"
#include "lang/text/limits.h"

#include <algorithm>
#include <map>
#include <utility>

namespace haptel::lang {

using namespace ast;

namespace {

// Null: there are not too many.
const TextureParameter* first_too_many(const Texture& tree)
{
    size_t numbers = 0;
    for (const TextureParameter& parameter : tree.parameters) {
        const auto type = type_named(parameter.type.base.text);
        numbers += (type ? std::max(type->components(), 1u) : 1) + parameter.choices.size();
        if (numbers > parameters_max) return &parameter;
    }
    return nullptr;
}

class ProgramChecker {
public:
    // `own_library`, where this is the library itself: what its files declare together.
    ProgramChecker(const SourceSet& sources, CheckedProgram& checked, Declarations* own_library,
                   const Declarations& seen_library, Diagnostics& sink)
        : program(checked)
        , diagnostics(sink)
        , context{sources, sink, checked, own_library != nullptr}
        , declarations(checked.files.size())
        , made_library(own_library)
        , library(seen_library)
    {
        for (uint32_t i = 0; i < input_name_count; ++i) {
            Symbol& symbol = program.symbols.emplace_back();
            symbol.kind = SymbolKind::input;
            symbol.name = builtin_inputs[i].name;
            symbol.type = vec(builtin_inputs[i].size);
            symbol.input = static_cast<InputName>(i);
            symbol.read_only = "it is an input";
            context.inputs.push_back(&symbol);
        }
    }

    void run()
    {
        add_presets(program.files, diagnostics);
        std::vector<FileScope> scopes;
        const auto count = static_cast<uint32_t>(program.files.size());
        for (uint32_t file = 0; file < count; ++file) {
            FileScope& scope = scopes.emplace_back();
            if (!context.is_library) scope.layers.push_back(&declarations[file]);
            for (const Import& import : program.files[file].tree.imports)
                if (!import.prefix.text.empty()) scope.by_prefix.emplace(import.prefix.text, nullptr);
            for (const auto& [imported, prefix] : program.files[file].imported)
                if (prefix.empty())
                    scope.layers.push_back(&declarations[imported]);
                else
                    scope.by_prefix[prefix] = &declarations[imported]; // two of one prefix are told of
            scope.layers.push_back(&library);
            declarations_of(file).lacks_functions |= program.files[file].tree.lacks_functions;
            declarations_of(file).unread.merge(program.files[file].tree.unread);
        }
        context.scopes = &scopes;
        for (uint32_t file = 0; file < count; ++file) declare_structs(file);
        // Sizes of arrays in heads of functions and in structs are constants, and constants may name functions.
        for (uint32_t file = 0; file < count; ++file) declare_functions(file, scopes[file], false);
        for (const uint32_t file : imported_first(program.files)) check_constants(file, scopes[file]);
        for (StructDeclaration& declared : program.structs) type_of_struct(context, declared, declared.tree->name.span);
        for (uint32_t file = 0; file < count; ++file) declare_functions(file, scopes[file], true);
        for (FunctionInfo& function : program.functions) check_defaults(function, scopes[function.file]);
        for (uint32_t file = 0; file < count; ++file) declare_textures(file, scopes[file]);
        for (uint32_t file = 0; file < count; ++file)
            check_prefixes(context, program.files[file].tree, declarations_of(file));
        for (uint32_t file = 0; file < count; ++file) check_textures(file, scopes[file]);
        for (FunctionInfo* function : callers_first(program.functions)) {
            if (diagnostics.full()) return;
            if (function->is_texture && !function->is_mentioned) continue; // it is checked as a texture
            BodyChecker(context, scopes[function->file])
                .check_function(const_cast<Function&>(*function->tree), *function);
        }
        check_call_graph(program, diagnostics);
    }

private:
    Declarations& declarations_of(uint32_t file) { return made_library ? *made_library : declarations[file]; }

    void declare_structs(uint32_t file)
    {
        auto& known = declarations_of(file).structs;
        for (const Struct& tree : program.files[file].tree.structs) {
            if (diagnostics.full()) return;
            if (type_named(tree.name.text)) {
                diagnostics.error(tree.name.span, "reserved-name",
                                  quoted(tree.name.text) + " is a type, expected a name of your own");
                continue;
            }
            StructDeclaration& made = program.structs.emplace_back(StructDeclaration{&tree});
            made.info.name = tree.name.text;
            const auto [place, is_new] = known.try_emplace(tree.name.text, &made);
            if (!is_new)
                diagnostics.error(tree.name.span, "duplicate-name", quoted(tree.name.text) + " is declared twice")
                    .related.push_back({place->second->tree->name.span, "first declared here"});
        }
    }

    bool is_type(std::string_view name, uint32_t file)
    {
        return type_named(name) || declarations_of(file).structs.contains(name);
    }

    // Whether the head names arrays or structs, which may have members that are arrays.
    static bool passes_arrays(const Function& tree)
    {
        const auto may_be_array = [](const TypeName& type) { return type.is_array || !type_named(type.base.text); };
        return may_be_array(tree.result) || std::ranges::any_of(tree.parameters, [&](const FunctionParameter& one) {
                   return may_be_array(one.type) || std::ranges::any_of(one.signature, may_be_array);
               });
    }

    // Those that pass arrays, or the others.
    void declare_functions(uint32_t file, const FileScope& scope, bool with_arrays)
    {
        for (Function& tree : program.files[file].tree.functions) {
            if (passes_arrays(tree) != with_arrays) continue;
            if (diagnostics.full()) return;
            FunctionInfo& info = program.functions.emplace_back();
            info.name = tree.name.text;
            info.tree = &tree;
            info.file = file;
            info.is_library = context.is_library;
            const auto is_written = [](const FunctionParameter& parameter) { return parameter.passing != Passing::in; };
            const bool returns_nothing = tree.result.base.text == "void" && !tree.result.is_array;
            info.result =
                returns_nothing && std::ranges::any_of(tree.parameters, is_written)
                    ? void_type
                    : type_of(tree.result, "a function returns a value, or has an 'out' parameter", scope, true);
            if (tree.facts && info.result.structure) {
                diagnostics.error(tree.facts->span, "facts",
                                  "facts are of numbers, and this function returns a " + to_string(info.result),
                                  "leave them out; bounds are computed all the same");
                tree.facts.reset();
            }
            if (is_type(info.name, file))
                diagnostics.error(tree.name.span, "reserved-name",
                                  quoted(info.name) + " is a type, expected a name of your own");
            size_t numbers = 0;
            for (const FunctionParameter& parameter : tree.parameters) {
                ParameterInfo& made = info.parameters.emplace_back();
                made.type = type_of(parameter.type, "a parameter holds a value", scope);
                made.name = parameter.name.text;
                made.is_function = parameter.is_function;
                made.passing = parameter.passing;
                made.value = parameter.value.get();
                if (made.is_written() && (made.is_function || made.type == image_type)) {
                    diagnostics.error(parameter.span, "output-parameter",
                                      std::string(made.is_function ? "a function" : "an image") +
                                          " cannot be a result, expected numbers");
                    made.type = Type::error();
                }
                for (const TypeName& type : parameter.signature)
                    made.signature.push_back(type_of(type, "a function takes values", scope));
                if ((numbers += std::max(made.type.components(), 1u)) <= parameters_max) continue;
                diagnostics.error(parameter.name.span, "too-large",
                                  "expected at most " + std::to_string(parameters_max) +
                                      " numbers as parameters of a function");
                tree.body = nullptr;
                break;
            }
            const auto is_error = [](const ParameterInfo& parameter) {
                return parameter.type.is_error() || std::ranges::any_of(parameter.signature, &Type::is_error);
            };
            info.is_valid = !info.result.is_error() && !tree.damage.in_head && numbers <= parameters_max &&
                            std::ranges::none_of(info.parameters, is_error);
            declare(info, tree);
        }
    }

    void declare(FunctionInfo& info, const Function& tree)
    {
        auto& overloads = declarations_of(info.file).functions[info.name];
        if (overloads.size() >= overloads_max) {
            diagnostics.error(tree.name.span, "too-large",
                              "expected at most " + std::to_string(overloads_max) + " functions called " +
                                  quoted(info.name) + " in a file");
            return;
        }
        const auto same = [&](auto* other) { return std::ranges::equal(other->parameters, info.parameters); };
        const auto twin = std::ranges::find_if(overloads, [&](auto* other) { return other->is_valid && same(other); });
        if (twin != overloads.end() && info.is_valid) {
            diagnostics.error(tree.name.span, "duplicate-name", quoted(signature_of(info)) + " is defined twice")
                .related.push_back({(*twin)->tree->name.span, "first defined here"});
            return;
        }
        overloads.push_back(&info);
        if (info.is_library) return;
        const auto known = library.functions.find(info.name);
        const auto builtins = builtin_overloads(info.name);
        const bool replaces_library = known != library.functions.end() && std::ranges::any_of(known->second, same);
        const bool replaces_builtin = std::ranges::any_of(builtins, [&](const BuiltinOverload& b) { return same(&b); });
        if (replaces_library || replaces_builtin)
            diagnostics.note(tree.name.span, "replaces-library",
                             quoted(signature_of(info)) + " replaces the " +
                                 (replaces_library ? "library's" : "built-in") + " function in this file");
    }

    Type type_of(const TypeName& name, const std::string& why, const FileScope& scope, bool is_result = false)
    {
        const Type type = value_type(context, name, why, !name.is_array && !is_result);
        return name.is_array ? BodyChecker(context, scope).array_type(name, type) : type;
    }

    // Textures as what other textures may call. Of two of one name, which is told, the first.
    void declare_textures(uint32_t file, const FileScope& scope)
    {
        for (Texture& tree : program.files[file].tree.textures) {
            if (diagnostics.full() || first_too_many(tree)) return;
            if (!tree.as_function.body) declarations_of(file).unread.insert(tree.name.text); // told
            if (!tree.as_function.body || declarations_of(file).textures.contains(tree.name.text)) continue;
            CheckedTexture texture;
            const uint32_t reports = diagnostics.reports();
            BodyChecker(context, scope).check_parameters(tree, texture);
            FunctionInfo& info = program.functions.emplace_back();
            info.name = tree.name.text;
            info.tree = &tree.as_function;
            info.file = file;
            info.is_texture = true;
            info.result = float_type;
            info.is_valid = diagnostics.reports() == reports;
            auto checked = texture.parameters.begin();
            for (const TextureParameter& parameter : tree.parameters) {
                ParameterInfo& made = info.parameters.emplace_back();
                made.name = parameter.name.text;
                made.type = float_type;
                if (parameter.is_output) {
                    made.passing = Passing::out;
                    if (const OutputInfo* output = find_output(made.name))
                        made.type = vec(static_cast<uint8_t>(output->components));
                    continue;
                }
                made.type = checked->symbol->type;
                made.value = parameter.value.get();
                for (const CheckedParameter::Component& component : checked->components)
                    if (made.type.scalar == Scalar::float_)
                        made.value_parts.emplace_back(component.value);
                    else if (made.type == bool_type)
                        made.value_parts.emplace_back(component.value != 0);
                    else if (is_integer(made.type))
                        made.value_parts.emplace_back(static_cast<uint32_t>(static_cast<int64_t>(component.value)));
                if (is_integer(made.type)) made.held = checked->symbol->range;
                made.choices = checked->choices;
                ++checked;
            }
            declarations_of(file).textures.emplace(info.name, &info);
        }
    }

    // What a call may leave out stands last, and is known when the texture is compiled.
    void check_defaults(FunctionInfo& info, const FileScope& scope)
    {
        const ParameterInfo* optional = nullptr;
        for (size_t i = 0; i < info.parameters.size(); ++i) {
            ParameterInfo& parameter = info.parameters[i];
            const FunctionParameter& tree = info.tree->parameters[i];
            if (tree.value) {
                optional = &parameter;
                parameter.value_parts = BodyChecker(context, scope).check_default(*tree.value, parameter, tree.span);
                if (!parameter.value_parts.empty()) continue;
                info.is_valid = false;
            } else if (optional) {
                diagnostics.error(tree.span, "default-argument",
                                  quoted(parameter.name) + " needs a default too, as " + quoted(optional->name) +
                                      " before it has one",
                                  "what a call may leave out stands last");
                info.is_valid = false;
                return;
            }
        }
    }

    void check_constants(uint32_t file, const FileScope& scope)
    {
        for (const Constant& constant : program.files[file].tree.constants)
            declarations_of(file).constant_names.insert(constant.declaration.name.text);
        for (Constant& constant : program.files[file].tree.constants) {
            if (diagnostics.full()) return;
            const Symbol& symbol = BodyChecker(context, scope).check_global(constant.declaration);
            const auto [place, is_new] = declarations_of(file).constants.try_emplace(symbol.name, &symbol);
            if (!is_new)
                diagnostics.error(symbol.span, "duplicate-name", quoted(symbol.name) + " is declared twice")
                    .related.push_back({place->second->span, "first declared here"});
        }
    }

    void check_textures(uint32_t file, const FileScope& scope)
    {
        std::map<std::string_view, const Texture*> seen;
        for (Texture& tree : program.files[file].tree.textures) {
            if (diagnostics.full()) return;
            const auto [twin, is_new] = seen.try_emplace(tree.name.text, &tree);
            if (!is_new)
                diagnostics
                    .error(tree.name.span, "duplicate-texture",
                           "two textures of this file are called " + quoted(tree.name.text))
                    .related.push_back({twin->second->name.span, "the first is here"});
            if (const TextureParameter* const beyond = first_too_many(tree)) {
                diagnostics.error(beyond->name.span, "too-large",
                                  "expected at most " + std::to_string(parameters_max) +
                                      " numbers and choices as parameters of a texture");
                continue;
            }
            CheckedTexture texture;
            texture.tree = &tree;
            BodyChecker(context, scope).check_texture(tree, texture);
            if (file == 0) program.textures.push_back(std::move(texture));
        }
    }

    CheckedProgram& program;
    Diagnostics& diagnostics;
    CheckContext context;
    std::vector<Declarations> declarations; // by file
    Declarations* const made_library;       // null: this is a program
    const Declarations& library;            // that all files see
};

} // namespace

CheckedProgram check(const SourceSet& sources, std::vector<CheckFile> files,
                     std::shared_ptr<const CheckedLibrary> library, Diagnostics& diagnostics,
                     Declarations* made_library)
{
    static const Declarations none;
    CheckedProgram program;
    program.library = library;
    program.files = std::move(files);
    const Declarations& seen = made_library ? *made_library : library ? library->declarations : none;
    ProgramChecker(sources, program, made_library, seen, diagnostics).run();
    return program;
}

} // namespace haptel::lang
