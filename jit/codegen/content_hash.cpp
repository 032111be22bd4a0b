#include "jit/codegen/content_hash.h"

#include <bit>
#include <cstring>
#include <llvm/Support/BLAKE3.h>

namespace haptel::jit {

namespace {

// The text of a function without what does not matter. Every list is told with its length first, so that no two
// functions have one text.
class FunctionText {
public:
    FunctionText(const std::vector<ContentHash>& of_functions, const std::vector<ContentHash>& of_tables)
        : functions(of_functions), tables(of_tables)
    {
    }

    std::string of(const ir::Function& function)
    {
        text.clear();
        values(function.parameters);
        word(function.is_library);
        word(function.first_argument_size);
        word(function.value_types.size());
        for (ir::Type type : function.value_types) text += static_cast<char>(type);
        word(function.facts.size());
        for (const ir::Facts& facts : function.facts) write(facts);
        write(function.body);
        return std::move(text);
    }

private:
    const std::vector<ContentHash>& functions;
    const std::vector<ContentHash>& tables;
    std::string text;

    void word(size_t value)
    {
        const auto held = static_cast<uint32_t>(value);
        text.append(reinterpret_cast<const char*>(&held), sizeof held);
    }
    void real(double value) { text.append(reinterpret_cast<const char*>(&value), sizeof value); }
    void real(const std::optional<double>& value)
    {
        word(value.has_value());
        real(value.value_or(0));
    }
    void hash(const ContentHash& of) { text.append(reinterpret_cast<const char*>(of.data()), of.size()); }
    void values(const std::vector<ir::Value>& list)
    {
        word(list.size());
        for (ir::Value value : list) word(value.index);
    }
    void write(const ir::Facts& facts)
    {
        for (const auto& bound : {facts.value_minimum, facts.value_maximum, facts.slope, facts.curvature}) real(bound);
        word(facts.continuity ? 1 + static_cast<uint32_t>(*facts.continuity) : 0);
        word(facts.proven);
    }
    void write(const ir::Block& block)
    {
        values(block.parameters);
        word(block.instructions.size());
        for (const ir::Instruction& made : block.instructions) {
            word(made.kind.index());
            values(made.operands);
            values(made.results);
            std::visit([&](const auto& kind) { write(kind); }, made.kind);
        }
        values(block.yields);
    }
    void write(const ir::Operation& kind) { word(static_cast<uint32_t>(kind.op)); }
    void write(const ir::RealConstant& kind) { real(kind.value); }
    void write(const ir::WordConstant& kind) { word(kind.bits); }
    void write(const ir::ReadInput& kind) { word(static_cast<uint32_t>(kind.input)); }
    void write(const ir::ReadParameter& kind) { word(kind.parameter); }
    void write(const ir::ReadTable& kind) { hash(tables[kind.table]); }
    void write(const ir::Call& kind) { hash(functions[kind.function]); }
    void write(const ir::PointDerivative& kind) { word(kind.axis); }
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

template <typename Cell>
std::string bytes_of(const std::vector<Cell>& cells)
{
    return {reinterpret_cast<const char*>(cells.data()), cells.size() * sizeof(Cell)};
}

} // namespace

ContentHash content_hash(std::string_view bytes)
{
    return llvm::BLAKE3::hash<sizeof(ContentHash)>(
        llvm::ArrayRef(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()));
}

std::string to_text(const ContentHash& hash)
{
    std::string text;
    for (uint8_t byte : hash) (text += "0123456789abcdef"[byte >> 4]) += "0123456789abcdef"[byte & 15];
    return text;
}

std::vector<ContentHash> function_hashes(const ir::Module& module)
{
    std::vector<ContentHash> tables, functions; // callees stand before their callers
    for (const ir::Table& table : module.tables)
        tables.push_back(
            content_hash(static_cast<char>(table.element) +
                         (table.element == ir::Type::real ? bytes_of(table.reals) : bytes_of(table.words))));
    functions.reserve(module.functions.size());
    FunctionText text(functions, tables);
    for (const ir::Function& function : module.functions) functions.push_back(content_hash(text.of(function)));
    return functions;
}

} // namespace haptel::jit
