#include "jit/engine/llvm_library.h"

#include <llvm-c/Core.h>

#include <cstring>
#include <dlfcn.h>
#include <elf.h>
#include <link.h>
#include <string_view>
#include <sys/stat.h>

namespace haptel::jit {

namespace {

const void* code_of_llvm()
{
    return reinterpret_cast<const void*>(&LLVMGetVersion);
}

struct Wanted {
    uintptr_t address;
    std::string build_id;
};

// In the notes of one segment: name size, content size and kind, then name and content, each padded to four bytes.
std::string build_id_in(const char* notes, size_t size)
{
    const auto padded = [](size_t count) { return (count + 3) / 4 * 4; };
    while (size >= sizeof(ElfW(Nhdr))) {
        ElfW(Nhdr) head;
        std::memcpy(&head, notes, sizeof head);
        const size_t content = sizeof head + padded(head.n_namesz), end = content + padded(head.n_descsz);
        if (end > size) break;
        if (head.n_type == NT_GNU_BUILD_ID && std::string_view(notes + sizeof head, 3) == "GNU") {
            std::string id;
            for (size_t i = 0; i < head.n_descsz; ++i) {
                const auto byte = static_cast<unsigned char>(notes[content + i]);
                (id += "0123456789abcdef"[byte >> 4]) += "0123456789abcdef"[byte & 15];
            }
            return id;
        }
        notes += end;
        size -= end;
    }
    return {};
}

int look_at(dl_phdr_info* file, size_t, void* data)
{
    Wanted& wanted = *static_cast<Wanted*>(data);
    bool is_inside = false;
    for (size_t i = 0; i < file->dlpi_phnum; ++i) {
        const ElfW(Phdr)& segment = file->dlpi_phdr[i];
        const uintptr_t begin = file->dlpi_addr + segment.p_vaddr;
        is_inside |= segment.p_type == PT_LOAD && wanted.address - begin < segment.p_memsz;
    }
    if (!is_inside) return 0;
    for (size_t i = 0; i < file->dlpi_phnum && wanted.build_id.empty(); ++i) {
        const ElfW(Phdr)& segment = file->dlpi_phdr[i];
        if (segment.p_type == PT_NOTE)
            wanted.build_id =
                build_id_in(reinterpret_cast<const char*>(file->dlpi_addr + segment.p_vaddr), segment.p_memsz);
    }
    return 1;
}

} // namespace

std::string build_id_of(const void* address)
{
    Wanted wanted{reinterpret_cast<uintptr_t>(address), {}};
    dl_iterate_phdr(look_at, &wanted);
    return wanted.build_id;
}

std::string llvm_version()
{
    unsigned major = 0, minor = 0, patch = 0;
    LLVMGetVersion(&major, &minor, &patch);
    return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
}

std::string llvm_identity()
{
    if (const std::string id = build_id_of(code_of_llvm()); !id.empty()) return llvm_version() + " " + id;
    Dl_info file{};
    struct stat status{};
    if (dladdr(code_of_llvm(), &file) == 0 || stat(file.dli_fname, &status) != 0) return llvm_version();
    return llvm_version() + " " + file.dli_fname + " " + std::to_string(status.st_size) + " " +
           std::to_string(status.st_mtim.tv_sec) + "." + std::to_string(status.st_mtim.tv_nsec);
}

} // namespace haptel::jit
