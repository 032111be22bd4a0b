// The functions of a text that are no texture's: elementary functions, and what an operation of the IR means where the
// language has no operator for it.
#pragma once

#include "lang/emit/written_number.h"
#include "lang/ir/elementary_functions.h"
#include "lang/ir/op_info.h"

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace haptel::emit {

// As it is written in the compiler's source: words of it stand for others.
struct HelperText {
    const char *name, *text;
};

struct Helper {
    std::string name, text;
};

// For a word of the text, another; each pair's first is a word, or a sign that is none.
using Replacements = std::vector<std::pair<std::string, std::string>>;
void add(std::vector<Helper>& helpers, std::span<const HelperText> texts, const Replacements& replacements);

// Of the helpers, in which callees stand first, those that `text` calls, with what they call.
std::string called_by(std::string_view text, std::span<const Helper> helpers);

// The elementary functions as Words has them; `before` stands before each.
template <typename Words>
void add_elementary(std::vector<Helper>& helpers, const std::string& before, std::string_view parameter)
{
    for (const ir::OpInfo& info : ir::all_ops()) {
        if (!ir::is_elementary(info.op)) continue;
        Lines lines;
        const Written<Words> a(lines, lines.parameter());
        const Written<Words> b = info.arity == 2 ? Written<Words>(lines, lines.parameter()) : a;
        const int result = ir::elementary::apply(info.op, a, b).result();
        const std::string name = "haptel_" + std::string(info.name);
        std::string text = before + std::string(Words::type) + " " + name + "(" + std::string(parameter) + " t0";
        if (info.arity == 2) text += ", " + std::string(parameter) + " t1";
        helpers.push_back(
            {name, text + ")\n{\n" + lines.text_of(result) + "    return " + Lines::name(result) + ";\n}"});
    }
}

} // namespace haptel::emit
