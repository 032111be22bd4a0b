// Functions of the IR as functions of C99: one statement for each instruction, in order, so that nothing is fused or
// reassociated; `if` and `for` as they are. No recursion, because the IR has none, and no memory but its variables.
#pragma once

#include "lang/emit_c/library.h"

#include <map>
#include <string>

namespace haptel::emit_c {

// The functions and tables of one module that entries reach, as far as they were asked for.
class ModuleText {
public:
    // `prefix` begins the name of each function, so that several modules stand in one text.
    ModuleText(const ir::Module& of, std::string name_prefix, bool single)
        : module(of), prefix(std::move(name_prefix)), is_single(single)
    {
    }

    // The name of a haptel_entry, which then stands in functions() with all that it calls.
    std::string entry(const LibraryTexture& library_texture, bool with_gradient);

    const ir::Module* source() const { return &module; }
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
    const bool is_single;
    std::map<uint32_t, Named> written;
    std::map<uint32_t, std::string> table_names;
    std::string table_text, function_text;
    uint64_t bytes_of_tables = 0, bytes_at_most = 0;

    const Named& function(uint32_t index);
    const std::string& table(uint32_t index);
};

} // namespace haptel::emit_c
