// Constant tables, and how all lanes read them at once.
#include "jit/codegen/codegen_module.h"

#include <algorithm>
#include <bit>
#include <llvm/Analysis/VectorUtils.h>
#include <llvm/IR/IntrinsicsX86.h>

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
                                std::ranges::all_of(table.words, [](uint32_t word) { return word < 256; });
        if (module.lanes > 16) return nullptr;
        if (fits_bytes && module.processor.permutes_bytes) return of_lanes(from_bytes());
        if (!module.processor.permutes_words) return nullptr;
        if (is_real && !is_single) return from_doubles();
        if (table.size() > chunks_max * 32) return nullptr;
        if (!is_real) return of_lanes(from_pairs(permute_words, table.words, padded()));
        std::vector<uint32_t> bits;
        for (double real : table.reals) bits.push_back(std::bit_cast<uint32_t>(static_cast<float>(real)));
        return of_lanes(builder.CreateBitCast(from_pairs(permute_words, bits, padded()),
                                              llvm::FixedVectorType::get(builder.getFloatTy(), 16)));
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

    static constexpr llvm::Intrinsic::ID permute_words = llvm::Intrinsic::x86_avx512_vpermi2var_d_512;

    // Of a vector's elements `count` from `first` on, then some that do not matter.
    Value* part(Value* of, unsigned first, unsigned count, unsigned padding = 0)
    {
        return builder.CreateShuffleVector(of, llvm::createSequentialMask(first, count, padding));
    }
    // Fewer lanes than words of a register are its first.
    Value* padded() { return module.lanes == 16 ? index : part(index, 0, module.lanes, 16 - module.lanes); }
    Value* of_lanes(Value* cells) { return module.lanes == 16 ? cells : part(cells, 0, module.lanes); }
    // A pair of registers, permuted by the index's lowest bits.
    template <typename Cell>
    Value* from_pair(llvm::Intrinsic::ID permute, const Cell* cells, Value* of)
    {
        constexpr size_t width = register_bytes / sizeof(Cell);
        Value* low = llvm::ConstantDataVector::get(builder.getContext(), llvm::ArrayRef(cells, width));
        Value* high = llvm::ConstantDataVector::get(builder.getContext(), llvm::ArrayRef(cells + width, width));
        return builder.CreateIntrinsic(permute, {}, {low, of, high});
    }
    // The index's higher bits say which pair has the cell. What has no cell yet keeps its index, as the instruction
    // does that permutes under a mask: no blending.
    template <typename Cell>
    Value* from_pairs(llvm::Intrinsic::ID permute, std::vector<Cell> cells, Value* of)
    {
        constexpr size_t pair_size = 2 * register_bytes / sizeof(Cell);
        cells.resize((cells.size() + pair_size - 1) / pair_size * pair_size);
        Value* const pair_of = builder.CreateLShr(of, std::countr_zero(pair_size));
        Value *found = of, *read = nullptr;
        for (size_t first = 0; first < cells.size(); first += pair_size) {
            read = from_pair(permute, cells.data() + first, found);
            if (cells.size() == pair_size) return read;
            Value* is_here = builder.CreateICmpEQ(pair_of, llvm::ConstantInt::get(of->getType(), first / pair_size));
            found = builder.CreateSelect(is_here, builder.CreateBitCast(read, of->getType()), found);
        }
        return builder.CreateBitCast(found, read->getType());
    }
    // A byte each: the lowest of a lane's four is its cell, the others are noise.
    Value* from_bytes()
    {
        std::vector<uint8_t> cells(table.words.begin(), table.words.end());
        cells.resize(cells.size() <= 128 ? 128 : 256);
        Value* const at = padded();
        Value* const bytes = builder.CreateBitCast(at, llvm::FixedVectorType::get(builder.getInt8Ty(), register_bytes));
        const auto read = [&](size_t first) {
            constexpr auto permute = llvm::Intrinsic::x86_avx512_vpermi2var_qi_512;
            return builder.CreateBitCast(from_pair(permute, cells.data() + first, bytes), at->getType());
        };
        Value* found = read(0);
        if (cells.size() > 128) {
            Value* const upper = builder.CreateAnd(at, llvm::ConstantInt::get(at->getType(), 128));
            found = builder.CreateSelect(builder.CreateIsNotNull(upper), read(128), found);
        }
        return builder.CreateAnd(found, llvm::ConstantInt::get(at->getType(), 255));
    }
    // Sixteen lanes are two registers.
    Value* from_doubles()
    {
        if (table.size() > chunks_max * 8 || module.lanes % 8 != 0) return nullptr;
        const auto read = [&](unsigned first) {
            constexpr auto permute = llvm::Intrinsic::x86_avx512_vpermi2var_pd_512;
            Value* const lanes = module.lanes == 8 ? index : part(index, first, 8);
            llvm::Type* const wide = llvm::FixedVectorType::get(builder.getInt64Ty(), 8);
            return from_pairs(permute, table.reals, builder.CreateZExt(lanes, wide));
        };
        return module.lanes == 8 ? read(0)
                                 : builder.CreateShuffleVector(read(0), read(8), llvm::createSequentialMask(0, 16, 0));
    }
};

} // namespace

llvm::GlobalVariable* ModuleEmitter::table(uint32_t index, bool is_single)
{
    llvm::GlobalVariable*& made = tables[{index, is_single}];
    if (made) return made;
    const ir::Table& table = source.tables[index];
    llvm::LLVMContext& context = target.getContext();
    const std::vector<float> singles(table.reals.begin(), table.reals.end());
    llvm::Constant* cells = table.element != ir::Type::real ? llvm::ConstantDataArray::get(context, table.words)
                            : is_single                     ? llvm::ConstantDataArray::get(context, singles)
                                                            : llvm::ConstantDataArray::get(context, table.reals);
    made = new llvm::GlobalVariable(target, cells->getType(), true, llvm::GlobalValue::InternalLinkage, cells);
    made->setUnnamedAddr(llvm::GlobalValue::UnnamedAddr::Global);
    return made;
}

Value* ModuleEmitter::read_in_lanes(llvm::IRBuilder<>& builder, uint32_t from, Value* index, bool is_single)
{
    TableReader reader(*this, builder, source.tables[from], index);
    if (Value* permuted = reader.permuted(is_single)) return permuted;
    return reader.gathered(table(from, is_single), type(source.tables[from].element, {false, is_single}));
}

} // namespace haptel::jit
