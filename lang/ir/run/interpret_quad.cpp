#include "lang/ir/run/interpret_machine.h"
#include "lang/math/quad.h"

namespace haptel::ir {

template class Interpreter<Quad>;

} // namespace haptel::ir
