// Folding and sharing: as text, and as the same function over values that break careless identities.
#include "lang/ir/builder.h"
#include "lang/ir/derive/differentiate.h"
#include "lang/ir/int_range.h"
#include "lang/ir/op_info.h"
#include "tests/lang/ir/ir_random.h"
#include "tests/lang/ir/ir_support.h"

#include <random>

using namespace ir_test;

namespace {

// The module's last function once more through the builder, which folds: a derivative in no direction.
uint32_t rebuild(Module& module)
{
    auto last = static_cast<uint32_t>(module.functions.size() - 1);
    return Differentiator(module).derivative(last, {}).function;
}

// Body of a function after rebuilding, one line per instruction.
std::string rebuilt(const std::string& parameters, const std::string& body)
{
    Module module = parsed("table \"T\" real [1, 2, 3, 4]\nfunction \"f\" (" + parameters + ") {\n" + body + "\n}");
    REQUIRE(verify(module) == "");
    const uint32_t made = rebuild(module);
    REQUIRE(verify(module) == "");
    std::string text = print(module, module.functions[made]);
    return text.substr(text.find("{\n") + 2, text.rfind('}') - text.find("{\n") - 2);
}

} // namespace

TEST_CASE("builder: identities that keep every bit are used")
{
    auto real = [](const std::string& body) { return rebuilt("%x: real, %y: real", body); };
    CHECK(real("%a = real 1 %b = mul %x, %a return %b") == "  return %0\n");
    CHECK(real("%a = real -0 %b = add %x, %a return %b") == "  return %0\n");
    CHECK(real("%a = real 0 %b = sub %x, %a return %b") == "  return %0\n");
    CHECK(real("%a = neg %x %b = neg %a return %b") == "  return %0\n");
    CHECK(real("%a = neg %x %b = sub %y, %a return %b") == "  %2 = add %1, %0\n  return %2\n");
    CHECK(real("%a = floor %x %b = sub %x, %a return %b") == "  %2 = fract %0\n  return %2\n");
    CHECK(real("%a = floor %x %b = ceil %a return %b") == "  %2 = floor %0\n  return %2\n");
    CHECK(real("%a = real 4 %b = div %x, %a return %b") == "  %2 = real 0.25\n  %3 = mul %0, %2\n  return %3\n");
    CHECK(real("%a = lt %x, %y %b = select %a, %x, %x return %b") == "  return %0\n");
    CHECK(real("%a = real 2 %b = real 3 %c = pow %a, %b return %c") == "  %2 = real 8\n  return %2\n");
}

TEST_CASE("builder: the cells of a table are looked at once, however often it is read")
{
    Module module;
    module.tables.push_back({"T", Type::i32, {}, {0, 3, 1, 2}});
    const auto clamps = [&] {
        Builder builder(module, "f" + std::to_string(module.functions.size()));
        const Value cell = builder.table(0, builder.clamp_index(builder.parameter(Type::i32), 4));
        const size_t before = builder.function().value_types.size();
        builder.clamp_index(cell, 4);
        return builder.function().value_types.size() > before;
    };
    CHECK(!clamps()); // 0 .. 3 is in range as it is
    module.tables[0].words[1] = 9;
    CHECK(!clamps()); // known from the first look
    module.tables[0].range.reset();
    CHECK(clamps());
}

TEST_CASE("builder: identities that would lose NaN or -0 are not")
{
    auto kept = [](const std::string& body, const char* operation) {
        return rebuilt("%x: real", body).find(operation) != std::string::npos;
    };
    CHECK(kept("%a = real 0 %b = add %x, %a return %b", "add"));
    CHECK(kept("%a = real -0 %b = sub %x, %a return %b", "sub"));
    CHECK(kept("%a = real 0 %b = mul %x, %a return %b", "mul"));
    CHECK(kept("%b = sub %x, %x return %b", "sub"));
    CHECK(kept("%b = div %x, %x return %b", "div"));
    CHECK(kept("%b = eq %x, %x return %b", "eq"));
    CHECK(kept("%a = real 3 %b = div %x, %a return %b", "div"));
    CHECK(kept("%a = real 1e-310 %b = div %x, %a return %b", "div"));
}

TEST_CASE("builder: equal operations are shared, from enclosing blocks too, never between arms")
{
    CHECK(rebuilt("%x: real, %y: real, %c: bool", R"(
          %a = mul %x, %y
          %b = mul %y, %x
          %r = if %c { %d = mul %x, %y %e = sin %d yield %e } else { %d = sin %b yield %d }
          %s = sin %a
          %t = add %r, %s
          return %t)") == R"(  %3 = mul %0, %1
  %4 = if %2 {
    %5 = sin %3
    yield %5
  } else {
    %6 = sin %3
    yield %6
  }
  %7 = sin %3
  %8 = add %4, %7
  return %8
)");
}

TEST_CASE("builder: choices and loops that are decided vanish, and so does what nobody needs")
{
    CHECK(rebuilt("%x: real", R"(
          %c = bool false
          %r = if %c { %a = sin %x yield %a } else { %b = cos %x yield %b }
          %n = i32 0
          %s = for %n max 0 (%i, %v) from (%r) { %w = sin %v yield %w }
          %m = i32 1
          %t = for %m max 1 (%i, %v) from (%s) { %w = i_to_r %i %z = max %v, %w yield %z }
          %unused = exp %x
          return %t)") == "  %1 = cos %0\n  %2 = real 0\n  %3 = max %1, %2\n  return %3\n");
    // what both arms agree on is not chosen; a choice between true and false is the condition
    CHECK(rebuilt("%x: real, %c: bool", R"(
          %p, %q, %r = if %c {
            %one = real 1  %t = bool true  yield %one, %x, %t
          } else {
            %one = real 1  %f = bool false  yield %one, %x, %f
          }
          return %p, %q, %r)") == "  %2 = real 1\n  return %2, %0, %1\n");
    // an if and a loop keep only the results that are read
    CHECK(rebuilt("%x: real, %c: bool", R"(
          %p, %q = if %c { %a = sin %x yield %a, %x } else { %a = cos %x yield %x, %a }
          %n = i32 3
          %r, %s = for %n max 3 (%i, %v, %w) from (%q, %x) { %y = neg %w yield %v, %y }
          return %s, %q)") == R"(  %2 = if %1 {
    yield %0
  } else {
    %3 = cos %0
    yield %3
  }
  %4 = i32 3
  %5 = for %4 max 3 (%6, %7) from (%0) {
    %8 = neg %7
    yield %8
  }
  return %5, %2
)");
}

TEST_CASE("builder: an index or a trip count is clamped where its making does not bound it")
{
    auto indexed = [](auto&& make) {
        Module module;
        module.tables.push_back({"T", Type::real, {1, 2, 3, 4}, {}});
        Builder builder(module, "f");
        Value x = builder.parameter(Type::i32), u = builder.parameter(Type::u32);
        Value result = builder.table(0, builder.clamp_index(make(builder, x, u), 4));
        builder.finish({&result, 1});
        REQUIRE(verify(module) == "");
        std::string text = print(module);
        return text.find("imin") != std::string::npos || text.find("imax") != std::string::npos;
    };
    CHECK(indexed([](Builder&, Value x, Value) { return x; }));
    CHECK(indexed([](Builder& b, Value x, Value) { return b.operation(Op::iand, {x, b.i32(7)}); }));
    CHECK(indexed([](Builder& b, Value x, Value) { return b.operation(Op::irem, {x, b.i32(4)}); }));
    CHECK_FALSE(indexed([](Builder& b, Value x, Value) { return b.operation(Op::iand, {x, b.i32(3)}); }));
    CHECK_FALSE(indexed(
        [](Builder& b, Value, Value u) { return b.operation(Op::u_as_i, {b.operation(Op::urem, {u, b.u32(4)})}); }));
    CHECK_FALSE(indexed([](Builder& b, Value, Value) { return b.i32(3); }));
    // 5 x & 3 of a loop's own counter
    Module module;
    module.tables.push_back({"T", Type::real, {1, 2, 3, 4}, {}});
    Builder builder(module, "f");
    Value n = builder.parameter(Type::i32), zero = builder.real(0);
    std::vector<Value> sum = builder.for_loop(n, 4, {&zero, 1}, [&](Value i, std::span<const Value> carried) {
        return std::vector{builder.operation(Op::add, {carried[0], builder.table(0, builder.clamp_index(i, 4))})};
    });
    builder.finish(sum);
    CHECK(verify(module) == "");
    CHECK(print(module).find("imax") == std::string::npos);
    for (auto [trips, expected] : {std::pair{4u, 10.0}, {9u, 10.0}, {2u, 3.0}, {0xffffffffu, 0.0}}) {
        const Slot<double> argument{0, trips};
        CHECK(Interpreter<double>(module).run(0, {&argument, 1}, nullptr)[0].real == expected);
    }
}

TEST_CASE("folding: constants in any place give the same bits as the operation itself")
{
    const double reals[] = {0.0,   -0.0,   1.0,     -1.0,   2.0,     0.5,      -0.25,  3.7,
                            1e308, 5e-324, -1e-310, 1e-300, 1 / 0.0, -1 / 0.0, 0 / 0.0};
    const uint32_t words[] = {0, 1, 2, 5, 31, 33, 0x7fffffff, 0x80000000, 0xffffffff, 0xfffffffe};
    std::mt19937 random(7);
    for (const OpInfo& info : all_ops()) {
        if (info.operands[0] == 'm') continue; // of images: bounds/spline_test.cpp
        CAPTURE(info.name);
        for (int round = 0; round < 800; ++round) {
            Module module;
            Builder builder(module, "f");
            // Each operand: a parameter, minus a parameter, a constant, or the first parameter again.
            std::vector<Slot<double>> actual, arguments;
            std::vector<Type> types;
            std::vector<Value> parameters, operands;
            for (char kind : info.operands) {
                types.push_back(kind == 'r' || kind == '*' ? Type::real
                                : kind == 'i'              ? Type::i32
                                : kind == 'u'              ? Type::u32
                                                           : Type::boolean);
                parameters.push_back(builder.parameter(types.back()));
                arguments.push_back({reals[random() % std::size(reals)], words[random() % std::size(words)]});
                if (kind == 'b') arguments.back().bits &= 1;
            }
            for (size_t i = 0; i < types.size(); ++i) {
                Slot<double> value = arguments[i];
                Value operand = parameters[i];
                switch (random() % 4) {
                case 0:
                    if (types[i] == Type::real) {
                        operand = builder.operation(Op::neg, {operand});
                        value.real = -value.real;
                    }
                    break;
                case 1:
                    operand = types[i] == Type::real  ? builder.real(value.real)
                              : types[i] == Type::i32 ? builder.i32(static_cast<int32_t>(value.bits))
                              : types[i] == Type::u32 ? builder.u32(value.bits)
                                                      : builder.boolean(value.bits != 0);
                    break;
                case 2:
                    for (size_t j = 0; j < i; ++j)
                        if (types[j] == types[i]) operand = parameters[j], value = arguments[j];
                    break;
                default: break;
                }
                operands.push_back(operand);
                actual.push_back(value);
            }
            Value result = builder.operation(info.op, operands);
            builder.finish({&result, 1});
            actual.resize(4);
            Slot<double> expected;
            execute(info.op, expected, actual[0], actual[1], actual[2], actual[3]);
            Slot<double> found = Interpreter<double>(module).run(0, arguments, nullptr)[0];
            CAPTURE(print(module), expected.real, found.real, expected.bits, found.bits);
            bool equal = same(module.functions[0], 0, expected, found);
            CHECK(equal);
            if (!equal) return;
        }
    }
}

TEST_CASE("folding: random programs with NaN, infinities, -0 and subnormals compute the same")
{
    int finite = 0;
    for (uint32_t seed = 1; seed <= 1500; ++seed) {
        CAPTURE(seed);
        Module module = random_module(seed, Flavour::wild);
        const auto original = static_cast<uint32_t>(module.functions.size() - 1);
        REQUIRE(verify(module) == "");
        const uint32_t folded = rebuild(module);
        REQUIRE(verify(module) == "");
        Interpreter<double> machine(module);
        for (uint32_t sample = 0; sample < 6; ++sample) {
            auto point = random_arguments(module.functions[original], seed * 97 + sample, Flavour::wild);
            std::vector<Slot<double>> before;
            for (const auto& slot : machine.run(original, point, nullptr)) before.push_back(slot);
            auto after = machine.run(folded, point, nullptr);
            for (size_t i = 0; i < before.size(); ++i) {
                CHECK(same(module.functions[original], i, before[i], after[i]));
                finite += semantics::is_finite(before[i].real);
            }
        }
    }
    CHECK(finite > 5000);
}

TEST_CASE("integer ranges hold what the operations give")
{
    std::mt19937 random(3);
    for (const OpInfo& info : all_ops()) {
        if (info.operands.find_first_of("r*m") != std::string_view::npos) continue;
        CAPTURE(info.name);
        auto type_of = [](char kind) { return kind == 'i' ? Type::i32 : kind == 'u' ? Type::u32 : Type::boolean; };
        if (info.result == 'r') continue;
        const Type result_type = type_of(info.result);
        for (int round = 0; round < 2000; ++round) {
            std::vector<IntRange> ranges;
            for (char kind : info.operands) {
                IntRange full = full_range(type_of(kind));
                auto edge = [&]() -> int64_t {
                    const int64_t edges[] = {full.minimum, full.maximum, 0, 1, -1, 3, -7, 12, 31, 32, 1000};
                    return std::clamp(edges[random() % std::size(edges)], full.minimum, full.maximum);
                };
                int64_t a = edge(), b = edge();
                ranges.push_back({std::min(a, b), std::max(a, b)});
            }
            IntRange claimed = range_of(info.op, result_type, ranges);
            for (int sample = 0; sample < 10; ++sample) {
                Slot<double> in[4], out;
                for (size_t i = 0; i < ranges.size(); ++i) {
                    std::uniform_int_distribution<int64_t> any(ranges[i].minimum, ranges[i].maximum);
                    int64_t value =
                        sample < 4 ? (sample >> i & 1 ? ranges[i].maximum : ranges[i].minimum) : any(random);
                    in[i].bits = static_cast<uint32_t>(value);
                }
                execute(info.op, out, in[0], in[1], in[2], in[3]);
                int64_t value = result_type == Type::i32 ? int64_t{static_cast<int32_t>(out.bits)} : int64_t{out.bits};
                bool inside = claimed.minimum <= value && value <= claimed.maximum;
                CAPTURE(claimed.minimum, claimed.maximum, value);
                CHECK(inside);
                if (!inside) return;
            }
        }
    }
    CHECK(range_of(Op::iand, Type::i32, std::vector<IntRange>{{INT32_MIN, INT32_MAX}, {255, 255}}) == IntRange{0, 255});
    CHECK(range_of(Op::urem, Type::u32, std::vector<IntRange>{{0, UINT32_MAX}, {32, 32}}) == IntRange{0, 31});
    // Beyond 64 bits; it wraps to 1.
    const std::vector<IntRange> ends = {{UINT32_MAX, UINT32_MAX}, {UINT32_MAX, UINT32_MAX}};
    CHECK(range_of(Op::imul, Type::u32, ends) == IntRange{0, UINT32_MAX});
}
