// Code for another processor: the object file is read by what its format says, not by LLVM.
#include "tests/jit/codegen/samples.h"
#include "tests/jit/engine/object.h"

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

TEST_CASE("a library texture becomes an object for AArch64 that asks for nothing but the code's library")
{
    const auto program = test::compiled("texture t(float depth = 1mm in 0mm .. 2mm) {"
                                        "  return depth * (fbm(p / 10mm, 8) + noise(p / 1mm) + fourier(p.xy / 1mm, 7)"
                                        "                  + sin(atan(p.x / 1m)));"
                                        "}");
    std::vector<jit::EntryPoint> entries;
    const ir::Texture& texture = program->module().textures[0];
    for (const auto precision : {jit::Precision::f64, jit::Precision::mixed, jit::Precision::f32})
        for (const auto lanes : {jit::LaneForm::one, jit::LaneForm::iterations, jit::LaneForm::points})
            entries.push_back({"t" + std::to_string(entries.size()), &texture, jit::EntryPoint::Kind::height_gradient,
                               lanes, precision});
    const jit::ObjectResult made = jit::compile_object(program->module(), entries, "aarch64-linux-gnu", "generic");
    INFO(made.error);
    REQUIRE(made.error.empty());
    const auto head = read<Elf64_Ehdr>(made.object, 0);
    REQUIRE(std::memcmp(head.e_ident, ELFMAG, SELFMAG) == 0);
    CHECK(head.e_machine == EM_AARCH64);
    const Symbols symbols = symbols_of(made.object);
    std::set<std::string> wanted;
    for (const jit::EntryPoint& entry : entries) wanted.insert(jit::symbol_of(entry));
    CHECK(symbols.defined == wanted);
    const auto library = jit::code_library();
    for (const std::string& name : symbols.undefined) {
        INFO(name);
        CHECK(std::any_of(library.begin(), library.end(), [&](const auto& one) { return one.name == name; }));
    }
    CHECK_FALSE(jit::compile_object(program->module(), entries, "nowhere-linux", "generic").error.empty());
}

TEST_CASE("what does not fit the registers of AVX-512 goes to a stack that is aligned to them")
{
    const auto program = test::compiled("texture t() { return 1mm * noise(p / 1mm); }");
    const std::vector<jit::EntryPoint> entries{{"t", &program->module().textures[0],
                                                jit::EntryPoint::Kind::height_gradient, jit::LaneForm::points,
                                                jit::Precision::mixed}};
    const jit::ObjectResult made = jit::compile_object(program->module(), entries, "x86_64-linux-gnu", "x86-64-v4");
    INFO(made.error);
    REQUIRE(made.error.empty());
    CHECK(made.object.find("\x48\x83\xe4\xc0") != std::string::npos); // and rsp, -64
}
