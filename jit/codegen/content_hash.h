// What a function of the IR does, whatever it is called and wherever it stands: equal functions of any two programs
// have equal hashes. Covers all that can change a bit of its code: its own text, what it calls, the tables it reads,
// its facts; not names and places in the source.
#pragma once

#include "lang/ir/ir.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::jit {

// Of BLAKE3: nobody finds two texts of one hash.
using ContentHash = std::array<uint8_t, 16>;

ContentHash content_hash(std::string_view bytes);
std::string to_text(const ContentHash& hash); // 32 hexadecimal digits

// By index of ir::Module::functions.
std::vector<ContentHash> function_hashes(const ir::Module& module);

} // namespace haptel::jit
