// The compiler: a library of its own (haptel_compiler), so that a program without this header needs no LLVM.
#pragma once

#include <haptel/texture.h>

#include <functional>
#include <string>
#include <string_view>

namespace haptel {

struct CompilerOptions {
    // Textures follow their files: what is saved is felt as soon as it is compiled. A file that is broken, half written
    // or gone leaves the old texture in the hand, and `report` hears why, on a thread of the compiler's.
    bool follow_files = false;
    std::function<void(std::string_view)> report = {};
};

// Compiles what objects ask for as "FILE.haptel:NAME". Relative paths start from the working directory, and those of a
// scene file from its folder.
HAPTEL_API TextureSource compiler(CompilerOptions options = {});

} // namespace haptel
