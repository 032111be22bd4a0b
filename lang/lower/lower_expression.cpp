// Expressions to instructions.
#include "lang/lower/lowering.h"
#include "lang/program/builtins.h"
#include "lang/syntax/swizzle.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;
using ir::Op;
using ir::Value;

namespace {

constexpr uint32_t nesting_limit = 500; // of expressions, statements and calls under work: bounds the stack

Value conversion(ir::Builder& builder, Value value, Scalar from, Scalar to)
{
    if (from == to) return value;
    const auto op = [&](Op name, Value a) { return builder.operation(name, {a}); };
    if (from == Scalar::bool_) return conversion(builder, op(Op::b_to_i, value), Scalar::int_, to);
    const bool from_float = from == Scalar::float_, from_int = from == Scalar::int_;
    switch (to) {
    case Scalar::float_: return op(from_int ? Op::i_to_r : Op::u_to_r, value);
    case Scalar::int_: return op(from_float ? Op::r_to_i : Op::u_as_i, value);
    case Scalar::uint_: return op(from_float ? Op::r_to_u : Op::i_as_u, value);
    case Scalar::bool_: {
        const Value zero = from_float ? builder.real(0) : builder.word(0, builder.type(value));
        return op(Op::lnot, builder.operation(from_float ? Op::eq : from_int ? Op::ieq : Op::ueq, {value, zero}));
    }
    case Scalar::error:
    case Scalar::image_:
    case Scalar::struct_:
    case Scalar::void_: break;
    }
    return value;
}

// Null: the expression is no constant table.
const Symbol* table_of(const Expression& e)
{
    auto name = std::get_if<NameExpression>(&e.node);
    return name && name->symbol->kind == SymbolKind::table ? name->symbol : nullptr;
}

// So cheap that choosing between two of them needs no branch.
bool is_leaf(const Expression& e)
{
    if (auto unary = std::get_if<Unary>(&e.node)) return is_leaf(*unary->operand);
    if (auto member = std::get_if<Member>(&e.node)) return is_leaf(*member->object);
    return std::holds_alternative<NumberLiteral>(e.node) || std::holds_alternative<NameExpression>(e.node) ||
           std::holds_alternative<BoolLiteral>(e.node);
}

} // namespace

ir::Type ir_type(Type type)
{
    switch (type.scalar) {
    case Scalar::int_: return ir::Type::i32;
    case Scalar::uint_: return ir::Type::u32;
    case Scalar::bool_: return ir::Type::boolean;
    case Scalar::image_: return ir::Type::image;
    case Scalar::error:
    case Scalar::struct_:
    case Scalar::void_:
    case Scalar::float_: break;
    }
    return ir::Type::real;
}

std::vector<ir::Type> ir_types(Type type)
{
    if (!type.structure) return std::vector<ir::Type>(type.components(), ir_type(type));
    std::vector<ir::Type> types;
    const uint32_t count = type.is_array() ? type.cell_count() : 1;
    for (uint32_t i = 0; i < count; ++i)
        for (const StructMember& member : type.structure->members) {
            const std::vector<ir::Type> more = ir_types(member.type);
            types.insert(types.end(), more.begin(), more.end());
        }
    return types;
}

Values BodyLowering::zeros(Type type)
{
    if (type == void_type) return {};
    Values made;
    for (const ir::Type part : ir_types(type)) {
        const bool is_word = part != ir::Type::real && part != ir::Type::image; // no variable is an image
        made.push_back(is_word ? builder.word(0, part) : builder.real(0));
    }
    return made;
}

bool BodyLowering::too_deep(Span span)
{
    if (owner.nesting <= nesting_limit) return false;
    owner.diagnostics.error(span, "too-deep", "expressions and calls nest too deep here", "put parts into variables");
    return true;
}

Values BodyLowering::expression(const Expression& e)
{
    const Nesting nesting(owner.nesting);
    if (too_deep(e.span)) return zeros(e.type);
    Values made = std::visit([&](const auto& node) { return lower(e, node); }, e.node);
    builder.span = e.span;
    return made;
}

Values BodyLowering::converted(const Expression& e, Type to)
{
    return convert(expression(e), e.type, to);
}

Values BodyLowering::convert(const Values& parts, Type from, Type to)
{
    Values made;
    for (Value part : parts) made.push_back(conversion(builder, part, from.scalar, to.scalar));
    return made;
}

Values BodyLowering::lower(const Expression& e, const ErrorExpression&)
{
    return zeros(e.type);
}

Values BodyLowering::lower(const Expression& e, const BraceList& node)
{
    Values parts;
    for (const ExpressionPtr& cell : node.elements) {
        const Values more = converted(*cell, e.type.element());
        parts.insert(parts.end(), more.begin(), more.end());
    }
    return parts;
}

Values BodyLowering::lower(const Expression& e, const NumberLiteral& node)
{
    builder.span = e.span;
    if (e.type == float_type) return {builder.real(node.value)};
    return {builder.word(static_cast<uint32_t>(node.integer), ir_type(e.type))};
}

Values BodyLowering::lower(const Expression& e, const BoolLiteral& node)
{
    builder.span = e.span;
    return {builder.boolean(node.value)};
}

Values BodyLowering::lower(const Expression& e, const NameExpression& node)
{
    builder.span = e.span;
    const Symbol& symbol = *node.symbol;
    switch (symbol.kind) {
    case SymbolKind::local:
        if (!variables[symbol.slot].empty()) return variables[symbol.slot];
        owner.diagnostics.error(e.span, "internal-error",
                                "the compiler reads '" + symbol.name + "' before it has given it a value");
        break;
    case SymbolKind::constant:
    case SymbolKind::table: return constant(symbol.value, symbol.type);
    case SymbolKind::input: return input(symbol.input);
    case SymbolKind::texture_parameter: {
        Values values;
        for (uint32_t i = 0; i < symbol.type.components(); ++i)
            values.push_back(builder.texture_parameter(symbol.slot + i, ir_type(symbol.type)));
        if (symbol.range) values[0] = held(values[0], *symbol.range); // whatever the block holds
        return values;
    }
    case SymbolKind::function: break;
    }
    return zeros(e.type);
}

Values BodyLowering::input(InputName name)
{
    const auto index = static_cast<uint32_t>(name);
    if (!passed_inputs[index].empty()) return passed_inputs[index];
    Values made; // an entry reads; the builder shares equal reads
    for (uint32_t i = 0; i < builtin_inputs[index].size; ++i)
        made.push_back(builder.input(static_cast<ir::Input>(static_cast<uint32_t>(first_input[index]) + i)));
    return made;
}

void BodyLowering::input_parameters(uint32_t reads)
{
    for (uint32_t index = 0; index < input_name_count; ++index)
        for (uint32_t i = 0; (reads >> index & 1) && i < builtin_inputs[index].size; ++i)
            passed_inputs[index].push_back(builder.parameter(ir::Type::real));
}

Values BodyLowering::constant(std::span<const ConstantPart> parts, Type type)
{
    Values made;
    const std::vector<ir::Type> types = ir_types(type);
    for (const ConstantPart& part : parts) {
        if (auto real = std::get_if<double>(&part))
            made.push_back(builder.real(*real));
        else if (auto truth = std::get_if<bool>(&part))
            made.push_back(builder.boolean(*truth));
        else
            made.push_back(builder.word(std::get<uint32_t>(part), types[made.size()]));
    }
    return made;
}

// `c ? a : b` is a branch, so that only what is needed is computed and only that can be not a number.
Values BodyLowering::lower(const Expression& e, const Conditional& node)
{
    const Value condition = expression(*node.condition)[0];
    builder.span = e.span;
    if (is_leaf(*node.when_true) && is_leaf(*node.when_false)) {
        Values a = converted(*node.when_true, e.type), b = converted(*node.when_false, e.type);
        for (size_t i = 0; i < a.size(); ++i) a[i] = builder.operation(Op::select, {condition, a[i], b[i]});
        return a;
    }
    const Nesting region(region_depth);
    depth = std::max(depth, region_depth);
    return builder.if_else(
        condition, [&] { return converted(*node.when_true, e.type); },
        [&] { return converted(*node.when_false, e.type); });
}

Values BodyLowering::lower(const Expression& e, const Member& node)
{
    const Values object = expression(*node.object);
    if (node.object->type.is_struct()) {
        const auto first = object.begin() + node.object->type.structure->member(node.member.text)->first;
        return {first, first + e.type.components()};
    }
    const Swizzle swizzle = *parse_swizzle(node.member.text);
    Values made;
    for (uint8_t i = 0; i < swizzle.size; ++i) made.push_back(object[swizzle.component[i]]);
    return made;
}

// Loops and tables rely on the range of a texture's parameter.
Value BodyLowering::held(Value value, ir::IntRange range)
{
    const auto end = [&](int64_t at) { return builder.word(static_cast<uint32_t>(at), builder.type(value)); };
    const bool is_int = builder.type(value) == ir::Type::i32;
    value = builder.operation(is_int ? Op::imax : Op::umax, {value, end(range.minimum)});
    return builder.operation(is_int ? Op::imin : Op::umin, {value, end(range.maximum)});
}

void BodyLowering::hold(const Symbol& local, ir::IntRange range)
{
    Value& value = variables[local.slot][0];
    value = held(value, range);
}

// i32 in [0, size - 1]
Value BodyLowering::index_within(const Expression& index, uint32_t size)
{
    if (const auto known = located.find(&index); known != located.end()) return known->second;
    Value value = expression(index)[0];
    if (builder.type(value) == ir::Type::u32)
        value = builder.operation(Op::u_as_i, {builder.operation(Op::umin, {value, builder.u32(size - 1)})});
    return builder.clamp_index(value, size);
}

// Where a call writes is known before it is made, whatever it changes.
void BodyLowering::locate(const Expression& target)
{
    for (const Expression* object = &target; const Expression* whole = whole_of(*object); object = whole)
        if (auto index = std::get_if<Index>(&object->node))
            located[index->index.get()] = index_within(*index->index, whole->type.element_count());
}

// Of a constant table, at indices in range.
Values BodyLowering::cell(const Symbol& table, Value row, Value column)
{
    if (table.type.has_rows()) {
        const Value size = builder.i32(static_cast<int32_t>(table.type.row_size));
        row = builder.operation(Op::iadd, {builder.operation(Op::imul, {row, size}), column});
        row = builder.clamp_index(row, table.type.cell_count());
    }
    Values made;
    const std::vector<ir::Type> types = ir_types(table.type.cell());
    for (uint32_t component : owner.tables(table)) {
        const Value part = builder.table(component, row);
        const bool is_truth = types[made.size()] == ir::Type::boolean; // which no table holds
        made.push_back(is_truth ? binary_scalar(BinaryOp::not_equal, part, builder.i32(0)) : part);
    }
    return made;
}

Values BodyLowering::lower(const Expression& e, const Index& node)
{
    auto row = std::get_if<Index>(&node.object->node);
    if (const Symbol* table = row ? table_of(*row->object) : nullptr; table && table->type.has_rows()) {
        const Value at = index_within(*row->index, table->type.array_size);
        const Value column = index_within(*node.index, table->type.row_size);
        builder.span = e.span;
        return cell(*table, at, column);
    }
    if (const Symbol* table = table_of(*node.object)) {
        const Value at = index_within(*node.index, table->type.array_size);
        builder.span = e.span;
        if (!table->type.has_rows()) return cell(*table, at, builder.i32(0));
        Values made;
        for (uint32_t column = 0; column < table->type.row_size; ++column) {
            const Values more = cell(*table, at, builder.i32(static_cast<int32_t>(column)));
            made.insert(made.end(), more.begin(), more.end());
        }
        return made;
    }
    const Values object = expression(*node.object);
    const Value at = index_within(*node.index, node.object->type.element_count());
    builder.span = e.span;
    const size_t size = e.type.components(), count = object.size() / size;
    Values picked(object.end() - static_cast<std::ptrdiff_t>(size), object.end());
    for (size_t i = count - 1; i-- > 0;) {
        const Value is_here = builder.operation(Op::ieq, {at, builder.i32(static_cast<int32_t>(i))});
        for (size_t part = 0; part < size; ++part)
            picked[part] = builder.operation(Op::select, {is_here, object[i * size + part], picked[part]});
    }
    return picked;
}

} // namespace haptel::lang
