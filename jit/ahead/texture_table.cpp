#include "jit/ahead/texture_table.h"

#include "jit/codegen/llvm.h"

#include <cstring>

namespace haptel::jit {

namespace {

class TableWriter {
public:
    TableWriter(llvm::Module& to, const emit_c::LibraryTexture& from, const TableEntries& compiled)
        : module(to), of(from), texture(*from.texture), entries(compiled)
    {
    }

    llvm::GlobalVariable* write_texture()
    {
        const haptel_facts& facts = of.facts;
        llvm::Constant* const known =
            structure({real(facts.height_min_m), real(facts.height_max_m), real(facts.slope_max),
                       real(facts.curvature_max_per_m), word(facts.continuity), word(facts.operations_max)});
        llvm::Constant* const table =
            structure({word(HAPTEL_ABI_VERSION), word(sizeof(haptel_texture)), word(texture.reads),
                       word(texture.writes), word(texture.block_size), word(texture.parameters.size()),
                       string(texture.name), parameters(), known, entry(0), entry(1), entry(2), entry(3), choices()});
        static_assert(sizeof(haptel_texture) == 120, "what a table gains is written here, too");
        return global(table, emit_c::texture_symbol(texture));
    }

    void write_defaults()
    {
        std::vector<uint64_t> block((texture.block_size + 7) / 8);
        char* const bytes = reinterpret_cast<char*>(block.data());
        for (const ir::Parameter& parameter : texture.parameters) {
            const auto put = [&](auto value) { std::memcpy(bytes + parameter.offset, &value, sizeof value); };
            switch (parameter.type) {
            case ir::Type::real: put(parameter.value); break;
            case ir::Type::i32:
            case ir::Type::boolean: put(static_cast<int32_t>(parameter.value)); break;
            case ir::Type::u32: put(static_cast<uint32_t>(parameter.value)); break;
            case ir::Type::image: break; // null: flat
            }
        }
        global(llvm::ConstantDataArray::getString(module.getContext(), {bytes, texture.block_size}, false),
               emit_c::defaults_symbol(texture));
    }

private:
    llvm::Module& module;
    const emit_c::LibraryTexture& of;
    const ir::Texture& texture;
    const TableEntries& entries;

    llvm::Constant* word(uint64_t value) const
    {
        return llvm::ConstantInt::get(llvm::Type::getInt32Ty(module.getContext()), value);
    }
    llvm::Constant* real(double value) const
    {
        return llvm::ConstantFP::get(llvm::Type::getDoubleTy(module.getContext()), value);
    }
    llvm::PointerType* pointer() const { return llvm::PointerType::getUnqual(module.getContext()); }
    llvm::Constant* null() const { return llvm::ConstantPointerNull::get(pointer()); }
    llvm::Constant* structure(llvm::ArrayRef<llvm::Constant*> members) const
    {
        return llvm::ConstantStruct::getAnon(members);
    }
    // Seen from outside where it has a name.
    llvm::GlobalVariable* global(llvm::Constant* value, const std::string& name = {}) const
    {
        auto* made = new llvm::GlobalVariable(
            module, value->getType(), true,
            name.empty() ? llvm::GlobalValue::PrivateLinkage : llvm::GlobalValue::ExternalLinkage, value, name);
        made->setAlignment(llvm::Align(8));
        return made;
    }
    llvm::Constant* string(const std::string& text) const
    {
        return global(llvm::ConstantDataArray::getString(module.getContext(), text));
    }
    llvm::Constant* array_or_null(const std::vector<llvm::Constant*>& of_array) const
    {
        if (of_array.empty()) return null();
        return global(
            llvm::ConstantArray::get(llvm::ArrayType::get(of_array[0]->getType(), of_array.size()), of_array));
    }

    llvm::Constant* parameters() const
    {
        std::vector<llvm::Constant*> rows;
        for (const ir::Parameter& parameter : texture.parameters)
            rows.push_back(structure({string(parameter.name), string(parameter.unit), string(parameter.doc),
                                      word(static_cast<uint64_t>(parameter.type)), word(parameter.offset),
                                      real(parameter.value), real(parameter.minimum), real(parameter.maximum)}));
        return array_or_null(rows);
    }
    llvm::Constant* choices() const
    {
        std::vector<llvm::Constant*> by_parameter;
        bool has_any = false;
        for (const ir::Parameter& parameter : texture.parameters) {
            std::vector<llvm::Constant*> names;
            for (const std::string& choice : parameter.choices) names.push_back(string(choice));
            has_any = has_any || !names.empty();
            by_parameter.push_back(array_or_null(names));
        }
        return has_any ? array_or_null(by_parameter) : null();
    }
    llvm::Constant* entry(size_t place) const
    {
        if (entries[place]) return entries[place];
        return null();
    }
};

} // namespace

TableEntries table_entries(const llvm::Module& module, const ir::Texture& texture, std::span<const EntryPoint> entries)
{
    TableEntries found{};
    for (const EntryPoint& entry : entries)
        if (entry.texture == &texture)
            found[(entry.lanes == LaneForm::points ? 2 : 0) + (entry.kind == EntryPoint::Kind::height ? 0 : 1)] =
                module.getFunction(symbol_of(entry));
    return found;
}

llvm::GlobalVariable* write_table(llvm::Module& module, const emit_c::LibraryTexture& texture,
                                  const TableEntries& entries, bool is_chosen_at_load)
{
    TableWriter writer(module, texture, entries);
    writer.write_defaults();
    llvm::GlobalVariable* const table = writer.write_texture();
    table->setConstant(!is_chosen_at_load);
    return table;
}

} // namespace haptel::jit
