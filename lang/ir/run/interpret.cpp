#include "lang/ir/run/interpret_machine.h"

namespace haptel::ir {

template class Interpreter<double>;
template std::vector<Scalar<double>> interpret(const Module&, uint32_t, std::span<const Scalar<double>>,
                                               const EntryInputs<double>*);

} // namespace haptel::ir
