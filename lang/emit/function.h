// Functions of the IR as functions of a language with statements: one statement for each instruction, in order, so that
// nothing is fused or reassociated; `if` and `for` as they are. No recursion, because the IR has none, and no memory
// but variables.
#pragma once

#include "lang/emit/dialect.h"

#include <map>
#include <string>
#include <vector>

namespace haptel::emit {

// The body of a texture's entry, and what stands for each of its results (ir::Texture).
struct EntryText {
    std::string statements;
    std::vector<std::string> results;
};

// The functions and tables of one module that entries reach, as far as they were asked for.
class ModuleText {
public:
    // `prefix` begins the name of each function, so that several modules stand in one text.
    ModuleText(const ir::Module& of, std::string name_prefix, const Dialect& written_in)
        : module(of), prefix(std::move(name_prefix)), dialect(written_in)
    {
    }

    // What it calls then stands in functions(). With the gradient, the faults are those of it and of the outputs.
    EntryText entry(const ir::Texture& texture, bool with_gradient);
    void append(const std::string& function) { function_text += function; }

    const ir::Module* source() const { return &module; }
    const std::string& name_prefix() const { return prefix; }
    const std::string& tables() const { return table_text; }
    const std::string& functions() const { return function_text; }
    uint64_t table_bytes() const { return bytes_of_tables; }
    // Of all variables that live at once at most, were none of them kept in a register.
    uint64_t variable_bytes() const { return bytes_at_most; }

private:
    friend class FunctionText;
    struct Named {
        std::string name;
        uint64_t bytes = 0; // of its variables and of those that it calls
    };

    const ir::Module& module;
    const std::string prefix;
    const Dialect& dialect;
    std::map<uint32_t, Named> written;
    std::map<uint32_t, std::string> table_names;
    std::string table_text, function_text;
    uint64_t bytes_of_tables = 0, bytes_at_most = 0;

    const Named& function(uint32_t index);
    const std::string& table(uint32_t index);
};

// Statements that store an entry's results as members of a sample: `sample` is what stands before a member's name,
// `widening` before a real. Without the gradient height and faults alone.
std::string stores(const EntryText& entry, const ir::Texture& texture, bool with_gradient, const std::string& sample,
                   const std::string& widening);

// Where an input stands: the member of haptel_point or of haptel_block_head, behind what stands before either's
// members.
std::string place_of(ir::Input input, const std::string& point, const std::string& head);

// Of letters, digits and single '_', none of these at an end: a part of a name in any language.
std::string readable(std::string_view name);

} // namespace haptel::emit
