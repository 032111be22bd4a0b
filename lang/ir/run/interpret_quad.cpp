#include "lang/ir/run/interpret_machine.h"
#include "lang/math/quad.h"

namespace haptel::ir {

template class Interpreter<Quad>;
template std::vector<Scalar<Quad>> interpret(const Module&, uint32_t, std::span<const Scalar<Quad>>,
                                             const EntryInputs<Quad>*);

} // namespace haptel::ir
