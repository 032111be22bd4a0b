#include "jit/engine/compilers.h"

#include "jit/engine/machine_code.h"

namespace haptel::jit {

std::string Compilers::start(const llvm::orc::JITTargetMachineBuilder& host)
{
    builder = host;
    std::string error;
    const Lease first(*this, Effort::draft, error);
    return error;
}

Object Compilers::make(llvm::Module& module, Effort effort, CompileTimes& times)
{
    Object object;
    object.effort = effort;
    const Lease lease(*this, effort, object.error);
    if (!lease.machine) return object;
    llvm::SmallVector<char, 0> made;
    object.error = make_object(module, *lease.machine, effort, made, times);
    object.bytes.assign(made.data(), made.size());
    return object;
}

Compilers::Lease::Lease(Compilers& owner, Effort of_effort, std::string& error) : compilers(owner), effort(of_effort)
{
    const std::lock_guard lock(compilers.mutex);
    auto& idle = compilers.idle[static_cast<size_t>(effort)];
    if (!idle.empty()) {
        machine = std::move(idle.back());
        idle.pop_back();
        return;
    }
    constexpr llvm::CodeGenOptLevel levels[] = {llvm::CodeGenOptLevel::None, llvm::CodeGenOptLevel::Less,
                                                llvm::CodeGenOptLevel::Default};
    compilers.builder->setCodeGenOptLevel(levels[static_cast<size_t>(effort)]);
    if (auto made = compilers.builder->createTargetMachine())
        machine = std::move(*made);
    else
        error = "no code generator for " + compilers.builder->getTargetTriple().str() + " " +
                compilers.builder->getCPU() + ": " + llvm::toString(made.takeError());
}

Compilers::Lease::~Lease()
{
    if (!machine) return;
    const std::lock_guard lock(compilers.mutex);
    compilers.idle[static_cast<size_t>(effort)].push_back(std::move(machine));
}

} // namespace haptel::jit
