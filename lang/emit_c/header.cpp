#include "lang/emit_c/header.h"

#include "lang/abi/outputs.h"
#include "lang/emit_c/words.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace haptel::emit_c {

extern const char abi_text[]; // lang/abi/abi.h, whole

namespace {

std::string shown(double value)
{
    char digits[32];
    return {digits, std::to_chars(digits, std::end(digits), value).ptr};
}

std::string type_of(const ir::Parameter& parameter)
{
    switch (parameter.type) {
    case ir::Type::real: return "double ";
    case ir::Type::i32:
    case ir::Type::boolean: return "int32_t ";
    case ir::Type::u32: return "uint32_t ";
    case ir::Type::image: return "const haptel_image* ";
    }
    return {};
}

std::string remark_of(const ir::Parameter& parameter)
{
    std::string remark = "at " + std::to_string(parameter.offset);
    const auto add = [&](const std::string& what) { remark += ", " + what; };
    if (!parameter.unit.empty()) add(parameter.unit);
    if (parameter.type == ir::Type::boolean) add("0 or 1");
    if (parameter.type == ir::Type::image) return remark + ", null: flat";
    if (!parameter.choices.empty())
        for (size_t i = 0; i < parameter.choices.size(); ++i) add(std::to_string(i) + ": " + parameter.choices[i]);
    else if (std::isfinite(parameter.minimum) && parameter.type != ir::Type::boolean)
        add(shown(parameter.minimum) + " .. " + shown(parameter.maximum));
    add("default " + shown(parameter.value));
    if (!parameter.doc.empty()) remark += ". " + parameter.doc;
    return remark;
}

std::string block_of(const ir::Texture& texture)
{
    std::string text =
        "typedef struct {\n    haptel_block_head head; /* the object's box, and the smallest wavelength */\n";
    for (const ir::Parameter& parameter : texture.parameters)
        text += "    " + type_of(parameter) + member_name(texture, parameter) + "; /* " +
                in_comment(remark_of(parameter), "       ") + " */\n";
    return text + "} " + block_type(texture) + ";\n";
}

std::string section_of(const LibraryTexture& of)
{
    const ir::Texture& texture = *of.texture;
    std::string text = "\n/* " + in_comment(texture.name + ", of " + of.file, " * ") + "\n";
    if (!texture.doc.empty()) text += " * " + in_comment(texture.doc, " * ") + "\n";
    text += " * Height and gradient take " + std::to_string(of.facts.operations_max) + " operations at most.\n */\n";
    return text + block_of(texture) + "extern const " + block_type(texture) + " " + defaults_symbol(texture) +
           ";\nextern const haptel_texture " + texture_symbol(texture) + ";\n";
}

} // namespace

std::string header(std::string_view name, std::span<const LibraryTexture> textures)
{
    std::string guard = "HAPTEL_TEXTURES_";
    for (const char c : name)
        guard += c >= 'a' && c <= 'z'                               ? static_cast<char>(c - 'a' + 'A')
                 : (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c
                                                                    : '_';
    std::string text =
        "/* " + in_comment(name, " * ") +
        ": textures compiled by Haptel, for programs in C99 and C++. Made by `haptel build`: do not edit.\n"
        " *\n"
        " * Copy a texture's defaults, change what you like, set the head to the object's box, and call an entry:\n"
        " *\n"
        " *     haptel_block_NAME block = haptel_defaults_NAME;\n"
        " *     haptel_texture_NAME.height_gradient(&point, &block, &sample);\n"
        " *\n"
        " * Any thread may call; nothing is allocated. haptel_texture.parameters describes the block for programs that "
        "find\n"
        " * out at run time. A program works with a texture whose `abi` is its own HAPTEL_ABI_VERSION, and looks at\n"
        " * `size` before it reads a member that a later version has appended.\n"
        " */\n#ifndef " +
        guard + "\n#define " + guard + "\n\n" + abi_text + "\n#ifdef __cplusplus\nextern \"C\" {\n#endif\n";
    for (const LibraryTexture& texture : textures) text += section_of(texture);
    return text + "\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n";
}

} // namespace haptel::emit_c
