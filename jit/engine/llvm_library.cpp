#include "jit/engine/llvm_library.h"

#include <llvm-c/Core.h>
#include <llvm/ADT/StringExtras.h>

#include <algorithm>
#include <cstring>
#include <dlfcn.h>
#include <elf.h>
#include <link.h>
#include <span>
#include <string_view>
#include <sys/stat.h>

namespace haptel::jit {

namespace {

const void* code_of_llvm()
{
    return reinterpret_cast<const void*>(&LLVMGetVersion);
}

// In the notes of one segment: name size, content size and kind, then name and content, each padded to four bytes.
std::string build_id_in(std::string_view notes)
{
    const auto padded = [](size_t count) { return (count + 3) / 4 * 4; };
    ElfW(Nhdr) head;
    while (notes.size() >= sizeof head) {
        std::memcpy(&head, notes.data(), sizeof head);
        const size_t content = sizeof head + padded(head.n_namesz), end = content + padded(head.n_descsz);
        if (end > notes.size()) break;
        if (head.n_type == NT_GNU_BUILD_ID && notes.substr(sizeof head, 3) == "GNU")
            return llvm::toHex(notes.substr(content, head.n_descsz), true);
        notes.remove_prefix(end);
    }
    return {};
}

} // namespace

std::string build_id_of(const void* address)
{
    struct Search {
        uintptr_t wanted;
        std::string build_id;
    } search{reinterpret_cast<uintptr_t>(address), {}};
    const auto look_at = [](dl_phdr_info* file, size_t, void* data) {
        auto& here = *static_cast<Search*>(data);
        const std::span segments(file->dlpi_phdr, file->dlpi_phnum);
        if (std::none_of(segments.begin(), segments.end(), [&](const ElfW(Phdr) & segment) {
                return segment.p_type == PT_LOAD && here.wanted - (file->dlpi_addr + segment.p_vaddr) < segment.p_memsz;
            }))
            return 0;
        for (const ElfW(Phdr) & segment : segments)
            if (segment.p_type == PT_NOTE && here.build_id.empty())
                here.build_id =
                    build_id_in({reinterpret_cast<const char*>(file->dlpi_addr + segment.p_vaddr), segment.p_memsz});
        return 1;
    };
    dl_iterate_phdr(look_at, &search);
    return search.build_id;
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
