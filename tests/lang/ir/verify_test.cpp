// verify refuses every kind of broken module: each case breaks one thing in a good one.
#include "tests/lang/ir/ir_random.h"
#include "tests/lang/ir/ir_support.h"

#include <functional>

using namespace ir_test;

namespace {

const char* good = R"(
    table "T" real [1, 2, 3]
    function "f" (%x: real, %n: i32, %c: bool) first 1 {
      %zero = i32 0
      %two = i32 2
      %a = imax %n, %zero
      %i = imin %a, %two
      %t = table 0 %i
      %y = add %x, %t
      %r = if %c { %s = sin %y yield %s } else { yield %x }
      %l = for %i max 2 (%k, %v) from (%r) { %w = neg %v yield %w }
      return %l
    }
    function "body" () {
      %x = input p_x
      %n = parameter 0 i32
      %c = bool true
      %h = call "f" (%x, %n, %c)
      return %h
    }
    function "height" () {
      %x = input p_x
      %u = u32 0
      return %x, %u
    }
    texture "t" {
      parameter "n" i32 1 in 0 .. 2 unit "" offset 56
      block 64 reads 1 writes 0
      body "body"
      height "height"
    })";

using Break = std::function<void(Module&)>;

Instruction& instruction(Module& module, size_t index)
{
    return module.functions[0].body.instructions[index];
}
Block& body(Module& module)
{
    return module.functions[0].body;
}
If& choice(Module& module)
{
    return std::get<If>(instruction(module, 6).kind);
}
For& loop(Module& module)
{
    return std::get<For>(instruction(module, 7).kind);
}

} // namespace

TEST_CASE("verify: a good module passes, each broken one is refused with the cause")
{
    CHECK(verify(parsed(good)) == "");
    struct {
        const char* cause;
        Break broken;
    } const cases[] = {
        {"used where it is not defined",
         [](Module& m) { std::swap(body(m).instructions[4], body(m).instructions[5]); }},
        {"used where it is not defined", [](Module& m) { instruction(m, 5).operands[0] = {999}; }},
        {"used where it is not defined",
         [](Module& m) { body(m).yields[0] = choice(m).arms[0].instructions[0].results[0]; }},
        {"used where it is not defined", [](Module& m) { body(m).yields[0] = loop(m).body[0].parameters[1]; }},
        {"used where it is not defined",
         [](Module& m) { choice(m).arms[1].yields[0] = choice(m).arms[0].instructions[0].results[0]; }},
        {"defined twice", [](Module& m) { instruction(m, 1).results[0] = instruction(m, 0).results[0]; }},
        {"out of range", [](Module& m) { instruction(m, 5).results[0] = {999}; }},
        {"wrong type or number", [](Module& m) { instruction(m, 5).operands.pop_back(); }},
        {"wrong type or number", [](Module& m) { instruction(m, 5).results.push_back({0}); }},
        {"operands of a wrong type", [](Module& m) { instruction(m, 5).operands[0] = m.functions[0].parameters[1]; }},
        {"results of a wrong type",
         [](Module& m) { m.functions[0].value_types[instruction(m, 5).results[0].index] = Type::i32; }},
        {"unknown operation", [](Module& m) { std::get<Operation>(instruction(m, 5).kind).op = static_cast<Op>(200); }},
        {"neither constant nor clamped",
         [](Module& m) { instruction(m, 4).operands[0] = instruction(m, 2).results[0]; }},
        {"neither constant nor clamped", [](Module& m) { m.tables[0].reals.pop_back(); }},
        {"no cells", [](Module& m) { m.tables[0].reals.clear(); }},
        {"no cells", [](Module& m) { m.tables[0].words = {1}; }},
        {"unknown table", [](Module& m) { std::get<ReadTable>(instruction(m, 4).kind).table = 7; }},
        {"condition", [](Module& m) { instruction(m, 6).operands[0] = m.functions[0].parameters[0]; }},
        {"two arms", [](Module& m) { choice(m).arms.pop_back(); }},
        {"yields", [](Module& m) { choice(m).arms[1].yields.clear(); }},
        {"yields", [](Module& m) { choice(m).arms[1].yields[0] = m.functions[0].parameters[1]; }},
        {"arm of an if has parameters", [](Module& m) { choice(m).arms[0].parameters.push_back({0}); }},
        {"exceed its bound", [](Module& m) { loop(m).trip_max = 1; }},
        {"exceed its bound", [](Module& m) { instruction(m, 7).operands[0] = m.functions[0].parameters[1]; }},
        {"trip count of a loop", [](Module& m) { instruction(m, 7).operands[0] = m.functions[0].parameters[0]; }},
        {"one body", [](Module& m) { loop(m).body.clear(); }},
        {"carries", [](Module& m) { instruction(m, 7).operands.pop_back(); }},
        {"carries", [](Module& m) { loop(m).body[0].parameters.pop_back(); }},
        {"carries", [](Module& m) { loop(m).body[0].yields[0] = loop(m).body[0].parameters[0]; }},
        {"call goes forward", [](Module& m) { std::get<Call>(m.functions[1].body.instructions[3].kind).function = 1; }},
        {"call goes forward",
         [](Module& m) { std::get<Call>(m.functions[1].body.instructions[3].kind).function = 50; }},
        {"an entry is called",
         [](Module& m) {
             m.functions[2].body.instructions.push_back({Call{1}, {}, {{2}}, {}});
             m.functions[2].value_types.push_back(Type::real);
         }},
        {"arguments or results of a wrong type",
         [](Module& m) {
             std::swap(m.functions[1].body.instructions[3].operands[0],
                       m.functions[1].body.instructions[3].operands[1]);
         }},
        {"outside of an entry", [](Module& m) { instruction(m, 0).kind = ReadInput{Input::p_x}; }},
        {"outside of an entry", [](Module& m) { instruction(m, 0).kind = ReadParameter{0}; }},
        {"unknown texture parameter", [](Module& m) { m.textures[0].parameters.clear(); }},
        {"unknown input",
         [](Module& m) {
             std::get<ReadInput>(m.functions[1].body.instructions[0].kind).input = static_cast<Input>(99);
         }},
        {"results of a wrong type", [](Module& m) { m.textures[0].parameters[0].type = Type::u32; }},
        {"outside of the block", [](Module& m) { m.textures[0].parameters[0].offset = 64; }},
        {"outside of the block", [](Module& m) { m.textures[0].parameters[0].offset = 0; }},
        {"outside of the block", [](Module& m) { m.textures[0].parameters[0].offset = 58; }},
        {"wrong results", [](Module& m) { m.functions[2].body.yields.pop_back(); }},
        {"no such entry", [](Module& m) { m.textures[0].height = 44; }},
        {"first argument", [](Module& m) { m.functions[0].first_argument_size = 9; }},
        {"share an entry", [](Module& m) { m.textures.push_back(m.textures[0]); }},
        {"operations per call",
         [](Module& m) {
             // 2^24 additions in nested calls
             for (int i = 0; i < 24; ++i) {
                 Function doubled;
                 doubled.name = "d" + std::to_string(i);
                 doubled.value_types = {Type::real, Type::real, Type::real};
                 doubled.parameters = {{0}};
                 Kind twice = Operation{Op::sin};
                 if (i > 0) twice = Call{static_cast<uint32_t>(i - 1)};
                 doubled.body.instructions = {{twice, {{0}}, {{1}}, {}}, {twice, {{1}}, {{2}}, {}}};
                 doubled.body.yields = {{2}};
                 m.functions.insert(m.functions.begin() + i, doubled);
             }
             m.textures[0].height += 24;
             m.textures[0].body = m.textures[0].height - 1;
             Function& entry = m.functions[m.textures[0].body];
             entry.body.instructions.back() = {Call{23}, {{0}}, entry.body.yields, {}};
             entry.parameters.clear();
         }},
    };
    for (const auto& c : cases) {
        Module module = parsed(good);
        c.broken(module);
        const std::string problem = verify(module);
        CAPTURE(c.cause, problem);
        CHECK(problem.find(c.cause) != std::string::npos);
    }
}

TEST_CASE("verify: nesting of blocks and calls is bounded")
{
    Module deep = parsed("function \"f0\" (%x: real) { %y = sin %x return %y }");
    for (uint32_t i = 1; i <= nesting_max + 1; ++i) {
        Function next = deep.functions[0];
        next.name = "f" + std::to_string(i);
        next.body.instructions[0].kind = Call{i - 1};
        deep.functions.push_back(next);
        if (i == nesting_max) CHECK(verify(deep) == "");
    }
    CHECK(verify(deep).find("calls nest deeper") != std::string::npos);
}

TEST_CASE("verify: operations are counted at their worst")
{
    Module module = parsed(R"(
        function "f" (%x: real, %c: bool) {
          %one = real 1
          %n = i32 5
          %r = if %c { %a = sin %x yield %a } else { %a = sin %x %b = cos %a yield %b }
          %s = for %n max 5 (%i, %v) from (%r) { %w = add %v, %one %z = neg %w yield %z }
          return %s
        }
        function "g" (%x: real, %c: bool) { %a = call "f" (%x, %c) %b = call "f" (%a, %c) return %b })");
    CHECK(operations_max(module, 0) == 1 + 2 + 1 + 5 * (2 + 1));
    CHECK(operations_max(module, 1) == 2 * (19 + 1));

    // Sampling an image: see cost.cpp.
    const Module sampled = parsed(R"(
        function "h" (%m: image, %x: real, %o: i32) { %a = spline %m, %x, %x, %o return %a })");
    CHECK(operations_max(sampled, 0) == 2 * (9 + 19 + 4) + 16 + 2 * (16 + 4));
}

TEST_CASE("verify: an entry returns as many material outputs as its texture writes")
{
    const auto with = [](const std::string& writes) {
        return verify(parsed(R"(
        function "b" () { %h = real 0 %s = real 1 return %h, %s }
        function "hg" () { %h = real 0 %s = real 1 %f = u32 0 return %h, %h, %h, %h, %f, %s, %f }
        texture "t" { block 56 reads 0 writes )" +
                             writes + " body \"b\" height_gradient \"hg\" }"));
    };
    CHECK(with("1") == "");
    CHECK(with("2") == "");
    CHECK(with("0").find("wrong results") != std::string::npos);
    CHECK(with("3").find("wrong results") != std::string::npos);
    CHECK(with("1024") == "texture \"t\" writes outputs that do not exist");
}
