// The instruction set that code is made for: all that the host has, or less where HAPTEL_ISA says so.
//
//   host      every feature of this processor; what an empty or absent HAPTEL_ISA means
//   baseline  what every processor of this architecture has (x86-64: SSE2)
//   avx2      x86-64-v3: AVX2 and FMA, gathers
//   avx512    x86-64-v4: AVX-512 F, BW, CD, DQ, VL, without the byte permutes that came later
//
// A program gives the same bits under each of them in f64; how fast differs.
#pragma once

#include "jit/codegen/codegen.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace llvm {
class TargetMachine;
namespace orc {
class JITTargetMachineBuilder;
}
} // namespace llvm

namespace haptel::jit {

// Leaves to `host`, which describes this processor, only what the named set has. Empty, or why not and what there is.
std::string restrict_to_isa(llvm::orc::JITTargetMachineBuilder& host, std::string_view name);

// A machine that has the named set and nothing beyond it, for programs that run elsewhere: one of the sets above, or
// aarch64, the least of that architecture. Nothing, and `error` says why and what there is.
std::optional<llvm::orc::JITTargetMachineBuilder> machine_with_isa(std::string_view name, std::string& error);

// The sets of one library, from the least to the largest. Nothing, and `error`, where one is unknown or named twice, or
// they belong to different architectures.
std::optional<std::vector<std::string>> sets_in_order(std::span<const std::string> names, std::string& error);

// What generated code may use and should be like on such a machine.
Processor processor_of(const llvm::TargetMachine& machine);

// The largest set above that the machine's code may use, and what it has beyond: "avx512 vbmi".
std::string isa_of(const llvm::TargetMachine& machine);

} // namespace haptel::jit
