#include "tests/support/ir_parse.h"

#include "lang/ir/op_info.h"
#include "lang/ir/verify.h"
#include "lang/text/diagnostic.h"
#include "lang/text/near_name.h"
#include "tests/support/ir_tokens.h"

#include <bit>
#include <charconv>
#include <map>

namespace haptel::ir {
namespace {

// The enumerator, of `count`, that is printed as `name`.
template <typename Enum>
std::optional<Enum> enumerator_named(std::string_view name, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i)
        if (to_string(static_cast<Enum>(i)) == name) return static_cast<Enum>(i);
    return std::nullopt;
}

class Parser : TokenReader {
public:
    explicit Parser(std::string_view text) : TokenReader(text) {}

    ParsedModule run()
    {
        try {
            while (token().kind != Token::Kind::end) {
                if (accept("table"))
                    table();
                else if (accept("function"))
                    parse_function();
                else if (accept("texture"))
                    texture();
                else
                    fail("expected 'table', 'function' or 'texture', found " + found());
            }
        } catch (const Failure& failure) {
            return {std::nullopt, "line " + std::to_string(token().line) + ": " + failure.message};
        }
        return {std::move(module), ""};
    }

private:
    Module module;
    Function function;
    std::map<std::string, Value, std::less<>> values;
    std::map<std::string, uint32_t, std::less<>> functions;

    uint32_t word(Type type)
    {
        return type == Type::i32 ? static_cast<uint32_t>(number<int32_t>("a 32-bit number"))
                                 : number<uint32_t>("a 32-bit number");
    }
    // The word that stands here, where it is one that is known.
    template <typename Meaning>
    Meaning known_word(const std::optional<Meaning>& meaning, const std::string& expected)
    {
        if (token().kind != Token::Kind::word || !meaning) fail("expected " + expected + ", found " + found());
        ++next;
        return *meaning;
    }
    Type type()
    {
        return known_word(enumerator_named<Type>(token().text, static_cast<uint32_t>(Type::image) + 1),
                          "a type (real, i32, u32, bool)");
    }
    Continuity continuity()
    {
        return known_word(continuity_named(token().text), "a class (unknown, jump, C0, C1, C2, smooth)");
    }

    Value use()
    {
        if (token().kind != Token::Kind::value) fail("expected a value such as %0, found " + found());
        auto known = values.find(token().text);
        if (known == values.end()) fail("%" + token().text + " is not defined here");
        ++next;
        return known->second;
    }
    std::vector<Value> uses(std::string_view end = "")
    {
        std::vector<Value> list;
        if (!end.empty() ? is(end) : token().kind != Token::Kind::value) return list;
        do list.push_back(use());
        while (accept(","));
        return list;
    }
    std::vector<std::string> names()
    {
        std::vector<std::string> list;
        do list.push_back(take(Token::Kind::value, "a value such as %0"));
        while (accept(","));
        return list;
    }
    Value define(const std::string& name, Type value_type)
    {
        function.value_types.push_back(value_type);
        Value value{static_cast<uint32_t>(function.value_types.size() - 1)};
        if (!values.emplace(name, value).second) fail("%" + name + " is defined twice");
        return value;
    }

    void table()
    {
        Table made;
        made.name = string();
        made.element = type();
        if (made.element == Type::boolean) fail("a table holds real, i32 or u32");
        expect("[");
        while (!is("]")) {
            if (made.element == Type::real)
                made.reals.push_back(real());
            else
                made.words.push_back(word(made.element));
            if (!accept(",")) break;
        }
        expect("]");
        module.tables.push_back(std::move(made));
    }

    void parse_function()
    {
        function = {};
        values.clear();
        function.name = string();
        expect("(");
        while (!is(")")) {
            std::string name = take(Token::Kind::value, "a value such as %0");
            expect(":");
            function.parameters.push_back(define(name, type()));
            if (!accept(",")) break;
        }
        expect(")");
        if (accept("first")) function.first_argument_size = count();
        function.is_library = accept("library");
        if (accept("facts")) do
                function.facts.push_back(facts());
            while (accept("next"));
        expect("{");
        block(function.body, "return", 0);
        expect("}");
        if (!functions.emplace(function.name, static_cast<uint32_t>(module.functions.size())).second)
            fail("function \"" + function.name + "\" is defined twice");
        module.functions.push_back(std::move(function));
    }

    Facts facts()
    {
        Facts made;
        for (;;) {
            if (accept("minimum"))
                made.value_minimum = real();
            else if (accept("maximum"))
                made.value_maximum = real();
            else if (accept("slope"))
                made.slope = real();
            else if (accept("curvature"))
                made.curvature = real();
            else if (accept("class"))
                made.continuity = continuity();
            else if (accept("proven"))
                made.proven = true;
            else
                return made;
        }
    }

    void block(Block& block, std::string_view ending, uint32_t depth)
    {
        if (depth > nesting_max) fail("blocks nest deeper than " + std::to_string(nesting_max));
        std::vector<std::string> defined;
        while (!accept(ending)) {
            std::vector<std::string> results = names();
            expect("=");
            Instruction made;
            std::vector<Type> types = instruction(made, depth);
            if (types.size() != results.size())
                fail(std::to_string(types.size()) + " results, " + std::to_string(results.size()) + " names");
            for (size_t i = 0; i < types.size(); ++i) made.results.push_back(define(results[i], types[i]));
            defined.insert(defined.end(), results.begin(), results.end());
            block.instructions.push_back(std::move(made));
        }
        block.yields = uses();
        for (const std::string& name : defined) values.erase(name);
    }

    // Reads what stands right of "="; returns the types of the results.
    std::vector<Type> instruction(Instruction& made, uint32_t depth)
    {
        if (accept("real")) {
            made.kind = RealConstant{real()};
            return {Type::real};
        }
        for (Type integer : {Type::i32, Type::u32})
            if (accept(to_string(integer))) {
                made.kind = WordConstant{word(integer)};
                return {integer};
            }
        if (accept("bool")) {
            bool value = accept("true");
            if (!value) expect("false");
            made.kind = WordConstant{value};
            return {Type::boolean};
        }
        if (accept("input")) {
            const auto input = enumerator_named<Input>(token().text, input_count);
            if (!input) fail("unknown input " + found());
            ++next;
            made.kind = ReadInput{*input};
            return {Type::real};
        }
        if (accept("parameter")) {
            made.kind = ReadParameter{count()};
            return {type()};
        }
        if (accept("table")) {
            uint32_t index = count();
            if (index >= module.tables.size()) fail("there is no table " + std::to_string(index));
            made.kind = ReadTable{index};
            made.operands = {use()};
            return {module.tables[index].element};
        }
        if (accept("d_dp")) {
            made.kind = PointDerivative{count()};
            if (std::get<PointDerivative>(made.kind).axis > 2) fail("an axis is 0, 1 or 2");
            made.operands = {use()};
            if (function.type(made.operands[0]) != Type::real) fail("a real is expected");
            return {Type::real};
        }
        if (accept("call")) return call(made);
        if (accept("if")) return choice(made, depth);
        if (accept("for")) return loop(made, depth);
        return operation(made);
    }

    std::vector<Type> types_of(const std::vector<Value>& list, size_t first = 0) const
    {
        std::vector<Type> types;
        for (size_t i = first; i < list.size(); ++i) types.push_back(function.type(list[i]));
        return types;
    }

    std::vector<Type> operation(Instruction& made)
    {
        std::optional<Op> op = op_named(token().text);
        if (token().kind != Token::Kind::word || !op) fail("unknown operation " + found() + suggestion());
        ++next;
        made.kind = Operation{*op};
        made.operands = uses();
        std::optional<Type> result = result_type(*op, types_of(made.operands));
        if (!result)
            fail("operands do not fit '" + std::string(op_info(*op).name) + "': " + std::string(op_info(*op).operands) +
                 " expected");
        return {*result};
    }

    std::string suggestion() const
    {
        std::vector<std::string_view> names;
        for (const OpInfo& info : all_ops()) names.push_back(info.name);
        const std::string_view nearest = near_name(token().text, names).name;
        return nearest.empty() ? "" : ", did you mean '" + std::string(nearest) + "'?";
    }

    uint32_t known_function()
    {
        const auto known = functions.find(token().text);
        if (token().kind != Token::Kind::string || known == functions.end())
            fail("no function " + found() + " before this one");
        ++next;
        return known->second;
    }

    std::vector<Type> call(Instruction& made)
    {
        const uint32_t callee = known_function();
        const Function& called = module.functions[callee];
        made.kind = Call{callee};
        expect("(");
        made.operands = uses(")");
        expect(")");
        std::vector<Type> types;
        for (Value result : called.body.yields) types.push_back(called.type(result));
        return types;
    }

    std::vector<Type> choice(Instruction& made, uint32_t depth)
    {
        made.operands = {use()};
        If arms;
        arms.arms.resize(2);
        expect("{");
        block(arms.arms[0], "yield", depth + 1);
        expect("}");
        expect("else");
        expect("{");
        block(arms.arms[1], "yield", depth + 1);
        expect("}");
        std::vector<Type> types = types_of(arms.arms[0].yields);
        made.kind = std::move(arms);
        return types;
    }

    std::vector<Type> loop(Instruction& made, uint32_t depth)
    {
        made.operands = {use()};
        expect("max");
        For loop{count(), std::vector<Block>(1)};
        expect("(");
        std::vector<std::string> parameters = names();
        expect(")");
        expect("from");
        expect("(");
        std::vector<Value> initial = uses(")");
        expect(")");
        if (parameters.size() != initial.size() + 1)
            fail(std::to_string(parameters.size()) + " parameters for the iteration and " +
                 std::to_string(initial.size()) + " carried values");
        made.operands.insert(made.operands.end(), initial.begin(), initial.end());
        std::vector<Type> types = types_of(initial);
        loop.body[0].parameters.push_back(define(parameters[0], Type::i32));
        for (size_t i = 0; i < types.size(); ++i)
            loop.body[0].parameters.push_back(define(parameters[i + 1], types[i]));
        expect("{");
        block(loop.body[0], "yield", depth + 1);
        expect("}");
        for (const std::string& name : parameters) values.erase(name);
        made.kind = std::move(loop);
        return types;
    }

    void texture()
    {
        Texture made;
        made.name = string();
        expect("{");
        if (accept("doc")) made.doc = string();
        while (accept("parameter")) {
            Parameter parameter;
            parameter.name = string();
            parameter.type = type();
            parameter.value = real();
            expect("in");
            parameter.minimum = real();
            expect("..");
            parameter.maximum = real();
            expect("unit");
            parameter.unit = string();
            expect("offset");
            parameter.offset = count();
            if (accept("doc")) parameter.doc = string();
            made.parameters.push_back(std::move(parameter));
        }
        expect("block");
        made.block_size = count();
        expect("reads");
        made.reads = count();
        expect("writes");
        made.writes = count();
        auto entry = [&](std::string_view role, uint32_t& index) {
            if (accept(role)) index = known_function();
        };
        entry("body", made.body);
        entry("height", made.height);
        entry("height_gradient", made.height_gradient);
        expect("}");
        module.textures.push_back(std::move(made));
    }
};

} // namespace

ParsedModule parse(std::string_view text)
{
    return Parser(text).run();
}

} // namespace haptel::ir
