// Arrays: constant tables, arrays of a body, and what is assigned of a variable with parts.
#include "lang/check/body_checker.h"
#include "lang/syntax/swizzle.h"

namespace haptel::lang {

using namespace ast;

namespace {

constexpr uint32_t table_size_max = 65'536;

// The expression inside the last index and swizzle, if it is a name; accessors from the name outwards.
NameExpression* root_of(Expression& target, std::vector<Expression*>& accessors)
{
    Expression* object = &target;
    if (auto member = std::get_if<Member>(&object->node)) {
        accessors.push_back(object);
        object = member->object.get();
    }
    while (auto index = std::get_if<Index>(&object->node)) {
        accessors.insert(accessors.begin(), object);
        object = index->object.get();
    }
    return std::get_if<NameExpression>(&object->node);
}

} // namespace

uint64_t parts_of(Type type)
{
    const uint32_t count = type.is_array() ? type.array_size : type.components();
    return count >= 64 ? all_parts : (uint64_t{1} << count) - 1;
}

uint64_t parts_at(Type type, int64_t index)
{
    if (index < 0 || index >= type.element_count()) return 0;
    if (type.element_count() > 64) return all_parts; // a constant table: whole from its declaration
    if (!type.is_matrix()) return uint64_t{1} << index;
    return ((uint64_t{1} << type.size) - 1) << (index * type.size);
}

// The number in the brackets; 0 where there is none. What is no size is reported, and nothing returned.
std::optional<uint32_t> BodyChecker::size_of_array(const TypeName& type)
{
    if (!type.array_size) return 0;
    ArraySize& shared = *type.array_size;
    if (shared.is_checked) return shared.number;
    shared.is_checked = true;
    Expression& size = *shared.written;
    const Type found = expression(size);
    if (found.is_error()) return std::nullopt;
    const bool is_int = found == int_type || found == uint_type;
    const ir::IntRange wanted = range(size);
    if (!is_int || !wanted.is_constant()) {
        diagnostics.error(size.span, "not-constant",
                          "expected a constant int as the size of a table, found " +
                              (is_int ? std::string("one that varies") : to_string(found)));
        return std::nullopt;
    }
    if (wanted.minimum < 1 || wanted.minimum > table_size_max) {
        diagnostics.error(size.span, "table-size",
                          "expected 1 .. " + std::to_string(table_size_max) + " elements, found " +
                              std::to_string(wanted.minimum));
        return std::nullopt;
    }
    return shared.number = static_cast<uint32_t>(wanted.minimum);
}

Type BodyChecker::array_type(const TypeName& name, Type element)
{
    const auto size = size_of_array(name);
    if (!size || element.is_error()) return Type::error();
    if (*size == 0)
        return fail(name.base.span, "table-size", "expected the number of elements between '[' and ']'",
                    "arrays are passed as they are: " + to_string(element) + "[4]");
    Type made = element;
    made.array_size = *size;
    return fits_body(made, name.base.span) ? made : Type::error();
}

bool BodyChecker::fits_body(Type type, Span span)
{
    if (type.array_size <= array_size_max && type.components() <= array_components_max) return true;
    const bool is_long = type.array_size > array_size_max;
    diagnostics.error(
        span, "table-size",
        "an array that is no constant table has at most " +
            std::to_string(is_long ? array_size_max : array_components_max) + (is_long ? " elements" : " numbers") +
            ", found " + std::to_string(is_long ? type.array_size : type.components()),
        "its elements are values of the program; a constant table may have " + std::to_string(table_size_max));
    return false;
}

// float a[4];  vec3 a[3] = {...};  const float A[3] = {1.0, 2.0, 3.0};
Symbol* BodyChecker::array(Declaration& node, Type element)
{
    auto list = node.initializer ? std::get_if<BraceList>(&node.initializer->node) : nullptr;
    const bool is_typed = list && list->type;
    if (is_typed && !node.is_const) list = nullptr; // a value as others are
    const std::string name = quoted(node.name.text);
    const auto of_no_type = [&] {
        Symbol& symbol = declare(node.name, SymbolKind::local, Type::error());
        flow.variables[symbol.slot].assigned = all_parts;
        return &symbol;
    };
    const bool must_be_table = is_global || (node.is_const && !node.initializer);
    if (must_be_table && !list) {
        const bool is_damaged = node.initializer && std::holds_alternative<ErrorExpression>(node.initializer->node);
        if (!is_damaged)
            diagnostics.error(node.name.span, "missing-value", "table " + name + " has no values, expected '= {...}'");
        return of_no_type();
    }
    if (element == bool_type && node.is_const) {
        diagnostics.error(node.type.base.span, "type-mismatch", "a table holds numbers, found bool",
                          "write int A[] = {0, 1}; and compare, A[i] != 0");
        element = Type::error();
    }

    if (list && list->is_damaged) return of_no_type();
    auto declared_size = size_of_array(node.type);
    if (is_typed && list) { // const float A[] = float[](1.0, 2.0);
        const auto own_size = size_of_array(*list->type);
        const Type own = resolve_type(context, *list->type);
        if (!own_size || own.is_error()) {
            element = Type::error();
        } else if (own != element && !element.is_error()) {
            diagnostics.error(node.initializer->span, "type-mismatch",
                              "expected elements of " + to_string(element) + " for " + name + ", found " +
                                  to_string(own));
            element = Type::error();
        } else if (*own_size > 0 && declared_size == 0u) {
            declared_size = own_size;
        }
    }
    uint32_t size = declared_size.value_or(0);
    std::optional<std::vector<ConstantPart>> cells;
    bool is_sound = declared_size.has_value() && !element.is_error();
    if (list) {
        const auto count = static_cast<uint32_t>(list->elements.size());
        if (size > 0 && size != count) {
            // the size stands in the declaration, or in front of the list: float[2](...)
            const Expression& written = *(node.type.array_size ? node.type : *list->type).array_size->written;
            diagnostics.error(written.span, "table-size",
                              name + " is declared with " + std::to_string(size) + " elements and has " +
                                  std::to_string(count),
                              "leave the size out, " + node.name.text + "[], and it is counted");
        } else if (count == 0 || count > table_size_max) {
            diagnostics.error(node.initializer->span, "table-size",
                              "expected 1 .. " + std::to_string(table_size_max) + " elements, found " +
                                  std::to_string(count));
            is_sound = false;
        }
        size = count;
        cells.emplace();
        const Expression* culprit = nullptr;
        for (ExpressionPtr& element_tree : list->elements) {
            Expression& cell = *element_tree;
            const uint32_t reports = diagnostics.reports();
            expression(cell);
            const bool fits = require(cell, element, " for an element of " + name);
            if (!fits || diagnostics.reports() != reports) {
                is_sound = false;
                continue;
            }
            const Expression* varies = first_not_constant(cell);
            if (varies && is_global) {
                is_sound = false;
                if (varies->type.is_error()) continue; // of a mistake that was reported
                diagnostics.error(varies->span, "not-constant",
                                  "a table is constant, expected a value known when the texture is compiled");
            }
            culprit = culprit ? culprit : varies;
            if (culprit || !node.is_const) continue;
            const auto parts = context.constants.value(cell, element);
            cells->insert(cells->end(), parts.begin(), parts.end());
        }
        if (culprit || !node.is_const) cells.reset();
    } else if (node.initializer) {
        Expression& value = *node.initializer;
        const Type found = expression(value);
        if (found.is_array() && size == 0) size = found.array_size;
        Type wanted = element;
        wanted.array_size = size;
        if (size == 0 && !found.is_error()) wanted.array_size = 1; // "float a[] = 1.0;"
        is_sound = require(value, is_sound ? wanted : Type::error(), " for " + name) && is_sound;
    } else if (is_sound && size == 0) {
        diagnostics.error(node.name.span, "table-size",
                          "expected the number of elements of " + name + " between '[' and ']'",
                          to_string(element) + " " + node.name.text + "[4];");
        is_sound = false;
    }

    Type type = element;
    type.array_size = size;
    if (!is_sound || (!cells && !fits_body(type, node.name.span))) return of_no_type();
    if (list) node.initializer->type = type;
    Symbol& symbol = declare(node.name, cells ? SymbolKind::table : SymbolKind::local, type);
    if (node.is_const) symbol.read_only = cells ? "it is a constant table" : "it is constant";
    if (cells)
        symbol.value = std::move(*cells);
    else if (node.initializer)
        flow.variables[symbol.slot].assigned = all_parts;
    return &symbol;
}

// float[2](1.0, 2.0)
Type BodyChecker::array_constructor(Expression& e, BraceList& node)
{
    const Type element = resolve_type(context, *node.type);
    const auto size = size_of_array(*node.type);
    const auto count = static_cast<uint32_t>(node.elements.size());
    bool is_sound = size.has_value();
    for (ExpressionPtr& cell : node.elements) {
        expression(*cell);
        is_sound = require(*cell, element, " for an element of the array") && is_sound;
    }
    if (!is_sound) return Type::error();
    if (count == 0 || (*size > 0 && *size != count))
        return fail(e.span, "table-size",
                    "expected " + (*size > 0 ? std::to_string(*size) : "1 or more") + " elements, found " +
                        std::to_string(count));
    Type made = element;
    made.array_size = count;
    return fits_body(made, e.span) ? made : Type::error();
}

Type BodyChecker::check(Expression& e, BraceList& node)
{
    if (node.type) return array_constructor(e, node);
    for (ExpressionPtr& element : node.elements) expression(*element);
    return fail(e.span, "type-mismatch", "a list in braces makes an array, expected a value",
                "write float a[2] = {1.0, 2.0}; or a constructor, vec2(1.0, 2.0)");
}

BodyChecker::Target BodyChecker::target_of(Expression& e)
{
    std::vector<Expression*> accessors;
    const NameExpression* name = root_of(e, accessors);
    Expression& object = accessors.empty() ? e
                         : std::holds_alternative<Index>(accessors.front()->node)
                             ? *std::get<Index>(accessors.front()->node).object
                             : *std::get<Member>(accessors.front()->node).object;
    if (!name) {
        if (!std::holds_alternative<ErrorExpression>(object.node))
            diagnostics.error(e.span, "not-assignable", "expected a variable or components of one before '='",
                              "v.xy and v[1] are such components, v.xyz.x is not");
        return {};
    }
    Symbol* local = find_local(name->name);
    const Symbol* symbol = find(name->name);
    if (!symbol) {
        expression(object); // says what the name is, if anything
        return {};
    }
    std::get<NameExpression>(object.node).symbol = symbol;
    object.type = symbol->type;
    if (symbol->type.is_error()) return {};
    if (symbol->read_only || !local || symbol->kind == SymbolKind::function) {
        Diagnostic& reported = diagnostics.error(
            e.span, "read-only",
            quoted(name->name) + " cannot be changed: " + (symbol->read_only ? symbol->read_only : "it is a function"));
        if (symbol->kind == SymbolKind::input || symbol->kind == SymbolKind::texture_parameter)
            reported.hint = "change a copy: " + to_string(symbol->type) + " " + (symbol->name == "q" ? "r" : "q") +
                            " = " + symbol->name + ";";
        if (symbol->span.end > 0) reported.related.push_back({symbol->span, quoted(name->name) + " is declared here"});
        return {};
    }
    if (accessors.empty()) {
        e.type = symbol->type;
        return {local, parts_of(symbol->type), symbol->type};
    }
    // The types of indices and components; nothing is read but the indices.
    Variable& variable = flow.variables[local->slot];
    const uint64_t before = variable.assigned;
    variable.assigned = all_parts;
    const bool was_read = local->is_read;
    if (expression(e).is_error()) return {}; // whatever was meant has a value now
    if (std::holds_alternative<Member>(e.node)) local->is_read = was_read;
    flow.variables[local->slot].assigned = before;
    if (auto member = std::get_if<Member>(&e.node); member && parse_swizzle(member->member.text)->has_repeats()) {
        diagnostics.error(member->member.span, "bad-swizzle",
                          "a component stands twice in " + quoted(member->member.text) +
                              ", expected each once in a target");
        return {};
    }
    return {local, parts_written(symbol->type, accessors), e.type};
}

// What certainly has a value afterwards. An array that is written at an index known only at run time counts as written
// whole: its elements are 0 before, and loops that fill it are what it is for.
uint64_t BodyChecker::parts_written(Type type, const std::vector<Expression*>& accessors) const
{
    uint64_t parts = 0, first = 0; // of the innermost access so far, counted from part `first`
    for (Expression* accessor : accessors) {
        if (auto member = std::get_if<Member>(&accessor->node)) {
            if (type.is_array()) return 0;
            return uint64_t{parse_swizzle(member->member.text)->mask()} << first;
        }
        const ir::IntRange at = range(*std::get<Index>(accessor->node).index);
        const bool is_last = accessor == accessors.back();
        if (!at.is_constant()) return type.is_array() && is_last ? all_parts : 0;
        parts = parts_at(type, at.minimum) << first;
        if (type.is_array()) return is_last ? parts : 0; // parts of elements are not counted
        first += static_cast<uint64_t>(at.minimum) * (type.is_matrix() ? type.size : 1);
        type = type.element();
    }
    return parts;
}

} // namespace haptel::lang
