// Functions of the IR in GLSL: see lang/emit/function.h.
#pragma once

#include "lang/emit/dialect.h"

namespace haptel::emit_glsl {

// Reals are of type float; integers of type uint, in two's complement; truths of type bool; images of type int: where
// in haptel_images what is known of one begins, 0 for none. What GLSL has no operator for is a call of a function of
// lang/emit_glsl/helpers.h, or of GLSL where that is exact. An entry reads `point` and `values`.
//
// haptel_precise stands for `precise` where the version of GLSL has it: nothing is then fused or reassociated.
class GlslDialect final : public emit::Dialect {
public:
    std::string type(ir::Type type) const override;
    std::string variable(ir::Type of) const override
    {
        return (of == ir::Type::real ? "haptel_precise " : "") + type(of);
    }
    std::string fixed(ir::Type of) const override { return variable(of); }
    std::string parameter(ir::Type of) const override { return type(of); }
    uint64_t bytes(ir::Type) const override { return 4; }

    std::string real(double value) const override;
    std::string truth(bool value) const override { return value ? "true" : "false"; }
    emit::OperationWords operation_words() const override
    {
        return {"abs", "roundEven", "", " && ", " || ", " ^^ ", false};
    }
    std::string cast(ir::Type to, const std::string& value) const override
    {
        return (to == ir::Type::i32 ? "int" : type(to)) + "(" + value + ")";
    }
    std::string read(ir::Input input) const override;
    std::string read(const ir::Texture& texture, const ir::Parameter& parameter) const override;

    std::string out_argument(const std::string& variable) const override { return variable; }
    std::string out_parameter(ir::Type of, const std::string& name) const override
    {
        return "out " + type(of) + " " + name;
    }
    std::string set_out(const std::string& name, const std::string& value) const override
    {
        return name + " = " + value;
    }
    std::string head(const std::string& result, const std::string& name, const std::string& parameters) const override
    {
        return result + " " + name + "(" + parameters + ")";
    }
    std::string unused(const std::string&) const override { return {}; }
    std::string table(ir::Type element, const std::string& name, uint32_t size,
                      const std::string& cells) const override;
};

} // namespace haptel::emit_glsl
