// Textures that leave the house together, and what programs in C call them.
#pragma once

#include "lang/abi/abi.h"
#include "lang/ir/ir.h"

#include <string>

namespace haptel::emit_c {

// In a list those of one module stand together.
struct LibraryTexture {
    const ir::Module* module;
    const ir::Texture* texture; // of the module
    haptel_facts facts;         // over the parameters' ranges
    std::string file;           // where its text stands
};

// Of a texture: its table, the type of its block, and a block with the defaults.
inline std::string texture_symbol(const ir::Texture& texture)
{
    return "haptel_texture_" + texture.name;
}
inline std::string block_type(const ir::Texture& texture)
{
    return "haptel_block_" + texture.name;
}
inline std::string defaults_symbol(const ir::Texture& texture)
{
    return "haptel_defaults_" + texture.name;
}

} // namespace haptel::emit_c
