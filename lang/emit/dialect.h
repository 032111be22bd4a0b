// What differs between the languages that functions of the IR are written in (C99, GLSL); what they have in common is
// in function.h.
#pragma once

#include "lang/ir/ir.h"

#include <span>
#include <string>

namespace haptel::emit {

// What the languages call differently in one operation.
struct OperationWords {
    const char *abs, *round, *suffix;   // of functions that are exact; what stands behind the name of each
    const char *both, *either, *one_of; // of truths
    bool has_fma;                       // and arithmetic of numbers that are not finite
};

class Dialect {
public:
    virtual ~Dialect() = default;

    // Of what a function returns; of a variable, of one that is set once, and of a parameter, where they are declared.
    virtual std::string type(ir::Type type) const = 0;
    virtual std::string variable(ir::Type type) const = 0;
    virtual std::string fixed(ir::Type type) const = 0;
    virtual std::string parameter(ir::Type type) const = 0;
    virtual uint64_t bytes(ir::Type type) const = 0;

    virtual std::string real(double value) const = 0;
    virtual std::string truth(bool value) const = 0;
    // One operation; operands are names or literals. Integers of both kinds are unsigned words in two's complement.
    std::string expression(ir::Op op, std::span<const std::string> operands) const; // operation.cpp
    virtual OperationWords operation_words() const = 0;
    // A value as of that type; i32 is signed here.
    virtual std::string cast(ir::Type to, const std::string& value) const = 0;
    // What an entry reads, as a value of a variable.
    virtual std::string read(ir::Input input) const = 0;
    virtual std::string read(const ir::Texture& texture, const ir::Parameter& parameter) const = 0;

    // Functions of one result return it; those of several have a variable of the caller's for each.
    virtual std::string out_argument(const std::string& variable) const = 0;
    virtual std::string out_parameter(ir::Type type, const std::string& name) const = 0;
    virtual std::string set_out(const std::string& name, const std::string& value) const = 0;
    // The head of a function, without the brace.
    virtual std::string head(const std::string& result, const std::string& name,
                             const std::string& parameters) const = 0;
    // A statement that says that nothing reads the parameter; empty where none is needed.
    virtual std::string unused(const std::string& parameter) const = 0;

    // The declaration of a constant table: `cells` are literals, in lines.
    virtual std::string table(ir::Type element, const std::string& name, uint32_t size,
                              const std::string& cells) const = 0;
};

} // namespace haptel::emit
