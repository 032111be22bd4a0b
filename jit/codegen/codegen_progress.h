// What a loop carries from one iteration to the next and that follows from the iteration's number.
#pragma once

#include "jit/codegen/iteration_lanes.h"
#include "jit/codegen/llvm.h"

#include <vector>

namespace haptel::jit {

// Arithmetic on reals or on words, scalars or vectors.
class Arithmetic {
public:
    Arithmetic(llvm::IRBuilder<>& to, llvm::Type* of) : builder(to), is_real(of->isFPOrFPVectorTy()) {}
    llvm::Value* add(llvm::Value* a, llvm::Value* b)
    {
        return is_real ? builder.CreateFAdd(a, b) : builder.CreateAdd(a, b);
    }
    llvm::Value* sub(llvm::Value* a, llvm::Value* b)
    {
        return is_real ? builder.CreateFSub(a, b) : builder.CreateSub(a, b);
    }
    llvm::Value* mul(llvm::Value* a, llvm::Value* b)
    {
        return is_real ? builder.CreateFMul(a, b) : builder.CreateMul(a, b);
    }

private:
    llvm::IRBuilder<>& builder;
    const bool is_real;
};

// A carried value that follows from the iteration's number: from what it is in the first of a group of lanes to what it
// is in each, and in the first of the next group. Products go by doubling: three multiplications for eight lanes. Where
// iterations follow one another, the lane is one number.
class Progress {
public:
    // `by`: one value for all lanes, null where there is none. `lane`: the lane's number, not above the last iteration.
    Progress(llvm::IRBuilder<>& to, Carried::Kind of, llvm::Type* element, llvm::Value* amount, uint32_t lane_count)
        : builder(to), arithmetic(to, element), kind(of), by(amount), lanes(lane_count)
    {
        if (kind != Carried::Kind::factor) return;
        for (uint32_t power = 1; power <= lanes; power *= 2) {
            powers.push_back(amount);
            amount = arithmetic.mul(amount, amount);
        }
    }
    llvm::Value* in_lanes(llvm::Value* first, llvm::Value* lane, llvm::Value* is_first_group)
    {
        llvm::Value* all = spread(first, lane);
        switch (kind) {
        case Carried::Kind::factor:
            for (uint32_t bit = 0; 1u << bit < lanes; ++bit) {
                llvm::Value* mask = builder.CreateAnd(lane, llvm::ConstantInt::get(lane->getType(), 1u << bit));
                llvm::Value* has_bit = builder.CreateICmpNE(mask, llvm::Constant::getNullValue(lane->getType()));
                llvm::Value* more = arithmetic.mul(all, spread(powers[bit], lane));
                all = builder.CreateSelect(has_bit, more, all);
            }
            return all;
        case Carried::Kind::step: return arithmetic.add(all, steps(lane));
        case Carried::Kind::back: return arithmetic.sub(all, steps(lane));
        case Carried::Kind::replaced: {
            llvm::Value* is_first = builder.CreateICmpEQ(lane, llvm::Constant::getNullValue(lane->getType()));
            is_first = builder.CreateAnd(is_first, spread(is_first_group, lane));
            return builder.CreateSelect(is_first, all, spread(by, lane));
        }
        default: return first;
        }
    }
    llvm::Value* in_next_group(llvm::Value* first)
    {
        switch (kind) {
        case Carried::Kind::factor: return arithmetic.mul(first, powers.back());
        case Carried::Kind::step: return arithmetic.add(first, arithmetic.mul(by, number(by->getType(), lanes)));
        case Carried::Kind::back: return arithmetic.sub(first, arithmetic.mul(by, number(by->getType(), lanes)));
        default: return first;
        }
    }

private:
    llvm::IRBuilder<>& builder;
    Arithmetic arithmetic;
    const Carried::Kind kind;
    llvm::Value* const by;
    const uint32_t lanes;
    std::vector<llvm::Value*> powers; // by^1, by^2, by^4 ... by^lanes

    static llvm::Constant* number(llvm::Type* type, uint32_t value)
    {
        return type->isFPOrFPVectorTy() ? llvm::ConstantFP::get(type, value) : llvm::ConstantInt::get(type, value);
    }
    llvm::Value* spread(llvm::Value* one, llvm::Value* lane)
    {
        return lane->getType()->isVectorTy() ? builder.CreateVectorSplat(lanes, one) : one;
    }
    llvm::Value* steps(llvm::Value* lane)
    {
        llvm::Value* all = spread(by, lane);
        if (all->getType()->isFPOrFPVectorTy()) lane = builder.CreateUIToFP(lane, all->getType());
        return arithmetic.mul(all, lane);
    }
};

} // namespace haptel::jit
