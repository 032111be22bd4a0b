// Code for other processors: the object file is read by what its format says, not by LLVM.
#include "jit/ahead/ahead.h"
#include "tests/jit/codegen/samples.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <cstring>
#include <elf.h>
#include <set>

using namespace haptel;

namespace {

struct Symbols {
    std::set<std::string> defined, undefined;
};

template <typename T>
T read(const std::string& from, size_t offset)
{
    T read{};
    REQUIRE(offset + sizeof read <= from.size());
    std::memcpy(&read, from.data() + offset, sizeof read);
    return read;
}

Symbols symbols_of(const std::string& object)
{
    Symbols symbols;
    const auto head = read<Elf64_Ehdr>(object, 0);
    const auto section = [&](size_t i) { return read<Elf64_Shdr>(object, head.e_shoff + i * sizeof(Elf64_Shdr)); };
    for (size_t i = 0; i < head.e_shnum; ++i) {
        if (section(i).sh_type != SHT_SYMTAB) continue;
        const Elf64_Shdr names = section(section(i).sh_link);
        for (size_t at = 0; at < section(i).sh_size; at += sizeof(Elf64_Sym)) {
            const auto symbol = read<Elf64_Sym>(object, section(i).sh_offset + at);
            const std::string name = object.c_str() + names.sh_offset + symbol.st_name;
            if (ELF64_ST_BIND(symbol.st_info) != STB_GLOBAL) continue;
            (symbol.st_shndx == SHN_UNDEF ? symbols.undefined : symbols.defined).insert(name);
        }
    }
    return symbols;
}

} // namespace

TEST_CASE("an object for any processor and precision shows a texture's table and defaults, and asks for libm alone")
{
    const auto program = test::compiled("texture t(float depth = 1mm in 0mm .. 2mm, image picture) {"
                                        "  return depth * (fbm(p / 10mm, 8) + noise(p / 1mm) + fourier(p.xy / 1mm, 7)"
                                        "                  + sin(atan(p.x / 1m)) + sample_rgba(picture, p.xy / 1m).y);"
                                        "}");
    const ir::Texture& texture = program->module().textures[0];
    const emit_c::LibraryTexture library[] = {{&program->module(), &texture, {}, "t.haptel"}};
    const std::set<std::string> known{"floor",
                                      "ceil",
                                      "trunc",
                                      "roundeven",
                                      "fma",
                                      "floorf",
                                      "ceilf",
                                      "truncf",
                                      "roundevenf",
                                      "fmaf",
                                      "memcpy",
                                      "memset",
                                      "_GLOBAL_OFFSET_TABLE_"};
    const std::vector<std::vector<std::string>> lists{
        {"baseline"}, {"avx2"}, {"avx512"}, {"aarch64"}, {"avx2", "avx512"}};
    for (const std::vector<std::string>& isas : lists)
        for (const auto precision : {jit::Precision::f64, jit::Precision::mixed, jit::Precision::f32}) {
            // Several are the code of each, and a way to choose; and sanitized LLVM's allocations take long.
            if ((isas.size() > 1 || test::is_sanitized) && precision != jit::Precision::mixed) continue;
            const jit::AheadResult made = jit::build_object(library, {isas, precision});
            INFO(isas.back() << ": " << made.error);
            if (test::contains(made.error, "without a code generator")) continue; // that LLVM has none
            REQUIRE(made.error.empty());
            const auto head = read<Elf64_Ehdr>(made.bytes, 0);
            REQUIRE(std::memcmp(head.e_ident, ELFMAG, SELFMAG) == 0);
            CHECK(head.e_type == ET_REL);
            CHECK((head.e_machine == EM_AARCH64) == (isas[0] == "aarch64" || jit::engine_info().isa == "aarch64"));
            const Symbols symbols = symbols_of(made.bytes);
            CHECK(symbols.defined == std::set<std::string>{"haptel_defaults_t", "haptel_texture_t"});
            for (const std::string& name : symbols.undefined) {
                INFO(name);
                CHECK(known.contains(name));
            }
        }
}

TEST_CASE("what does not fit the registers of AVX-512 goes to a stack that is aligned to them")
{
    const auto program = test::compiled("texture t() { return 1mm * noise(p / 1mm); }");
    const emit_c::LibraryTexture library[] = {{&program->module(), &program->module().textures[0], {}, "t.haptel"}};
    const jit::AheadResult made = jit::build_object(library, {{"avx512"}, jit::Precision::mixed});
    INFO(made.error);
    REQUIRE(made.error.empty());
    CHECK(made.bytes.find("\x48\x83\xe4\xc0") != std::string::npos); // and rsp, -64
}
