// Golden files: source with what the compiler must say beside the line that causes it,
//
//   float a = vec2(1.0); //! 11 error: expected float for 'a', found vec2 [type-mismatch] = write vec2(1.0).x
//
// column, severity, message, code and, where it matters, the hint. Several on one line follow each other. Everything
// that is said must be expected and everything expected must be said.
#pragma once

#include <string>

namespace haptel::lang::test {

// What is missing and what is unexpected, one per line; empty: all is as it should be.
std::string golden_differences(const std::string& text);

} // namespace haptel::lang::test
