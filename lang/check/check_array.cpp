// Arrays: constant tables, arrays of a body, and what is assigned of a variable with parts.
#include "lang/check/body_checker.h"
#include "lang/syntax/swizzle.h"

namespace haptel::lang {

using namespace ast;

namespace {

constexpr uint32_t table_size_max = 65'536;

bool is_swizzle(const Expression& e)
{
    auto member = std::get_if<Member>(&e.node);
    return member && member->object->type.is_vector();
}

} // namespace

uint64_t first_parts(uint32_t count)
{
    return count >= 64 ? all_parts : (uint64_t{1} << count) - 1;
}

uint64_t parts_of(Type type)
{
    return first_parts(type.is_array() ? type.cell_count() : type.components());
}

uint64_t parts_at(Type type, int64_t index)
{
    if (index < 0 || index >= type.element_count()) return 0;
    if (type.is_array() && type.cell_count() > 64) return all_parts; // a constant table: whole from its declaration
    const uint32_t size = type.is_matrix() ? type.size : type.has_rows() ? type.row_size : 1;
    if (size == 64) return all_parts;
    return ((uint64_t{1} << size) - 1) << (index * size);
}

// The number in the brackets; 0 where there is none. What is no size is reported, and nothing returned.
std::optional<uint32_t> BodyChecker::size_of_array(const std::shared_ptr<ArraySize>& written)
{
    if (!written) return 0;
    ArraySize& shared = *written;
    if (shared.is_checked) return shared.number;
    shared.is_checked = true;
    Expression& size = *shared.written;
    const Type found = expression(size);
    const ir::IntRange number = range(size);
    if (found.is_error()) return std::nullopt;
    if (!is_integer(found) || !number.is_constant())
        diagnostics.error(size.span, "not-constant",
                          "expected a constant int as the size of a table, found " +
                              (is_integer(found) ? "one that varies" : to_string(found)));
    else if (number.minimum < 1 || number.minimum > table_size_max)
        diagnostics.error(size.span, "table-size",
                          "expected 1 .. " + std::to_string(table_size_max) + " elements, found " +
                              std::to_string(number.minimum));
    else
        shared.number = static_cast<uint32_t>(number.minimum);
    return shared.number;
}

// With 0 for what is to be counted; nothing after a mistake, which was reported.
std::optional<Type> BodyChecker::with_sizes(const TypeName& written, Type element)
{
    const auto size = size_of_array(written.array_size), row_size = size_of_array(written.row_size);
    if (!size || !row_size || element.is_error()) return std::nullopt;
    element.array_size = *size;
    element.row_size = *row_size;
    if (uint64_t{*size} * *row_size <= table_size_max) return element;
    diagnostics.error(written.row_size->written->span, "table-size",
                      "expected at most " + std::to_string(table_size_max) + " elements in all, found " +
                          std::to_string(uint64_t{*size} * *row_size));
    return std::nullopt;
}

Type BodyChecker::array_type(const TypeName& name, Type element)
{
    const auto type = with_sizes(name, element);
    if (!type) return Type::error();
    if (type->array_size == 0 || type->has_rows() != name.has_rows)
        return fail(name.base.span, "table-size", "expected the number of elements between '[' and ']'",
                    "arrays are passed as they are: " + to_string(element) + (name.has_rows ? "[4][4]" : "[4]"));
    return in_body(*type, name.base.span);
}

// The type, or the error that was reported, of an array that is no constant table.
Type BodyChecker::in_body(Type type, Span span)
{
    if (type.cell_count() <= array_size_max && type.components() <= array_components_max) return type;
    const bool is_long = type.cell_count() > array_size_max;
    return fail(span, "table-size",
                "an array that is no constant table has at most " +
                    std::to_string(is_long ? array_size_max : array_components_max) +
                    (is_long ? " elements" : " numbers") + ", found " +
                    std::to_string(is_long ? type.cell_count() : type.components()),
                "its elements are values of the program; a constant table may have " + std::to_string(table_size_max));
}

// The array that a list makes, whose type stands in `written`, or the error that was reported. `name` is declared to be
// it; empty: it is a constructor, or a row.
Type BodyChecker::array_of(Expression& e, BraceList& list, const TypeName& written, Type element,
                           const std::string& name)
{
    const auto known = with_sizes(written, element.is_error() ? float_type : element);
    const uint32_t reports = diagnostics.reports(), size = known ? known->array_size : 0;
    const auto count = static_cast<uint32_t>(list.elements.size());
    Type row = element; // or what stands in its place
    bool is_misshapen = false;
    if (written.has_rows) row.array_size = known ? known->row_size : 0;
    for (ExpressionPtr& cell : list.elements) {
        auto braces = std::get_if<BraceList>(&cell->node);
        if (braces && braces->type) braces = nullptr; // a value as others are
        if (braces && !written.has_rows) {
            is_misshapen = true;
            diagnostics.error(cell->span, "nested-table",
                              (name.empty() ? "the array" : quoted(name)) +
                                  " has one dimension, and a list of its own stands here",
                              "declare it with two, " + (name.empty() ? "a" : name) + "[2][2]");
        } else if (braces) {
            is_misshapen = !is_row(*cell, *braces, written, row);
        } else {
            const Type found = expression(*cell);
            if (written.has_rows && row.array_size == 0 && found.is_array()) row.array_size = found.array_size;
            is_misshapen = written.has_rows && !found.is_error() && found != row;
            if (is_misshapen)
                diagnostics.error(cell->span, "type-mismatch",
                                  "expected a row of " + (name.empty() ? "the array" : quoted(name)) + ", found " +
                                      to_string(found),
                                  "rows stand in braces: {{1.0, 2.0}, {3.0, 4.0}}");
            else
                require(*cell, row, " for an element of " + (name.empty() ? "the array" : quoted(name)));
        }
        if (is_misshapen) break; // the others are alike
    }
    const bool fits = size > 0 ? size == count : count > 0 && count <= table_size_max;
    if (!is_misshapen && !fits && size > 0 && !name.empty())
        diagnostics.error(written.array_size->written->span, "table-size",
                          quoted(name) + " is declared with " + std::to_string(size) + " elements and has " +
                              std::to_string(count),
                          "leave the size out, " + name + "[], and it is counted");
    else if (!is_misshapen && !fits)
        diagnostics.error(e.span, "table-size",
                          "expected " + (size > 0 ? "" : std::string("1 .. ")) +
                              std::to_string(size > 0 ? size : table_size_max) + " elements, found " +
                              std::to_string(count));
    if (written.has_rows) row.row_size = row.array_size;
    row.array_size = count;
    if (uint64_t{count} * row.row_size > table_size_max && diagnostics.reports() == reports)
        return e.type = fail(e.span, "table-size",
                             "expected at most " + std::to_string(table_size_max) + " elements in all, found " +
                                 std::to_string(uint64_t{count} * row.row_size));
    return e.type = known && !element.is_error() && diagnostics.reports() == reports ? row : Type::error();
}

// A row in braces; its size is that of `row`, or becomes it. False once something was reported.
bool BodyChecker::is_row(Expression& cell, BraceList& list, const TypeName& written, Type& row)
{
    TypeName of_row = written;
    of_row.array_size = row.array_size > 0 ? written.row_size : nullptr; // else it is counted, or told of
    of_row.has_rows = false;
    of_row.row_size = nullptr;
    const Type found = array_of(cell, list, of_row, row.cell(), {});
    if (found.is_error()) return false;
    if (row.array_size == 0) row.array_size = found.array_size;
    if (row.array_size == found.array_size) return true;
    diagnostics.error(cell.span, "table-size",
                      "expected " + std::to_string(row.array_size) + " elements, as the first row has, found " +
                          std::to_string(found.array_size));
    return false;
}

// The numbers of a constant table, whose rows may be lists; where `cells` is null only whether they are constant. False
// where one is not, which of a global is reported.
bool BodyChecker::add_cells(const BraceList& list, Type element, std::vector<ConstantPart>* cells)
{
    bool is_constant = true;
    for (const ExpressionPtr& cell : list.elements) {
        if (auto row = std::get_if<BraceList>(&cell->node)) {
            is_constant &= add_cells(*row, element, cells);
            continue;
        }
        const Expression* varies = first_not_constant(*cell);
        if (varies && is_global && !varies->type.is_error())
            diagnostics.error(varies->span, "not-constant",
                              "a table is constant, expected a value known when the texture is compiled");
        is_constant &= !varies;
        if (!is_constant || !cells) continue;
        const auto parts = context.constants.value(*cell, cell->type.is_array() ? cell->type : element);
        cells->insert(cells->end(), parts.begin(), parts.end());
    }
    return is_constant;
}

// What a declaration of an array makes, or the error that was reported; `cells` are those of a constant table.
// float a[4];  vec3 a[3] = {...};  const float A[3] = {1.0, 2.0, 3.0};  const float B[2][2] = {{1.0, 2.0}, {3.0, 4.0}};
Type BodyChecker::declared_array(Declaration& node, Type element, std::vector<ConstantPart>& cells)
{
    Expression* value = node.initializer.get();
    auto list = value ? std::get_if<BraceList>(&value->node) : nullptr;
    if (list && list->type && !node.is_const) list = nullptr; // a value as others are
    const std::string& name = node.name.text;
    if (list && list->is_damaged) return Type::error();
    if (!list && (is_global || (node.is_const && !value))) {
        if (value && std::holds_alternative<ErrorExpression>(value->node)) return Type::error();
        return fail(node.name.span, "missing-value", "table " + quoted(name) + " has no values, expected '= {...}'");
    }
    if (element == bool_type && node.is_const)
        element = fail(node.type.base.span, "type-mismatch", "a table holds numbers, found bool",
                       "write int A[] = {0, 1}; and compare, A[i] != 0");
    const auto sized = with_sizes(node.type, element);
    if (!sized) element = Type::error();
    const uint32_t reports = diagnostics.reports();
    Type type = sized.value_or(element);
    if (list && !list->type) {
        type = array_of(*value, *list, node.type, element, name);
    } else if (value) {
        const Type found =
            list ? array_of(*value, *list, *list->type, resolve_type(context, *list->type), name) : expression(*value);
        if (type.array_size == 0) type.array_size = std::max(found.array_size, 1u);
        if (node.type.has_rows && !type.has_rows()) type.row_size = std::max(found.row_size, 1u);
        require(*value, type, " for " + quoted(name));
    } else if (sized && (type.array_size == 0 || type.has_rows() != node.type.has_rows)) {
        return fail(node.name.span, "table-size",
                    "expected the number of elements of " + quoted(name) + " between '[' and ']'",
                    to_string(element) + " " + name + (node.type.has_rows ? "[4][4];" : "[4];"));
    }
    const bool may_be_table = list && node.is_const && diagnostics.reports() == reports;
    const bool is_constant = (may_be_table || is_global) && add_cells(*list, element, may_be_table ? &cells : nullptr);
    const bool is_table = may_be_table && is_constant;
    if (!is_table) cells.clear();
    if (element.is_error() || diagnostics.reports() != reports) return Type::error();
    return is_table ? type : in_body(type, node.name.span);
}

Symbol& BodyChecker::array(Declaration& node, Type element)
{
    std::vector<ConstantPart> cells;
    const Type type = declared_array(node, element, cells);
    const bool is_table = !cells.empty();
    Symbol& symbol = declare(node.name, is_table ? SymbolKind::table : SymbolKind::local, type);
    if (node.is_const) symbol.read_only = is_table ? "it is a constant table" : "it is constant";
    if (!is_table && node.initializer) flow.variables[symbol.slot].assigned = all_parts;
    symbol.value = std::move(cells);
    return symbol;
}

Type BodyChecker::check(Expression& e, BraceList& node)
{
    if (node.type) return in_body(array_of(e, node, *node.type, resolve_type(context, *node.type), {}), e.span);
    for (ExpressionPtr& element : node.elements) expression(*element);
    return fail(e.span, "type-mismatch", "a list in braces makes an array, expected a value",
                "write float a[2] = {1.0, 2.0}; or a constructor, vec2(1.0, 2.0)");
}

// `where` as a clause: "before '='".
BodyChecker::Target BodyChecker::target_of(Expression& e, const char* where)
{
    std::vector<const Expression*> accessors; // from the name outwards
    Expression* object = &e;
    for (; const Expression* whole = whole_of(*object); object = const_cast<Expression*>(whole))
        accessors.insert(accessors.begin(), object);
    auto name = std::get_if<NameExpression>(&object->node);
    const auto refuse = [&] {
        diagnostics.error(e.span, "not-assignable", std::string("expected a variable or components of one ") + where,
                          "v.xy and v[1] are such components, v.xyz.x is not");
        return Target{};
    };
    if (!name) return std::holds_alternative<ErrorExpression>(object->node) ? Target{} : refuse();
    Symbol* local = find_local(name->name);
    const Symbol* symbol = find(name->name);
    if (!symbol) {
        expression(*object); // says what the name is, if anything
        return {};
    }
    name->symbol = symbol;
    object->type = symbol->type;
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
    if (accessors.empty()) return {local, parts_of(symbol->type)};
    // The types of indices and components; nothing is read but the indices.
    Variable& variable = flow.variables[local->slot];
    const uint64_t before = variable.assigned;
    variable.assigned = all_parts;
    const bool was_read = local->is_read;
    ++choice_depth; // an index is computed once for reading and once for writing
    const bool is_wrong = expression(e).is_error();
    --choice_depth;
    if (is_wrong) return {}; // whatever was meant has a value now
    if (std::holds_alternative<Member>(e.node)) local->is_read = was_read;
    flow.variables[local->slot].assigned = before;
    for (const Expression* accessor : accessors)
        if (accessor != &e && is_swizzle(*accessor)) return refuse();
    if (auto member = std::get_if<Member>(&e.node);
        is_swizzle(e) && parse_swizzle(member->member.text)->has_repeats()) {
        diagnostics.error(member->member.span, "bad-swizzle",
                          "a component stands twice in " + quoted(member->member.text) +
                              ", expected each once in a target");
        return {};
    }
    return {local, parts_written(symbol->type, accessors)};
}

// What certainly has a value afterwards. An array that is written at an index known only at run time counts as written
// whole: its elements are 0 before, and loops that fill it are what it is for. So does an element that is a struct of
// which a member is written, and a struct of more members than there are bits.
uint64_t BodyChecker::parts_written(Type type, const std::vector<const Expression*>& accessors) const
{
    uint64_t parts = 0, first = 0; // of the innermost access so far, counted from part `first`
    bool is_in_struct = false;
    for (const Expression* accessor : accessors) {
        const bool is_last = accessor == accessors.back();
        if (auto member = std::get_if<Member>(&accessor->node)) {
            if (!type.is_struct()) return uint64_t{parse_swizzle(member->member.text)->mask()} << first;
            if (first + type.components() > 64) return all_parts;
            const StructMember& picked = *type.structure->member(member->member.text);
            is_in_struct = true;
            first += picked.first;
            type = picked.type;
            parts = first_parts(type.components()) << first;
            continue;
        }
        const ir::IntRange at = range(*std::get<Index>(accessor->node).index);
        const Type element = type.element();
        if (type.is_array() && is_in_struct) { // its parts are components
            if (!is_last && !element.is_struct()) return 0;
            if (!at.is_constant() || !is_last) return parts;
            return first_parts(element.components())
                   << (first + static_cast<uint64_t>(at.minimum) * element.components());
        }
        const bool is_cell =
            is_last || element.is_struct() ||
            (type.has_rows() && accessors.size() == 2 && std::holds_alternative<Index>(accessors.back()->node));
        if (!at.is_constant()) return type.is_array() && is_cell ? parts_of(type) << first : 0;
        parts = parts_at(type, at.minimum) << first;
        if (type.is_array() && !element.is_array())
            return is_last || element.is_struct() ? parts : 0; // parts of elements are not counted
        first += static_cast<uint64_t>(at.minimum) * (element.is_array() ? element.array_size
                                                      : type.is_matrix() ? type.size
                                                                         : 1);
        type = element;
    }
    return parts;
}

} // namespace haptel::lang
