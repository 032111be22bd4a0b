// Structs: what their members are; and members and components of values.
#include "lang/check/body_checker.h"
#include "lang/syntax/swizzle.h"

namespace haptel::lang {

using namespace ast;

namespace {

constexpr uint32_t depth_max = 32; // of structs in structs: each is looked up inside of the one round it

// "id and d", "x, y and z"
std::string names_of(const StructInfo& info)
{
    std::string names;
    for (const StructMember& member : info.members)
        names += (&member == info.members.data() ? "" : &member == &info.members.back() ? " and " : ", ") + member.name;
    return names;
}

void find_members(CheckContext& context, StructDeclaration& declared)
{
    const Struct& tree = *declared.tree;
    StructInfo& info = declared.info;
    const std::string name = quoted(tree.name.text);
    const auto refuse = [&](Span where, ErrorCode code, std::string message, std::string_view hint) -> Diagnostic& {
        declared.is_valid = false;
        return context.diagnostics.error(where, code, std::move(message), hint);
    };
    if (tree.members.empty())
        refuse(tree.name.span, "struct", "the struct " + name + " has no members",
               "write at least one between '{' and '}': struct " + tree.name.text + " { float x; };");
    std::map<std::string_view, Span> seen;
    for (const Struct::Member& member : tree.members) {
        const auto [first, is_new] = seen.try_emplace(member.name.text, member.name.span);
        if (!is_new)
            refuse(member.name.span, "duplicate-name", name + " has two members called " + quoted(member.name.text), {})
                .related.push_back({first->second, "the first is here"});
        Type type = value_type(context, member.type, "a member of a struct holds a value", false);
        if (member.type.is_array)
            type = BodyChecker(context, scope_of(context, tree.name.span.file)).array_type(member.type, type);
        declared.is_valid = declared.is_valid && !type.is_error();
        info.members.push_back({member.name.text, type, info.components});
        if ((info.components += type.components()) <= array_components_max) continue;
        refuse(member.name.span, "struct",
               "a struct has at most " + std::to_string(array_components_max) + " numbers, and " + name +
                   " has more from here on",
               "its members are values of the program; numbers that never change are a constant table");
        return;
    }
}

} // namespace

Type type_of_struct(CheckContext& context, StructDeclaration& declared, Span from)
{
    using enum StructDeclaration::State;
    const std::string name = quoted(declared.tree->name.text);
    if (declared.state == in_work) {
        context.diagnostics.error(from, "struct", name + " would hold itself, and have no end",
                                  "values are copied: a member is of another type, or the index of one in an array");
        return Type::error();
    }
    if (declared.state == untouched && context.struct_depth == depth_max) {
        context.diagnostics.error(from, "too-deep",
                                  "structs hold structs more than " + std::to_string(depth_max) + " deep here");
        return Type::error();
    }
    if (declared.state == untouched) {
        declared.state = in_work;
        ++context.struct_depth;
        find_members(context, declared);
        --context.struct_depth;
        declared.state = done;
    }
    return declared.is_valid ? Type{Scalar::struct_, 1, 0, 1, &declared.info} : Type::error();
}

const FileScope& scope_of(const CheckContext& context, uint32_t file)
{
    return (*context.scopes)[context.is_library ? file - SourceSet::library_files : file];
}

// Of a name, or of members of one; Type::error() for other expressions, and where it is not known.
Type BodyChecker::type_before_reading(const Expression& e) const
{
    if (auto name = std::get_if<NameExpression>(&e.node)) {
        const Symbol* symbol = find(name->name);
        return symbol && symbol->kind != SymbolKind::function ? symbol->type : Type::error();
    }
    auto node = std::get_if<Member>(&e.node);
    const Type object = node ? type_before_reading(*node->object) : Type::error();
    const StructMember* picked = object.is_struct() ? object.structure->member(node->member.text) : nullptr;
    return picked ? picked->type : Type::error();
}

// A member or a swizzle, of which `parts` are read.
Type BodyChecker::member(Expression& e, Member& node, uint64_t parts)
{
    Expression& whole = *node.object;
    const auto swizzle = parse_swizzle(node.member.text);
    const Type before = type_before_reading(whole);
    uint64_t of_whole = all_parts;
    if (before.is_vector() && swizzle && swizzle->highest() < before.size) of_whole = swizzle->mask();
    const StructMember* picked = before.is_struct() ? before.structure->member(node.member.text) : nullptr;
    if (picked && before.components() <= 64)
        of_whole = (parts & first_parts(picked->type.components())) << picked->first;
    if (auto name = std::get_if<NameExpression>(&whole.node))
        whole.type = read(whole, *name, of_whole);
    else if (auto inner = std::get_if<Member>(&whole.node))
        whole.type = member(whole, *inner, of_whole);
    else
        expression(whole);
    const Type object = whole.type;
    if (object.is_error()) return object;
    if (object.is_struct()) return member_of_struct(e, node, object);
    if (!object.is_vector())
        return fail(
            e.span, "bad-swizzle", quoted(excerpt(whole)) + " is a " + to_string(object) + " and has no components",
            object == float_type ? "leave '." + node.member.text + "' out, or write vec3(" + excerpt(whole) + ")"
            : object.is_matrix() ? "pick a column, which is a vector: " + excerpt(whole) + "[0]"
            : object.is_array()  ? "pick an element: " + excerpt(whole) + "[i]"
                                 : std::string{});
    if (!swizzle || swizzle->highest() >= object.size) {
        constexpr const char* names[] = {"x and y", "x, y and z", "x, y, z and w"};
        Diagnostic& reported = diagnostics.error(node.member.span, "bad-swizzle",
                                                 to_string(object) + " has no component " + quoted(node.member.text),
                                                 std::string("its components are ") + names[object.size - 2]);
        if (node.member.text.size() > 1)
            reported.hint += ", picked by up to four letters of one set: xyzw, rgba or stpq";
        return Type::error();
    }
    return vec(swizzle->size, object.scalar);
}

Type BodyChecker::member_of_struct(const Expression& e, const Member& node, Type object)
{
    const StructInfo& info = *object.structure;
    if (const StructMember* found = info.member(node.member.text)) return found->type;
    if (node.member.text.empty()) return Type::error(); // told
    std::vector<std::string_view> names;
    for (const StructMember& member : info.members) names.push_back(member.name);
    Diagnostic& reported = diagnostics.error(
        node.member.span, "unknown-member", quoted(info.name) + " has no member " + quoted(node.member.text),
        (info.members.size() == 1 ? "its only member is " : "its members are ") + names_of(info));
    propose(reported, node.member.span, near_name(node.member.text, names));
    reported.related.push_back({e.span, quoted(excerpt(*node.object)) + " is a " + info.name});
    return Type::error();
}

} // namespace haptel::lang
