// Conformance files: Haptel source, one behaviour each, with what is expected beside its cause.
//
//   float a = vec2(1.0); //! 11-20 error: expected float for 'a', found vec2 [type-mismatch] = write vec2(1.0).x
//
// says what the compiler must say about this line: first column, end column (may be left out), severity, message, code
// and, where it matters, the hint. Several follow each other. A line that holds nothing else speaks of the line above.
//
//   //= p=1,2,0 set.depth=0.001 height=0.25 gradient=0,0.5,0
//
// is a value of the last texture, in SI units: what is given (p n uv time velocity normal_force tool_radius
// tangent bitangent curvature center extent footprint n_dp uv_dp set.NAME),
// then what must come out (height gradient faults stiffness friction, and out.NAME of any output) to `within=` relative
// (1e-14); a 0 must be exactly 0, and -0 that; oracle=0 leaves out the oracle, which overflows later. What is not
// expected is not looked at, but faults are 0 unless told otherwise.
//
//   //@ bounds     the findings of the analysis of bounds are expected too
//   //@ strict     warnings are errors
//   //--- findings   lines "3:1 error: message [code]", for what cannot stand beside its cause
//   //--- lib.haptel    from here on the text of a file that may be imported under this name
#pragma once

#include "lang/abi/outputs.h"
#include "lang/compile.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace haptel::lang::test {

struct ExpectedFinding {
    std::string place; // "3:12" or "3:12-15", behind the name of the file unless it is the main one
    std::string text;  // "error: message [code]"
    std::string hint;
};

struct Evaluation {
    std::string line; // as written
    haptel_point point{};
    haptel_block_head head{};
    std::vector<std::pair<std::string, std::string>> parameters; // name, plain number or choice

    std::optional<double> height;
    std::vector<std::pair<std::string, std::vector<double>>> outputs; // name, components
    std::optional<std::array<double, 3>> gradient;
    uint32_t faults = 0;
    double within = 1e-14;
    double with_oracle = 1; // 0: of f64 alone, whose range is smaller
};

struct Case {
    SourceFile main;
    std::map<std::string, std::string> imports;
    bool with_bounds = false, strict = false;
    std::vector<ExpectedFinding> findings;
    std::vector<Evaluation> evaluations;
    std::string malformed; // what of the expectations cannot be read, one per line

    ImportLoader loader() const;
};

Case read_case(const std::string& text);

// What is missing and what is unexpected, one per line; empty: all is as it should be.
std::string finding_differences(const Case& expected, const CompileResult& result);

struct Outcome {
    double height = 0;
    std::array<double, 3> gradient{};
    uint32_t faults = 0;
    haptel_sample sample = blank_sample; // its outputs; the rest is above
};
// Likewise; `engine` says who found it.
std::string value_differences(const Evaluation& expected, const std::string& engine, const Outcome& found);

// Compiles without the library, as a case does, and compares the findings.
std::string golden_differences(const std::string& text);

} // namespace haptel::lang::test
