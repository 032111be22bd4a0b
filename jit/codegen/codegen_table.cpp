#include "jit/codegen/codegen_table.h"

#include <algorithm>
#include <bit>
#include <llvm/IR/IntrinsicsX86.h>
#include <numeric>

namespace haptel::jit {

namespace {

using llvm::Value;

constexpr uint32_t register_bytes = 64; // AVX-512
constexpr size_t chunks_max = 8;        // pairs of registers; beyond that a gather is faster

class TableReader {
public:
    TableReader(ModuleEmitter& owner, llvm::IRBuilder<>& to, const ir::Table& from, Value* of_lanes)
        : module(owner), builder(to), table(from), index(of_lanes)
    {
    }

    // Nothing where no permutation fits.
    Value* permuted(bool is_single)
    {
        const bool is_real = table.element == ir::Type::real;
        const bool fits_bytes = !is_real && table.size() <= 256 &&
                                std::all_of(table.words.begin(), table.words.end(), [](uint32_t w) { return w < 256; });
        if (module.lanes > 16) return nullptr;
        if (fits_bytes && module.processor.permutes_bytes) return of_lanes(from_bytes());
        if (!module.processor.permutes_words) return nullptr;
        if (is_real && !is_single) return from_doubles();
        if (table.size() > chunks_max * 32) return nullptr;
        return of_lanes(
            is_real ? builder.CreateBitCast(from_pairs<uint32_t>(llvm::Intrinsic::x86_avx512_vpermi2var_d_512,
                                                                 bits_of_singles(), padded()),
                                            llvm::FixedVectorType::get(builder.getFloatTy(), 16))
                    : from_pairs<uint32_t>(llvm::Intrinsic::x86_avx512_vpermi2var_d_512, table.words, padded()));
    }
    Value* gathered(llvm::GlobalVariable* cells, llvm::Type* element)
    {
        auto* wide = llvm::FixedVectorType::get(builder.getInt64Ty(), module.lanes);
        Value* place = builder.CreateInBoundsGEP(element, cells, builder.CreateZExt(index, wide));
        return builder.CreateMaskedGather(llvm::FixedVectorType::get(element, module.lanes), place,
                                          llvm::Align(element->getPrimitiveSizeInBits() / 8));
    }

private:
    ModuleEmitter& module;
    llvm::IRBuilder<>& builder;
    const ir::Table& table;
    Value* const index;

    std::vector<uint32_t> bits_of_singles() const
    {
        std::vector<uint32_t> bits;
        for (double real : table.reals) bits.push_back(std::bit_cast<uint32_t>(static_cast<float>(real)));
        return bits;
    }
    // Fewer lanes than words of a register are its first; what the others hold does not matter.
    Value* padded()
    {
        std::vector<int> order(16, llvm::PoisonMaskElem);
        std::iota(order.begin(), order.begin() + module.lanes, 0);
        return module.lanes == 16 ? index : builder.CreateShuffleVector(index, order);
    }
    Value* of_lanes(Value* padded_cells)
    {
        if (module.lanes == 16) return padded_cells;
        std::vector<int> order(module.lanes);
        std::iota(order.begin(), order.end(), 0);
        return builder.CreateShuffleVector(padded_cells, order);
    }
    // Is this bit of each lane's index set?
    Value* has_bit(Value* of, uint64_t bit)
    {
        Value* masked = builder.CreateAnd(of, llvm::ConstantInt::get(of->getType(), bit));
        return builder.CreateICmpNE(masked, llvm::Constant::getNullValue(of->getType()));
    }
    // Of `choices`, a power of two of them, the one that the index's bits from `bit` upwards name.
    Value* chosen(std::vector<Value*> choices, Value* of, uint64_t bit)
    {
        for (; choices.size() > 1; bit *= 2, choices.resize(choices.size() / 2)) {
            Value* const upper = has_bit(of, bit);
            for (size_t i = 0; i < choices.size(); i += 2)
                choices[i / 2] = builder.CreateSelect(upper, choices[i + 1], choices[i]);
        }
        return choices[0];
    }
    // Each pair of registers is permuted by the index's lowest bits; its higher ones say which pair has the cell. What
    // has no cell yet keeps its index, as the instruction does that permutes under a mask: no blending.
    template <typename Cell, typename Source>
    Value* from_pairs(llvm::Intrinsic::ID permute, const std::vector<Source>& cells, Value* of)
    {
        constexpr size_t width = register_bytes / sizeof(Cell);
        std::vector<Cell> held(cells.begin(), cells.end());
        const size_t pairs = (held.size() + 2 * width - 1) / (2 * width);
        held.resize(pairs * 2 * width);
        Value* const pair_of = builder.CreateLShr(of, std::countr_zero(2 * width));
        Value* found = of;
        llvm::Type* found_type = nullptr;
        for (size_t i = 0; i < pairs; ++i) {
            const llvm::ArrayRef<Cell> pair(held.data() + i * 2 * width, 2 * width);
            Value* low = llvm::ConstantDataVector::get(builder.getContext(), pair.take_front(width));
            Value* high = llvm::ConstantDataVector::get(builder.getContext(), pair.take_back(width));
            Value* read = builder.CreateIntrinsic(permute, {}, {low, found, high});
            found_type = read->getType();
            if (pairs == 1) return read;
            Value* is_here = builder.CreateICmpEQ(pair_of, llvm::ConstantInt::get(of->getType(), i));
            found = builder.CreateSelect(is_here, builder.CreateBitCast(read, of->getType()), found);
        }
        return builder.CreateBitCast(found, found_type);
    }
    // A byte each: the lowest of a lane's four is its cell, the others are noise.
    Value* from_bytes()
    {
        std::vector<uint8_t> cells(256);
        std::copy(table.words.begin(), table.words.end(), cells.begin());
        if (table.size() <= 128) cells.resize(128);
        Value* const at = padded();
        Value* bytes = builder.CreateBitCast(at, llvm::FixedVectorType::get(builder.getInt8Ty(), register_bytes));
        std::vector<Value*> choices;
        for (size_t first = 0; first < cells.size(); first += 128) {
            const llvm::ArrayRef<uint8_t> pair(cells.data() + first, 128);
            Value* low = llvm::ConstantDataVector::get(builder.getContext(), pair.take_front(64));
            Value* high = llvm::ConstantDataVector::get(builder.getContext(), pair.take_back(64));
            Value* read =
                builder.CreateIntrinsic(llvm::Intrinsic::x86_avx512_vpermi2var_qi_512, {}, {low, bytes, high});
            choices.push_back(builder.CreateBitCast(read, at->getType()));
        }
        return builder.CreateAnd(chosen(std::move(choices), at, 128), llvm::ConstantInt::get(at->getType(), 255));
    }
    // Sixteen lanes are two registers.
    Value* from_doubles()
    {
        if (table.size() > chunks_max * 8 || module.lanes % 8 != 0) return nullptr;
        std::vector<int> order(module.lanes);
        std::iota(order.begin(), order.end(), 0);
        std::vector<Value*> parts;
        for (size_t first = 0; first < order.size(); first += 8) {
            Value* wide = builder.CreateZExt(builder.CreateShuffleVector(index, llvm::ArrayRef(order).slice(first, 8)),
                                             llvm::FixedVectorType::get(builder.getInt64Ty(), 8));
            parts.push_back(from_pairs<double>(llvm::Intrinsic::x86_avx512_vpermi2var_pd_512, table.reals, wide));
        }
        return parts.size() == 1 ? parts[0] : builder.CreateShuffleVector(parts[0], parts[1], order);
    }
};

} // namespace

llvm::Value* read_in_lanes(ModuleEmitter& module, llvm::IRBuilder<>& builder, uint32_t table, llvm::Value* index,
                           bool is_single)
{
    const ir::Table& source = module.source.tables[table];
    TableReader reader(module, builder, source, index);
    if (Value* permuted = reader.permuted(is_single)) return permuted;
    return reader.gathered(module.table(table, is_single), module.type(source.element, {false, is_single}));
}

} // namespace haptel::jit
