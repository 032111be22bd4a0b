#include "jit/codegen/isa.h"

#include "jit/codegen/llvm.h"

#include <algorithm>
#include <llvm/TargetParser/Host.h>
#include <vector>

namespace haptel::jit {

namespace {

struct Isa {
    const char* name;
    llvm::Triple::ArchType architecture; // that it belongs to
    const char *processor, *features;    // as LLVM names them; those beyond what the architecture has
};

// From the smallest to the largest. LLVM knows that AVX-512F has AVX2, F16C and FMA.
constexpr Isa known[] = {{"baseline", llvm::Triple::x86_64, "x86-64", ""},
                         {"baseline", llvm::Triple::aarch64, "generic", ""},
                         {"avx2", llvm::Triple::x86_64, "x86-64-v3", "+avx2,+bmi,+bmi2,+f16c,+fma,+lzcnt,+movbe"},
                         {"avx512", llvm::Triple::x86_64, "x86-64-v4",
                          "+avx512f,+avx512bw,+avx512cd,+avx512dq,+avx512vl,+bmi,+bmi2,+lzcnt,+movbe"}};

std::vector<Isa> available(const llvm::TargetMachine& machine)
{
    std::vector<Isa> found;
    std::ranges::copy_if(known, std::back_inserter(found), [&](const Isa& isa) {
        return isa.architecture == machine.getTargetTriple().getArch() &&
               machine.getMCSubtargetInfo()->checkFeatures(isa.features);
    });
    return found;
}

// Null, and `error`, where there is none.
const Isa* isa_for_others(std::string_view name, std::string& error)
{
    const llvm::Triple::ArchType host = llvm::Triple(llvm::sys::getProcessTriple()).getArch();
    const auto fits = [&](const Isa& isa) {
        return name == isa.name ? name != "baseline" || isa.architecture == host
                                : name == "aarch64" && isa.architecture == llvm::Triple::aarch64;
    };
    if (const Isa* const found = std::ranges::find_if(known, fits); found != std::end(known)) return found;
    error = "'" + std::string(name) +
            "' is no instruction set that Haptel builds for: expected baseline, avx2, avx512 or aarch64";
    return nullptr;
}

} // namespace

std::string restrict_to_isa(llvm::orc::JITTargetMachineBuilder& host, std::string_view name)
{
    if (name.empty() || name == "host") return {};
    auto machine = host.createTargetMachine();
    if (!machine) return llvm::toString(machine.takeError());
    std::string choices;
    for (const Isa& isa : available(**machine)) {
        choices += isa.name + std::string(", ");
        if (name != isa.name) continue;
        host.setCPU(isa.processor);
        host.getFeatures() = llvm::SubtargetFeatures();
        return {};
    }
    const bool is_known = std::ranges::any_of(known, [&](const Isa& isa) { return name == isa.name; });
    return "HAPTEL_ISA is '" + std::string(name) +
           (is_known ? "', which this machine has not: " : "', which is no instruction set that Haptel knows: ") +
           "it has " + choices + "host";
}

std::optional<std::vector<std::string>> sets_in_order(std::span<const std::string> names, std::string& error)
{
    std::vector<std::pair<const Isa*, std::string>> sets;
    for (const std::string& name : names) {
        const Isa* const isa = isa_for_others(name, error);
        if (!isa) return {};
        for (const auto& [other, of_other] : sets) {
            if (other == isa)
                error = of_other == name ? "'" + name + "' is named twice"
                                         : "'" + of_other + "' and '" + name + "' are the same set here";
            else if (other->architecture != isa->architecture)
                error = "'" + of_other + "' and '" + name +
                        "' are of different architectures, and code of one does not run on the other: build a library "
                        "for each";
            if (!error.empty()) return {};
        }
        sets.emplace_back(isa, name);
    }
    std::ranges::sort(sets);
    std::vector<std::string> in_order;
    for (const auto& [isa, name] : sets) in_order.push_back(name);
    return in_order;
}

std::optional<llvm::orc::JITTargetMachineBuilder> machine_with_isa(std::string_view name, std::string& error)
{
    const Isa* const found = isa_for_others(name, error);
    if (!found) return {};
    const llvm::Triple host(llvm::sys::getProcessTriple());
    llvm::Triple triple = host;
    if (found->architecture != host.getArch())
        triple = llvm::Triple(llvm::Triple::getArchTypeName(found->architecture), "unknown", "linux", "gnu");
    std::string why;
    if (!llvm::TargetRegistry::lookupTarget(triple.str(), why)) {
        error = "this LLVM was built without a code generator for " + triple.str() + ": install one that has all";
        return {};
    }
    llvm::orc::JITTargetMachineBuilder machine(triple);
    machine.setCPU(found->processor);
    return machine;
}

Processor processor_of(const llvm::TargetMachine& machine)
{
    // Singles of two registers' width, where registers are narrow, hide the latency of one another's operations.
    const llvm::MCSubtargetInfo& has = *machine.getMCSubtargetInfo();
    if (!machine.getTargetTriple().isX86()) return {8, false, false, machine.getTargetTriple().isAArch64()};
    return {has.checkFeatures("+avx2") ? 16u : 8u, has.checkFeatures("+avx512f"), has.checkFeatures("+avx512vbmi"),
            has.checkFeatures("+fma")};
}

std::string isa_of(const llvm::TargetMachine& machine)
{
    const std::vector<Isa> within = available(machine);
    std::string name = within.empty() ? machine.getTargetTriple().getArchName().str() : within.back().name;
    if (processor_of(machine).permutes_bytes) name += " vbmi";
    return name;
}

} // namespace haptel::jit
