#include "jit/codegen/isa.h"

#include "jit/codegen/llvm.h"

#include <algorithm>
#include <vector>

namespace haptel::jit {

namespace {

struct Isa {
    const char* name;
    llvm::Triple::ArchType architecture; // that it belongs to; UnknownArch: any
    const char* processor;               // as LLVM names it
    std::vector<const char*> features;   // that it takes
};

// From the smallest to the largest.
const std::vector<Isa>& known()
{
    static const std::vector<Isa> sets{
        {"baseline", llvm::Triple::x86_64, "x86-64", {}},
        {"baseline", llvm::Triple::aarch64, "generic", {}},
        {"avx2", llvm::Triple::x86_64, "x86-64-v3", {"avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe"}},
        {"avx512",
         llvm::Triple::x86_64,
         "x86-64-v4",
         {"avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe", "avx512f", "avx512bw", "avx512cd", "avx512dq",
          "avx512vl"}}};
    return sets;
}

template <typename HasFeature>
std::vector<Isa> available(const llvm::Triple& triple, const HasFeature& has)
{
    std::vector<Isa> found;
    for (const Isa& isa : known())
        if (isa.architecture == triple.getArch() && std::all_of(isa.features.begin(), isa.features.end(), has))
            found.push_back(isa);
    return found;
}

} // namespace

std::string restrict_to_isa(llvm::orc::JITTargetMachineBuilder& host, std::string_view name)
{
    if (name.empty() || name == "host") return {};
    const std::vector<std::string>& features = host.getFeatures().getFeatures(); // "+avx2", "-avx512f"
    const std::vector<Isa> here = available(host.getTargetTriple(), [&](const char* feature) {
        return std::find(features.begin(), features.end(), std::string("+") + feature) != features.end();
    });
    for (const Isa& isa : here) {
        if (name != isa.name) continue;
        host.setCPU(isa.processor);
        host.getFeatures() = llvm::SubtargetFeatures();
        return {};
    }
    const bool is_known = std::any_of(known().begin(), known().end(), [&](const Isa& isa) { return name == isa.name; });
    std::string choices;
    for (const Isa& isa : here) choices += isa.name + std::string(", ");
    return "HAPTEL_ISA is '" + std::string(name) +
           (is_known ? "', which this machine has not: " : "', which is no instruction set that Haptel knows: ") +
           "it has " + choices + "host";
}

Processor processor_of(const llvm::TargetMachine& machine)
{
    // Singles of two registers' width, where registers are narrow, hide the latency of one another's operations.
    const llvm::MCSubtargetInfo& has = *machine.getMCSubtargetInfo();
    if (!machine.getTargetTriple().isX86()) return {8, false, false, machine.getTargetTriple().isAArch64()};
    const bool has_avx512 = has.checkFeatures("+avx512f"), has_avx2 = has.checkFeatures("+avx2");
    return {has_avx512 || has_avx2 ? 16u : 8u, has_avx512, has.checkFeatures("+avx512vbmi"), has.checkFeatures("+fma")};
}

std::string isa_of(const llvm::TargetMachine& machine)
{
    const llvm::MCSubtargetInfo& has = *machine.getMCSubtargetInfo();
    const std::vector<Isa> within = available(
        machine.getTargetTriple(), [&](const char* feature) { return has.checkFeatures(std::string("+") + feature); });
    std::string name = within.empty() ? machine.getTargetTriple().getArchName().str() : within.back().name;
    if (machine.getTargetTriple().isX86() && has.checkFeatures("+avx512vbmi")) name += " vbmi";
    return name;
}

} // namespace haptel::jit
