#include "jit/codegen/content_hash.h"

#include <llvm/ADT/StringExtras.h>
#include <llvm/Support/BLAKE3.h>
#include <type_traits>

namespace haptel::jit {

namespace {

// The text of a function or table without what does not matter. Every list is told with its length first, so that no
// two of them have one text.
class Text {
public:
    Text(const std::vector<ContentHash>& of_functions, const std::vector<ContentHash>& of_tables)
        : functions(of_functions), tables(of_tables)
    {
    }

    std::string of(const ir::Function& function)
    {
        text.clear();
        list(function.parameters);
        word(function.is_library);
        word(function.first_argument_size);
        list(function.value_types);
        word(function.facts.size());
        for (const ir::Facts& facts : function.facts) write(facts);
        write(function.body);
        return std::move(text);
    }
    std::string of(const ir::Table& table)
    {
        text.clear();
        bytes(table.element);
        list(table.reals);
        list(table.words);
        return std::move(text);
    }

private:
    const std::vector<ContentHash>& functions;
    const std::vector<ContentHash>& tables;
    std::string text;

    template <typename T>
    void bytes(const T& value)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        text.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void word(size_t value) { bytes(static_cast<uint32_t>(value)); }
    template <typename T>
    void list(const std::vector<T>& values)
    {
        word(values.size());
        for (const T& value : values) bytes(value);
    }
    void write(const ir::Facts& facts)
    {
        for (const auto& bound : {facts.value_minimum, facts.value_maximum, facts.slope, facts.curvature}) {
            word(bound.has_value());
            bytes(bound.value_or(0));
        }
        word(facts.continuity ? 1 + static_cast<uint32_t>(*facts.continuity) : 0);
        word(facts.proven);
    }
    void write(const ir::Block& block)
    {
        list(block.parameters);
        word(block.instructions.size());
        for (const ir::Instruction& made : block.instructions) {
            word(made.kind.index());
            list(made.operands);
            list(made.results);
            std::visit([&](const auto& kind) { write(kind); }, made.kind);
        }
        list(block.yields);
    }
    template <typename Kind>
    void write(const Kind& kind) // of one member, without padding
    {
        bytes(kind);
    }
    void write(const ir::ReadTable& kind) { bytes(tables[kind.table]); }
    void write(const ir::Call& kind) { bytes(functions[kind.function]); }
    void write(const ir::If& kind)
    {
        for (const ir::Block& arm : kind.arms) write(arm);
    }
    void write(const ir::For& kind)
    {
        word(kind.trip_max);
        write(kind.body[0]);
    }
};

} // namespace

ContentHash content_hash(std::string_view bytes)
{
    return llvm::BLAKE3::hash<sizeof(ContentHash)>(
        llvm::ArrayRef(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()));
}

std::string to_text(const ContentHash& hash)
{
    return llvm::toHex(hash, true);
}

std::vector<ContentHash> function_hashes(const ir::Module& module)
{
    std::vector<ContentHash> tables, functions; // callees stand before their callers
    Text text(functions, tables);
    for (const ir::Table& table : module.tables) tables.push_back(content_hash(text.of(table)));
    for (const ir::Function& function : module.functions) functions.push_back(content_hash(text.of(function)));
    return functions;
}

} // namespace haptel::jit
