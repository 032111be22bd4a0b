#include "jit/engine/code_generator_tables.h"

#include "jit/codegen/llvm.h"

#include <llvm/CodeGen/SelectionDAG.h>

namespace haptel::jit {

void make_code_generator_tables(const llvm::TargetMachine& machine)
{
    llvm::SelectionDAG(machine, machine.getOptLevel()).getVTList(llvm::MVT::f64);
}

} // namespace haptel::jit
