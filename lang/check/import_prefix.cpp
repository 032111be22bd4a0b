#include "lang/check/import_prefix.h"

#include <algorithm>
#include <map>

namespace haptel::lang {

using namespace ast;

void check_prefixes(CheckContext& context, const File& tree, const Declarations& own)
{
    std::map<std::string_view, const Name*> seen;
    for (const Import& import : tree.imports) {
        const Name& prefix = import.prefix;
        if (prefix.text.empty()) continue;
        const auto [twin, is_new] = seen.try_emplace(prefix.text, &prefix);
        if (!is_new) {
            context.diagnostics
                .error(prefix.span, "duplicate-name", "two imports have the prefix " + quoted(prefix.text))
                .related.push_back({twin->second->span, "the first is here"});
            continue;
        }
        const bool is_input = std::ranges::find(context.inputs, prefix.text, &Symbol::name) != context.inputs.end();
        const auto function = own.functions.find(prefix.text);
        const auto texture = own.textures.find(prefix.text);
        const auto constant = own.constants.find(prefix.text);
        const Span other = function != own.functions.end() && !function->second.empty()
                               ? function->second.front()->tree->name.span
                           : texture != own.textures.end()   ? texture->second->tree->name.span
                           : constant != own.constants.end() ? constant->second->span
                                                             : Span{};
        if (is_input || type_named(prefix.text))
            context.diagnostics.error(prefix.span, "reserved-name",
                                      quoted(prefix.text) + (is_input ? " is an input" : " is a type") +
                                          ", expected a prefix of your own");
        else if (other.end > 0)
            context.diagnostics
                .error(prefix.span, "duplicate-name",
                       "the prefix " + quoted(prefix.text) + " is the name of something else in this file")
                .related.push_back({other, "declared here"});
    }
}

} // namespace haptel::lang
