// Which LLVM this process runs with. Its headers say what it was compiled against; a system update puts another library
// in that one's place, and what this one makes must not be taken for what the other has made.
#pragma once

#include <string>

namespace haptel::jit {

// "19.1.7"
std::string llvm_version();

// Version and build id of the file that holds LLVM's code; where it has no build id, its path, size and time of change.
std::string llvm_identity();

// The build id of the file whose code is at `address` in this process, in hexadecimal; empty: it has none.
std::string build_id_of(const void* address);

} // namespace haptel::jit
