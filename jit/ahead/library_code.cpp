#include "jit/ahead/library_code.h"

#include "jit/codegen/codegen_function.h"
#include "lang/abi/abi.h"
#include "lang/math/elementary_constants.h"
#include "lang/math/elementary_number.h"
#include "lang/math/two_over_pi.h"

#include <cstddef>
#include <utility>

namespace haptel::jit {

namespace {

using llvm::Value;

// One function; its text is that of lang/math, step by step, where `b` is the builder.
class LibraryWriter {
public:
    explicit LibraryWriter(llvm::Function& of) : function(of), b(llvm::BasicBlock::Create(of.getContext(), "", &of)) {}

    void reduce_angles();
    void spline();
    void image_channel();
    void image_coarser();
    void image_size(size_t offset);

private:
    llvm::Function& function;
    llvm::IRBuilder<> b;

    // Along one axis.
    struct Place {
        Value *at, *is_place;
        Value *texel[4], *weight[4];
    };

    Value* argument(unsigned i) const { return function.getArg(i); }
    Value* real(double number) { return llvm::ConstantFP::get(b.getDoubleTy(), number); }
    Value* floor(Value* x) { return b.CreateUnaryIntrinsic(llvm::Intrinsic::floor, x); }
    Value* member(Value* image, llvm::Type* type, size_t offset)
    {
        return b.CreateLoad(type, at_offset(b, image, offset));
    }
    Value* number(Value* image, size_t offset) { return member(image, b.getInt32Ty(), offset); }
    Value* limited(Value* x, Value* least, Value* most)
    {
        return b.CreateBinaryIntrinsic(llvm::Intrinsic::smax, least,
                                       b.CreateBinaryIntrinsic(llvm::Intrinsic::smin, x, most));
    }
    // Returns `otherwise` where the condition fails, and goes on where it holds.
    void need(Value* condition, Value* otherwise)
    {
        llvm::BasicBlock* const leave = llvm::BasicBlock::Create(b.getContext(), "", &function);
        llvm::BasicBlock* const next = llvm::BasicBlock::Create(b.getContext(), "", &function);
        b.CreateCondBr(condition, next, leave);
        b.SetInsertPoint(leave);
        b.CreateRet(otherwise);
        b.SetInsertPoint(next);
    }
    Value* part(Value* image, Value* channel, Value* level);
    void reduce_angle(Value* angle, llvm::ArrayRef<Value*> places);
    void set_place(Place& place, Value* at, Value* size, Value* edge);
    void set_texels(Place& place, Value* count, Value* order, Value* edge);
    Value* texel(Value* index, Value* count, Value* edge);
    std::array<Value*, 4> weights(Value* f, int order);
};

void LibraryWriter::reduce_angles()
{
    repeat(b, b.CreateZExt(argument(1), b.getInt64Ty()), 1, {}, [&](Value* i, const Values&) {
        const auto of = [&](unsigned array) { return b.CreateInBoundsGEP(b.getDoubleTy(), argument(array), i); };
        reduce_angle(b.CreateLoad(b.getDoubleTy(), of(0)), {of(2), of(3), of(4)});
        return Values{};
    });
    b.CreateRetVoid();
}

// As reduced() of lang/math/elementary_angle.cpp.
void LibraryWriter::reduce_angle(Value* angle, llvm::ArrayRef<Value*> places)
{
    using namespace ir::elementary;
    llvm::Type *const word_type = b.getInt64Ty(), *const wide = b.getInt128Ty();
    llvm::Constant* const words = llvm::ConstantDataArray::get(b.getContext(), llvm::ArrayRef(two_over_pi_words));
    auto* const table = new llvm::GlobalVariable(*function.getParent(), words->getType(), true,
                                                 llvm::GlobalValue::PrivateLinkage, words);
    const auto word = [&](uint64_t value) { return b.getInt64(value); };
    Value* const is_known =
        b.CreateAnd(b.CreateFCmpOGE(angle, real(0x1p20)), b.CreateFCmpOLE(angle, real(Format<double>::largest)));
    Value* const bits = b.CreateBitCast(b.CreateSelect(is_known, angle, real(0x1p20)), word_type);
    Value* const significand = b.CreateOr(b.CreateAnd(bits, word((uint64_t{1} << 52) - 1)), word(uint64_t{1} << 52));
    Value* const first = b.CreateSub(b.CreateLShr(bits, 52), word(1075 + 2 - 64));
    const auto bits_from = [&](uint64_t further) {
        Value* const bit = b.CreateAdd(first, word(further));
        Value* const index = b.CreateLShr(bit, 6);
        const auto at = [&](Value* i) { return b.CreateLoad(word_type, b.CreateInBoundsGEP(word_type, table, i)); };
        return b.CreateIntrinsic(llvm::Intrinsic::fshl, {word_type},
                                 {at(index), at(b.CreateAdd(index, word(1))), b.CreateAnd(bit, word(63))});
    };
    const auto product = [&](Value* x) { return b.CreateMul(b.CreateZExt(significand, wide), b.CreateZExt(x, wide)); };
    const auto low = [&](Value* x) { return b.CreateTrunc(x, word_type); };
    const auto high = [&](Value* x) { return low(b.CreateLShr(x, 64)); };
    Value* const lowest = product(bits_from(128));
    Value* const carried = b.CreateAdd(product(bits_from(64)), b.CreateLShr(lowest, 64));
    Value* const top = b.CreateAdd(b.CreateMul(significand, bits_from(0)), high(carried));
    const auto upper_bits = [&](Value* x, Value* y) {
        return b.CreateZExt(b.CreateIntrinsic(llvm::Intrinsic::fshl, {word_type}, {x, y, word(2)}), wide);
    };
    Value* fraction = b.CreateOr(b.CreateShl(upper_bits(top, low(carried)), 64), upper_bits(low(carried), low(lowest)));
    Value* const is_beyond_half = b.CreateICmpSLT(fraction, llvm::ConstantInt::get(wide, 0));
    Value* const quarters = b.CreateAdd(b.CreateLShr(top, 62), b.CreateZExt(is_beyond_half, word_type));
    fraction = b.CreateSelect(is_beyond_half, b.CreateNeg(fraction), fraction);
    Value* const zeros = b.CreateBinaryIntrinsic(
        llvm::Intrinsic::umin, b.CreateIntrinsic(llvm::Intrinsic::ctlz, {wide}, {fraction, b.getFalse()}),
        llvm::ConstantInt::get(wide, 127));
    fraction = b.CreateShl(fraction, zeros);
    // Of a whole number, times a power of two that is normal.
    const auto scaled = [&](Value* whole, uint64_t fraction_bits) {
        Value* const exponent = b.CreateSub(word(1023 - fraction_bits), low(zeros));
        Value* const power = b.CreateBitCast(b.CreateShl(exponent, 52), b.getDoubleTy());
        Value* const sign = b.CreateSelect(is_beyond_half, real(-1), real(1));
        return b.CreateFMul(b.CreateFMul(sign, b.CreateUIToFP(whole, b.getDoubleTy())), power);
    };
    Value* const of_quarter = scaled(low(b.CreateLShr(fraction, 75)), 53);
    Value* const rest = scaled(high(b.CreateShl(fraction, 53)), 53 + 64);
    constexpr auto& quarter = Constants<double>::quarter_turn;
    Value* const upper = b.CreateBitCast(
        b.CreateAnd(b.CreateBitCast(of_quarter, word_type), word(~Format<double>::low_half)), b.getDoubleTy());
    const auto times = [&](Value* x, double factor) { return b.CreateFMul(x, real(factor)); };
    Value* const others = b.CreateFAdd(times(b.CreateFSub(of_quarter, upper), quarter_turn_upper),
                                       b.CreateFAdd(times(of_quarter, (quarter[0] - quarter_turn_upper) + quarter[1]),
                                                    times(rest, quarter_turn_upper)));
    Value* const most = times(upper, quarter_turn_upper);
    Value* const sum = b.CreateFAdd(most, others);
    Value* const parts[] = {b.CreateUIToFP(quarters, b.getDoubleTy()), sum,
                            b.CreateFAdd(b.CreateFSub(most, sum), others)};
    Value* const nan = llvm::ConstantFP::getNaN(b.getDoubleTy());
    for (size_t i = 0; i < 3; ++i) b.CreateStore(b.CreateSelect(is_known, parts[i], nan), places[i]);
}

Value* LibraryWriter::part(Value* image, Value* channel, Value* level)
{
    const auto nearest = [&](Value* wanted, Value* count) {
        return b.CreateBinaryIntrinsic(llvm::Intrinsic::smin, wanted, b.CreateSub(count, b.getInt32(1)));
    };
    Value* const levels = number(image, offsetof(haptel_image, levels));
    Value* const row = nearest(channel, number(image, offsetof(haptel_image, channels)));
    Value* const index = b.CreateAdd(b.CreateMul(row, levels), nearest(level, levels));
    Value* const bytes = b.CreateMul(b.CreateSExt(index, b.getInt64Ty()), b.getInt64(sizeof(haptel_image)));
    return b.CreateInBoundsGEP(b.getInt8Ty(), member(image, b.getPtrTy(), offsetof(haptel_image, parts)), bytes);
}

void LibraryWriter::image_channel()
{
    Value* const image = argument(0);
    need(b.CreateIsNotNull(image), image);
    need(b.CreateIsNotNull(member(image, b.getPtrTy(), offsetof(haptel_image, parts))), image);
    Value* const colour = limited(argument(1), b.getInt32(0), b.getInt32(3));
    b.CreateRet(part(image, b.CreateAdd(colour, b.getInt32(1)), number(image, offsetof(haptel_image, level))));
}

void LibraryWriter::image_coarser()
{
    Value* const image = argument(0);
    need(b.CreateIsNotNull(image), image);
    need(b.CreateIsNotNull(member(image, b.getPtrTy(), offsetof(haptel_image, parts))), image);
    Value* const level = number(image, offsetof(haptel_image, level));
    Value* const left = b.CreateSub(number(image, offsetof(haptel_image, levels)), level);
    Value* const further = b.CreateAdd(level, limited(argument(1), b.getInt32(0), left));
    b.CreateRet(part(image, number(image, offsetof(haptel_image, channel)), further));
}

void LibraryWriter::image_size(size_t offset)
{
    need(b.CreateIsNotNull(argument(0)), b.getInt32(1));
    b.CreateRet(number(argument(0), offset));
}

// As SplineSpan of lang/math/spline.h.
void LibraryWriter::set_place(Place& place, Value* at, Value* size, Value* edge)
{
    Value* const end = b.CreateFAdd(size, real(2));
    Value* const before_end = b.CreateSelect(b.CreateFCmpOGT(at, end), end, at);
    Value* const clamped = b.CreateSelect(b.CreateFCmpOLT(at, real(-3)), real(-3), before_end);
    Value* const is_tiled = b.CreateICmpEQ(edge, b.getInt32(HAPTEL_EDGE_TILED));
    Value* const period = b.CreateSelect(is_tiled, size, b.CreateFAdd(size, size));
    Value* const within = b.CreateFSub(at, b.CreateFMul(period, floor(b.CreateFDiv(at, period))));
    place.at = b.CreateSelect(b.CreateICmpEQ(edge, b.getInt32(HAPTEL_EDGE_CLAMPED)), clamped, within);
    place.is_place = b.CreateFCmpOEQ(b.CreateFSub(place.at, place.at), real(0));
}

Value* LibraryWriter::texel(Value* index, Value* count, Value* edge)
{
    Value *const one = b.getInt64(1), *const twice = b.CreateShl(count, 1);
    Value* const period = b.CreateSelect(b.CreateICmpEQ(edge, b.getInt32(HAPTEL_EDGE_TILED)), count, twice);
    Value* const within = b.CreateSRem(b.CreateAdd(b.CreateSRem(index, period), period), period);
    Value* const folded =
        b.CreateSelect(b.CreateICmpSLT(within, count), within, b.CreateSub(b.CreateSub(twice, one), within));
    Value* const clamped = limited(b.CreateAdd(index, one), b.getInt64(0), b.CreateAdd(count, one));
    return b.CreateSelect(b.CreateICmpEQ(edge, b.getInt32(HAPTEL_EDGE_CLAMPED)), clamped, folded);
}

// As spline_weights() there.
std::array<Value*, 4> LibraryWriter::weights(Value* f, int order)
{
    const auto times = [&](Value* x, Value* y) { return b.CreateFMul(x, y); };
    const auto less = [&](Value* x, Value* y) { return b.CreateFSub(x, y); };
    const auto over = [&](Value* x, double divisor) { return b.CreateFDiv(x, real(divisor)); };
    Value* const g = less(real(1), f);
    const auto inner = [&](Value* x) {
        return over(less(real(4), times(times(x, x), less(real(6), times(real(3), x)))), 6);
    };
    const auto slope = [&](Value* x) { return times(x, less(times(real(1.5), x), real(2))); };
    const auto bend = [&](Value* x) { return less(times(real(3), x), real(2)); };
    const auto cube = [&](Value* x) { return over(times(times(x, x), x), 6); };
    switch (order) {
    case 0: return {cube(g), inner(f), inner(g), cube(f)};
    case 1: return {over(b.CreateFNeg(times(g, g)), 2), slope(f), b.CreateFNeg(slope(g)), over(times(f, f), 2)};
    case 2: return {g, bend(f), bend(g), f};
    default: return {real(-1), real(3), real(-3), real(1)};
    }
}

void LibraryWriter::set_texels(Place& place, Value* count, Value* order, Value* edge)
{
    Value *const cell = floor(place.at), *const fraction = b.CreateFSub(place.at, cell);
    Value* const first = b.CreateSub(b.CreateFPToSI(cell, b.getInt64Ty()), b.getInt64(1));
    for (size_t i = 0; i < 4; ++i) {
        place.texel[i] = texel(b.CreateAdd(first, b.getInt64(i)), count, edge);
        place.weight[i] = real(0);
    }
    for (int known = 0; known < 4; ++known) {
        const std::array<Value*, 4> made = weights(fraction, known);
        Value* const is_wanted = b.CreateICmpEQ(order, b.getInt32(static_cast<uint32_t>(known)));
        for (size_t i = 0; i < 4; ++i) place.weight[i] = b.CreateSelect(is_wanted, made[i], place.weight[i]);
    }
}

void LibraryWriter::spline()
{
    Value *const image = argument(0), *const x = argument(1), *const y = argument(2), *const orders = argument(3);
    Value* const edges = b.CreateAnd(b.CreateLShr(orders, 16), b.getInt32(3));
    Value* const edge = b.CreateBinaryIntrinsic(llvm::Intrinsic::umin, edges, b.getInt32(HAPTEL_EDGE_MIRRORED));
    need(b.CreateIsNotNull(image), real(0));
    Place column{}, row{};
    Value *const width = number(image, offsetof(haptel_image, width)), *const height = number(
                                                                           image, offsetof(haptel_image, height));
    set_place(column, x, b.CreateSIToFP(width, b.getDoubleTy()), edge);
    set_place(row, y, b.CreateSIToFP(height, b.getDoubleTy()), edge);
    need(b.CreateAnd(column.is_place, row.is_place), b.CreateFAdd(b.CreateFSub(x, x), b.CreateFSub(y, y)));
    Value* const columns = b.CreateSExt(width, b.getInt64Ty());
    set_texels(column, columns, b.CreateAnd(orders, b.getInt32(255)), edge);
    set_texels(row, b.CreateSExt(height, b.getInt64Ty()), b.CreateAnd(b.CreateLShr(orders, 8), b.getInt32(255)), edge);
    Value* const place = b.CreateInBoundsGEP(b.getPtrTy(), image, b.CreateZExt(edge, b.getInt64Ty()));
    static_assert(offsetof(haptel_image, coefficients) == 0);
    Value* const coefficients = b.CreateLoad(b.getPtrTy(), place);
    Value* const is_clamped = b.CreateICmpEQ(edge, b.getInt32(HAPTEL_EDGE_CLAMPED));
    Value* const stride = b.CreateSelect(is_clamped, b.CreateAdd(columns, b.getInt64(2)), columns);
    Value* sum = real(0);
    for (size_t j = 0; j < 4; ++j) {
        Value* const line = b.CreateMul(row.texel[j], stride);
        Value* along = real(0);
        for (size_t i = 0; i < 4; ++i) {
            Value* const index = b.CreateAdd(line, column.texel[i]);
            Value* const cell = b.CreateInBoundsGEP(b.getDoubleTy(), coefficients, index);
            along = b.CreateFAdd(along, b.CreateFMul(column.weight[i], b.CreateLoad(b.getDoubleTy(), cell)));
        }
        sum = b.CreateFAdd(sum, b.CreateFMul(row.weight[j], along));
    }
    b.CreateRet(sum);
}

} // namespace

void write_library(llvm::Module& module)
{
    const auto write = [&](const char* name, auto body) {
        llvm::Function* const function = module.getFunction(name);
        if (!function) return;
        function->setLinkage(llvm::GlobalValue::InternalLinkage);
        LibraryWriter writer(*function);
        body(writer);
    };
    write("haptel_reduce_angles", [](LibraryWriter& writer) { writer.reduce_angles(); });
    write("haptel_spline", [](LibraryWriter& writer) { writer.spline(); });
    write("haptel_image_channel", [](LibraryWriter& writer) { writer.image_channel(); });
    write("haptel_image_coarser", [](LibraryWriter& writer) { writer.image_coarser(); });
    write("haptel_image_width", [](LibraryWriter& writer) { writer.image_size(offsetof(haptel_image, width)); });
    write("haptel_image_height", [](LibraryWriter& writer) { writer.image_size(offsetof(haptel_image, height)); });
}

} // namespace haptel::jit
