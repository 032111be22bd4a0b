#include "lang/ir/print.h"
#include "lang/ir/run/interpret.h"
#include "lang/ir/verify.h"
#include "tests/support/catch.h"
#include "tests/support/interpret.h"
#include "tests/support/ir_parse.h"

#include <string>

using namespace haptel::ir;

namespace {

// One of everything, as the printer writes it.
const std::string one_of_everything = R"ir(table "G" real [0.5, -0, inf, nan, nan:fff8000000000001]
table "M" u32 [7, 4294967295]
table "I" i32 [-3, 2]
function "noise(vec3)" (%0: real, %1: i32, %2: u32, %3: bool) first 1 library facts minimum -0.5 maximum 0.5 slope 2 curvature 3.25 class C1 proven next next slope 2 class jump {
  %4 = real -0
  %5 = i32 -7
  %6 = u32 9
  %7 = bool true
  %8 = add %0, %4
  %9 = select %3, %8, %0
  %10 = i32 1
  %11 = table 2 %10
  %12, %13 = if %3 {
    %14 = mul %0, %0
    yield %14, %1
  } else {
    yield %0, %5
  }
  %15 = i32 4
  %16, %17 = for %15 max 4 (%18, %19, %20) from (%12, %13) {
    %21 = i_to_r %18
    %22 = add %19, %21
    yield %22, %18
  }
  return %16, %9, %11
}
function "body" () {
  %0 = input p_x
  %1 = parameter 0 i32
  %2 = u32 0
  %3 = bool false
  %4, %5, %6 = call "noise(vec3)" (%0, %1, %2, %3)
  return %4
}
texture "brushed \"fine\"" {
  doc "Long grooves.\nSecond line."
  parameter "octaves" i32 4 in 1 .. 8 unit "" offset 56 doc "how many"
  block 64 reads 1 writes 0
  body "body"
}
)ir";

} // namespace

TEST_CASE("IR text: printing what was read gives the same text")
{
    ParsedModule parsed = parse(one_of_everything);
    REQUIRE(parsed.error == "");
    CHECK(print(*parsed.module) == one_of_everything);
    CHECK(verify(*parsed.module) == "");
    CHECK(print(*parsed.module, parsed.module->functions[1]).starts_with("function \"body\" () {"));
}

TEST_CASE("IR text: what is read is what is computed")
{
    ParsedModule parsed = parse(one_of_everything);
    REQUIRE(parsed.module);
    const Scalar<double> arguments[] = {3.0, 5u, 0u, true};
    // 3 * 3 + (0 + 1 + 2 + 3) = 15; select takes 3 + -0; table cell 1 of I is 2
    std::vector<Scalar<double>> results = interpret<double>(*parsed.module, 0, arguments, nullptr);
    REQUIRE(results.size() == 3);
    CHECK(std::get<double>(results[0]) == 15);
    CHECK(std::get<double>(results[1]) == 3);
    CHECK(std::get<uint32_t>(results[2]) == 2);

    EntryInputs<double> inputs;
    inputs.input[0] = 3;
    inputs.parameters = {{0, 5u}};
    CHECK(std::get<double>(interpret<double>(*parsed.module, 1, {}, &inputs)[0]) == 9); // the else arm: 3 + 6
}

TEST_CASE("IR text: errors name line, cause and remedy")
{
    auto error = [](const std::string& body) {
        return parse("function \"f\" (%0: real) {\n" + body + "\n  return %0\n}\n").error;
    };
    CHECK(error("  %1 = ad %0, %0") == "line 2: unknown operation 'ad', did you mean 'add'?");
    CHECK(error("  %1 = add %0") == "line 3: operands do not fit 'add': rr expected");
    CHECK(error("  %1 = add %0, %7") == "line 2: %7 is not defined here");
    CHECK(error("  %0 = neg %0") == "line 3: %0 is defined twice");
    CHECK(error("  %1 = call \"g\" (%0)") == "line 2: no function 'g' before this one");
    CHECK(error("  %1 = table 0 %0") == "line 2: there is no table 0");
    CHECK(error("  %1, %2 = neg %0") == "line 3: 1 results, 2 names");
    CHECK(parse("rubbish").error == "line 1: expected 'table', 'function' or 'texture', found 'rubbish'");
    CHECK(parse("").module.has_value());
    std::string deep = "function \"f\" (%0: bool) {\n";
    for (int i = 0; i < 20'000; ++i) deep += "%a = if %0 {\n";
    CHECK(parse(deep).error == "line 515: blocks nest deeper than 512");
}
