#include "lang/ir/run/interpret_machine.h"

namespace haptel::ir {

template class Interpreter<double>;

} // namespace haptel::ir
