// Modules of the IR from their text form.
#pragma once

#include "lang/ir/verify.h"
#include "tests/support/catch.h"
#include "tests/support/ir_parse.h"

#include <string>
#include <utility>

namespace haptel::test {

inline ir::Module parsed(const std::string& text)
{
    ir::ParsedModule result = ir::parse(text);
    INFO(text);
    INFO(result.error);
    REQUIRE(result.module);
    REQUIRE(ir::verify(*result.module).empty());
    return std::move(*result.module);
}

} // namespace haptel::test
