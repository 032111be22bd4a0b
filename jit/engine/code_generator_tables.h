// What LLVM's code generator makes when it is first needed, and destroys when the process ends.
#pragma once

namespace llvm {
class TargetMachine;
}

namespace haptel::jit {

// Makes the types of SelectionDAG's nodes. Objects of the process are destroyed in the reverse order of their making,
// exit handlers in between: a thread that an exit handler ends may use only what was made before that handler was
// registered. Drafts need no SelectionDAG, so that the optimiser's thread might be the first to make them.
void make_code_generator_tables(const llvm::TargetMachine& machine);

} // namespace haptel::jit
