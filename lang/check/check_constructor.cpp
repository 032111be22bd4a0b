// Values that a type's name makes of others.
#include "lang/check/body_checker.h"
#include "lang/check/type_hint.h"

namespace haptel::lang {

using namespace ast;

// Scalars convert from any scalar; vectors and matrices join the components of their arguments. One scalar fills a
// vector or the diagonal of a matrix, a longer vector is cut, and a matrix of another size is cut or filled up from the
// unit matrix.
Type BodyChecker::constructor(Expression& e, CallExpression& call, Type type)
{
    bool damaged = false;
    uint32_t components = 0;
    const std::string all = std::to_string(type.components()) + (type.is_scalar() ? " component" : " components");
    for (ExpressionPtr& tree : call.arguments) {
        Expression& argument = *tree;
        const Type found = expression(argument);
        const bool is_second_matrix = type.is_matrix() && found.is_matrix() && call.arguments.size() > 1;
        damaged |= found.is_error();
        if (!damaged && components >= type.components()) {
            const std::string full =
                type.is_scalar() ? "is made of one value" : "has all its " + all + " before this argument";
            diagnostics.error(argument.span, "wrong-argument-count", to_string(type) + " " + full,
                              "leave this argument out");
            damaged = true;
        }
        const bool is_nothing = found == void_type || found == image_type || found.is_array() || found.is_struct();
        if (!damaged && (is_nothing || is_second_matrix)) {
            diagnostics.error(argument.span, found == image_type ? ErrorCode("image") : ErrorCode("type-mismatch"),
                              "expected numbers and vectors for " + to_string(type) + ", found " + to_string(found),
                              found == image_type ? "read it: sample(" + excerpt(argument) + ", uv)"
                              : found.is_array()  ? "pick elements: " + operand(argument) + "[i]"
                              : found.is_struct()
                                  ? "pick a member: " + operand(argument) + "." + found.structure->members.front().name
                              : found == void_type ? "call it as a statement of its own"
                                                   : "pick columns: " + operand(argument) + "[0]");
            damaged = true;
        }
        components += found.components();
    }
    call.target.is_constructor = true;
    call.target.function_arguments.assign(call.arguments.size(), {});
    if (damaged) return type;
    if (type == void_type) return fail(e.span, "type-mismatch", "void has no values");
    if (type == image_type)
        return fail(e.span, "image", "an image is not made of values",
                    "it comes with the texture: texture t(image picture) { return 1mm * sample(picture, uv); }");
    const bool fills =
        call.arguments.size() == 1 && (components == 1 || (type.is_matrix() && call.arguments[0]->type.is_matrix()));
    if (components == 0 || (components < type.components() && !fills)) {
        Diagnostic& reported =
            diagnostics.error(e.span, "wrong-argument-count",
                              to_string(type) + " needs " + all + ", found " + std::to_string(components));
        if (type.is_vector()) reported.hint = "one fills all: " + zero_of(type);
        if (type.is_matrix()) reported.hint = "one number fills the diagonal: " + to_string(type) + "(1.0)";
    }
    return type;
}

// A value for each member, as in GLSL.
Type BodyChecker::struct_constructor(Expression& e, CallExpression& call, Type type)
{
    const std::vector<StructMember>& members = type.structure->members;
    bool is_damaged = false;
    for (size_t i = 0; i < call.arguments.size(); ++i) {
        is_damaged |= expression(*call.arguments[i]).is_error();
        if (i < members.size() && call.arguments.size() == members.size())
            require(*call.arguments[i], members[i].type, " for the member " + quoted(members[i].name));
    }
    call.target.is_constructor = true;
    call.target.function_arguments.assign(call.arguments.size(), {});
    if (!is_damaged && call.arguments.size() != members.size())
        return fail(e.span, "wrong-argument-count",
                    to_string(type) + " has " + std::to_string(members.size()) +
                        (members.size() == 1 ? " member" : " members") + ", found " +
                        std::to_string(call.arguments.size()) + (call.arguments.size() == 1 ? " value" : " values"),
                    "write a value for each: " + constructor_of(type));
    return type;
}

} // namespace haptel::lang
