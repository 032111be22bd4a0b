// Which LLVM runs: read from memory, against what its file says.
#include "jit/engine/engine.h"
#include "jit/engine/llvm_library.h"
#include "tests/support/catch.h"

#include <elf.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

using namespace haptel;

namespace {

// The file that this process has mapped of that name, by the kernel's list.
std::string mapped_file(const std::string& part)
{
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);)
        if (line.find(part) != std::string::npos && line.find('/') != std::string::npos)
            return line.substr(line.find('/'));
    return {};
}

// By the file's sections; the process reads it by segments.
std::string build_id_in_file(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const auto read = [&](size_t at, auto made) {
        REQUIRE(at + sizeof made <= bytes.size());
        std::memcpy(&made, bytes.data() + at, sizeof made);
        return made;
    };
    const auto head = read(0, Elf64_Ehdr{});
    for (size_t i = 0; i < head.e_shnum; ++i) {
        const auto section = read(head.e_shoff + i * sizeof(Elf64_Shdr), Elf64_Shdr{});
        if (section.sh_type != SHT_NOTE) continue;
        const auto note = read(section.sh_offset, Elf64_Nhdr{});
        if (note.n_type != NT_GNU_BUILD_ID) continue;
        std::string id;
        for (size_t byte = 0; byte < note.n_descsz; ++byte) {
            const auto value = read(section.sh_offset + sizeof note + 4 + byte, uint8_t{});
            (id += "0123456789abcdef"[value >> 4]) += "0123456789abcdef"[value & 15];
        }
        return id;
    }
    return {};
}

} // namespace

TEST_CASE("code on disk is known by the LLVM library that runs, not by the headers that it was compiled with")
{
    const std::string file = mapped_file("libLLVM");
    if (file.empty()) return; // linked in: the process is the library
    const std::string id = build_id_in_file(file);
    CHECK(jit::llvm_identity().find(jit::llvm_version() + " ") == 0);
    if (!id.empty()) CHECK(jit::llvm_identity() == jit::llvm_version() + " " + id);
    CHECK(jit::engine_info().identity.find(jit::llvm_identity()) != std::string::npos);
    CHECK(jit::engine_info().name.find("LLVM " + jit::llvm_version() + " ") == 0);
}

TEST_CASE("what is no code has no build id")
{
    const int on_the_stack = 0;
    CHECK(jit::build_id_of(&on_the_stack).empty());
}
