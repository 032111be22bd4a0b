#include "tests/lang/syntax/tree_text.h"

#include "lang/syntax/parser.h"

namespace haptel::lang {

using namespace ast;

namespace {

std::string spelling(BinaryOp op)
{
    switch (op) {
    case BinaryOp::add: return "+";
    case BinaryOp::subtract: return "-";
    case BinaryOp::multiply: return "*";
    case BinaryOp::divide: return "/";
    case BinaryOp::remainder: return "%";
    case BinaryOp::less: return "<";
    case BinaryOp::less_equal: return "<=";
    case BinaryOp::greater: return ">";
    case BinaryOp::greater_equal: return ">=";
    case BinaryOp::equal: return "==";
    case BinaryOp::not_equal: return "!=";
    case BinaryOp::logical_and: return "&&";
    case BinaryOp::logical_or: return "||";
    case BinaryOp::logical_xor: return "^^";
    case BinaryOp::bit_and: return "&";
    case BinaryOp::bit_or: return "|";
    case BinaryOp::bit_xor: return "^";
    case BinaryOp::shift_left: return "<<";
    case BinaryOp::shift_right: return ">>";
    }
    return "?";
}

std::string spelling(UnaryOp op)
{
    switch (op) {
    case UnaryOp::negate: return "-";
    case UnaryOp::plus: return "+";
    case UnaryOp::logical_not: return "!";
    case UnaryOp::bit_not: return "~";
    }
    return "?";
}

template <class Pointer>
std::string maybe(const Pointer& expression)
{
    return expression ? tree_text(*expression) : "none";
}

std::string list(const std::vector<ExpressionPtr>& expressions)
{
    std::string text;
    for (const ExpressionPtr& expression : expressions) text += " " + maybe(expression);
    return text;
}

std::string type_text(const TypeName& type)
{
    if (!type.is_array) return type.base.text;
    const auto in_brackets = [](const std::shared_ptr<ArraySize>& size) {
        return "[" + (size ? tree_text(*size->written) : "") + "]";
    };
    return type.base.text + in_brackets(type.array_size) + (type.has_rows ? in_brackets(type.row_size) : "");
}

struct ExpressionText {
    std::string operator()(const ErrorExpression&) const { return "<error>"; }
    std::string operator()(const NumberLiteral& n) const { return n.text; }
    std::string operator()(const BoolLiteral& b) const { return b.value ? "true" : "false"; }
    std::string operator()(const NameExpression& n) const { return n.name; }
    std::string operator()(const Unary& u) const { return "(" + spelling(u.op) + " " + maybe(u.operand) + ")"; }
    std::string operator()(const Chain& c) const
    {
        std::string text = "(" + spelling(c.rest.front().op) + " " + maybe(c.first);
        for (size_t i = 0; i < c.rest.size(); ++i) {
            if (i > 0 && c.rest[i].op != c.rest[i - 1].op) text += " " + spelling(c.rest[i].op);
            text += " " + maybe(c.rest[i].operand);
        }
        return text + ")";
    }
    std::string operator()(const Conditional& c) const
    {
        return "(? " + maybe(c.condition) + " " + maybe(c.when_true) + " " + maybe(c.when_false) + ")";
    }
    std::string operator()(const CallExpression& c) const { return "(call " + c.callee.text + list(c.arguments) + ")"; }
    std::string operator()(const GradCall& g) const
    {
        return "(grad" + std::to_string(g.order) + " " + g.function.text + list(g.arguments) + ")";
    }
    std::string operator()(const Member& m) const { return "(. " + maybe(m.object) + " " + m.member.text + ")"; }
    std::string operator()(const Index& i) const { return "([] " + maybe(i.object) + " " + maybe(i.index) + ")"; }
    std::string operator()(const LeftOut&) const { return "()"; }
    std::string operator()(const BraceList& b) const { return "({}" + list(b.elements) + ")"; }
};

std::string declaration_text(const Declaration& d)
{
    std::string text = std::string(d.is_const ? "(const " : "(let ") + type_text(d.type) + " " + d.name.text;
    return text + (d.initializer ? " " + tree_text(*d.initializer) : "") + ")";
}

std::string maybe(const StatementPtr& statement)
{
    return statement ? tree_text(*statement) : "none";
}

struct StatementText {
    std::string operator()(const Declaration& d) const { return declaration_text(d); }
    std::string operator()(const Assignment& a) const
    {
        return "(" + (a.op ? spelling(*a.op) : "") + "= " + maybe(a.target) + " " + maybe(a.value) + ")";
    }
    std::string operator()(const ExpressionStatement& e) const { return "(do " + maybe(e.expression) + ")"; }
    std::string operator()(const Scope& s) const
    {
        std::string text = "{";
        for (const StatementPtr& statement : s.statements) text += (text.size() > 1 ? " " : "") + maybe(statement);
        return text + "}";
    }
    std::string operator()(const If& i) const
    {
        std::string text = "(if";
        for (const If::Arm& arm : i.arms)
            text += " [" + (arm.condition ? tree_text(*arm.condition) : "else") + " " + maybe(arm.body) + "]";
        return text + ")";
    }
    std::string operator()(const For& f) const
    {
        return "(for " + maybe(f.init) + " " + maybe(f.condition) + " " + maybe(f.step) + " " + maybe(f.body) + ")";
    }
    std::string operator()(const Switch& s) const
    {
        std::string text = "(switch " + maybe(s.selector);
        for (const Switch::Case& one : s.cases) {
            text += " [";
            for (const ExpressionPtr& label : one.labels) text += (label ? tree_text(*label) : "default") + " ";
            text += maybe(one.body) + "]";
        }
        return text + ")";
    }
    std::string operator()(const Break&) const { return "(break)"; }
    std::string operator()(const Continue&) const { return "(continue)"; }
    std::string operator()(const Return& r) const
    {
        return "(return" + (r.value ? " " + tree_text(*r.value) : "") + ")";
    }
};

std::string doc_text(const std::string& doc)
{
    std::string text = doc.empty() ? "" : " \"" + doc + "\"";
    for (char& c : text) {
        if (c == '\n') c = '|';
    }
    return text;
}

} // namespace

std::string tree_text(const Expression& expression)
{
    return std::visit(ExpressionText{}, expression.node);
}

std::string tree_text(const Statement& statement)
{
    return std::visit(StatementText{}, statement.node);
}

std::string tree_text(const File& file)
{
    std::string text;
    for (const Import& import : file.imports)
        text += "import " + import.path + (import.prefix.text.empty() ? "" : " as " + import.prefix.text) + "\n";
    for (const Struct& structure : file.structs) {
        text += "struct " + structure.name.text;
        for (const Struct::Member& member : structure.members)
            text += " (" + type_text(member.type) + " " + member.name.text + ")";
        text += "\n";
    }
    for (const Constant& constant : file.constants) text += declaration_text(constant.declaration) + "\n";
    for (const Function& function : file.functions) {
        text += "function " + type_text(function.result) + " " + function.name.text;
        for (const FunctionParameter& parameter : function.parameters) {
            text += " (" + type_text(parameter.type) + " " + parameter.name.text;
            for (const TypeName& argument : parameter.signature) text += " <- " + type_text(argument);
            text += std::string(parameter.is_function && parameter.signature.empty() ? " <-" : "") + ")";
        }
        text += doc_text(function.doc) + " " + maybe(function.body) + "\n";
    }
    for (const Texture& texture : file.textures) {
        text += "texture " + texture.name.text + doc_text(texture.doc) + "\n";
        for (const TextureParameter& parameter : texture.parameters) {
            text += std::string("  ") + (parameter.is_output ? "out " : "") + type_text(parameter.type) + " " +
                    parameter.name.text;
            if (parameter.value) text += " = " + tree_text(*parameter.value);
            if (parameter.minimum) text += " in " + tree_text(*parameter.minimum) + " .. " + maybe(parameter.maximum);
            for (const Name& choice : parameter.choices)
                text += (&choice == parameter.choices.data() ? " in {" : ", ") + choice.text;
            text += (parameter.choices.empty() ? "" : "}") + doc_text(parameter.doc) + "\n";
        }
        text += "  " + maybe(texture.body) + "\n";
    }
    return text;
}

std::string Parsed::messages() const
{
    std::string text;
    for (const Diagnostic& diagnostic : diagnostics.all()) {
        const Position begin = sources.position(0, diagnostic.span.begin),
                       end = sources.position(0, diagnostic.span.end);
        text += std::to_string(begin.line) + ":" + std::to_string(begin.column);
        if (end.line == begin.line && end.column > begin.column + 1) text += "-" + std::to_string(end.column);
        text += " " + diagnostic.code + ": " + diagnostic.message + "\n";
    }
    return text;
}

Parsed parse_text(std::string_view text)
{
    Parsed parsed;
    parsed.sources.add({"t.haptel", std::string(text)});
    parsed.file = parse(parsed.sources, 0, parsed.diagnostics);
    parsed.diagnostics.sort_by_place();
    return parsed;
}

std::string body_tree(std::string_view text)
{
    const Parsed parsed = parse_text("float f() {" + std::string(text) + "}");
    if (!parsed.diagnostics.all().empty() || parsed.file.functions.size() != 1) return parsed.messages();
    const std::string tree = maybe(parsed.file.functions[0].body);
    return tree.substr(1, tree.size() - 2);
}

std::string expression_tree(std::string_view text)
{
    const std::string tree = body_tree("return " + std::string(text) + ";");
    constexpr std::string_view before = "(return ";
    return tree.starts_with(before) ? tree.substr(before.size(), tree.size() - before.size() - 1) : tree;
}

} // namespace haptel::lang
