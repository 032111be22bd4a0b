// Functions of the IR in C99: see lang/emit/function.h.
#pragma once

#include "lang/emit/dialect.h"

namespace haptel::emit_c {

// Reals are of type double or, where `is_single`, float; integers of type uint32_t, in two's complement; truths of type
// int, 0 or 1; images of type const haptel_image*. What C has no operator for is a call of a function of
// lang/emit_c/helpers.h, or of <math.h> where that is exact or correctly rounded. An entry reads *point and *values.
class CDialect final : public emit::Dialect {
public:
    explicit CDialect(bool of_floats) : is_single(of_floats) {}

    std::string type(ir::Type type) const override;
    std::string variable(ir::Type of) const override { return type(of); }
    std::string fixed(ir::Type type) const override;
    std::string parameter(ir::Type type) const override { return fixed(type); }
    uint64_t bytes(ir::Type type) const override;

    std::string real(double value) const override;
    std::string truth(bool value) const override { return value ? "1" : "0"; }
    emit::OperationWords operation_words() const override
    {
        return {"fabs", "nearbyint", is_single ? "f" : "", " & ", " | ", " ^ ", true};
    }
    std::string cast(ir::Type to, const std::string& value) const override
    {
        return "(" + (to == ir::Type::i32 ? "int32_t" : type(to)) + ")" + value;
    }
    std::string read(ir::Input input) const override;
    std::string read(const ir::Texture& texture, const ir::Parameter& parameter) const override;

    std::string out_argument(const std::string& variable) const override { return "&" + variable; }
    std::string out_parameter(ir::Type of, const std::string& name) const override
    {
        return type(of) + "* const " + name;
    }
    std::string set_out(const std::string& name, const std::string& value) const override
    {
        return "*" + name + " = " + value;
    }
    std::string head(const std::string& result, const std::string& name, const std::string& parameters) const override
    {
        return "static " + result + " " + name + "(" + (parameters.empty() ? "void" : parameters) + ")";
    }
    std::string unused(const std::string& parameter) const override { return "    (void)" + parameter + ";\n"; }
    std::string table(ir::Type element, const std::string& name, uint32_t size,
                      const std::string& cells) const override;

private:
    const bool is_single;
};

} // namespace haptel::emit_c
