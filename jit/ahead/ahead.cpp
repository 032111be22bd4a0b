#include "jit/ahead/ahead.h"

#include "jit/ahead/library_code.h"
#include "jit/ahead/texture_table.h"
#include "jit/codegen/isa.h"
#include "jit/engine/machine_code.h"
#include "jit/texture/texture.h"

#include <llvm/Linker/Linker.h>
#include <llvm/Object/ArchiveWriter.h>

namespace haptel::jit {

namespace {

// A library's code on its way, with the machine it is for.
struct Build {
    llvm::LLVMContext context;
    std::unique_ptr<llvm::TargetMachine> machine;
    std::unique_ptr<llvm::Module> code;
    std::string error;

    Build(std::span<const emit_c::LibraryTexture> textures, const AheadOptions& options)
    {
        start_code_generators();
        std::optional<llvm::orc::JITTargetMachineBuilder> target = machine_with_isa(options.isa, error);
        if (!target) return;
        target->setRelocationModel(llvm::Reloc::PIC_);
        target->setCodeGenOptLevel(llvm::CodeGenOptLevel::Default);
        target->getOptions().AllowFPOpFusion = llvm::FPOpFusion::Strict;
        auto made = target->createTargetMachine();
        if (!made) {
            error = "no code generator for " + options.isa + ": " + llvm::toString(made.takeError());
            return;
        }
        machine = std::move(*made);
        code = std::make_unique<llvm::Module>("textures", context);
        code->setPICLevel(llvm::PICLevel::BigPIC);
        const Processor processor = processor_of(*machine);
        for (size_t first = 0, end = 0; first < textures.size(); first = end) {
            while (end < textures.size() && textures[end].module == textures[first].module) ++end;
            add(textures.subspan(first, end - first), processor, options);
        }
        write_library(*code);
    }

private:
    static void start_code_generators()
    {
        static const bool once = [] {
            llvm::InitializeAllTargetInfos();
            llvm::InitializeAllTargets();
            llvm::InitializeAllTargetMCs();
            llvm::InitializeAllAsmPrinters();
            return true;
        }();
        static_cast<void>(once);
    }

    // Those of one module.
    void add(std::span<const emit_c::LibraryTexture> textures, const Processor& processor, const AheadOptions& options)
    {
        const ir::Module& module = *textures[0].module;
        const std::vector<EntryPoint> entries =
            entry_points(module, {.entries = Entries::both_and_batches, .precision = options.precision});
        std::unique_ptr<llvm::Module> part = generate(module, entries, processor, context);
        for (const EntryPoint& entry : entries)
            part->getFunction(symbol_of(entry))->setLinkage(llvm::GlobalValue::InternalLinkage);
        for (const emit_c::LibraryTexture& texture : textures) write_table(*part, texture, entries);
        if (llvm::Linker::linkModules(*code, std::move(part))) error = "the textures' code could not be put together";
    }
};

AheadResult build_code(std::span<const emit_c::LibraryTexture> textures, const AheadOptions& options,
                       llvm::CodeGenFileType type)
{
    Build build(textures, options);
    if (!build.error.empty()) return {{}, std::move(build.error)};
    CompileTimes unused;
    Object object = make_object(*build.code, *build.machine, Effort::full, unused, type);
    return {std::move(object.bytes), std::move(object.error)};
}

} // namespace

AheadResult build_object(std::span<const emit_c::LibraryTexture> textures, const AheadOptions& options)
{
    return build_code(textures, options, llvm::CodeGenFileType::ObjectFile);
}

AheadResult build_assembler_text(std::span<const emit_c::LibraryTexture> textures, const AheadOptions& options)
{
    return build_code(textures, options, llvm::CodeGenFileType::AssemblyFile);
}

AheadResult build_llvm_text(std::span<const emit_c::LibraryTexture> textures, const AheadOptions& options)
{
    Build build(textures, options);
    if (!build.error.empty()) return {{}, std::move(build.error)};
    CompileTimes unused;
    if (Object object = make_object(*build.code, *build.machine, Effort::full, unused); !object.error.empty())
        return {{}, std::move(object.error)};
    AheadResult result;
    llvm::raw_string_ostream(result.bytes) << *build.code;
    return result;
}

AheadResult archive_of(const std::string& object, const std::string& name)
{
    const llvm::NewArchiveMember member(llvm::MemoryBufferRef(object, name));
    auto archive = llvm::writeArchiveToBuffer(member, llvm::SymtabWritingMode::NormalSymtab,
                                              llvm::object::Archive::K_GNU, true, false);
    if (!archive) return {{}, "no archive could be made: " + llvm::toString(archive.takeError())};
    return {(*archive)->getBuffer().str(), {}};
}

} // namespace haptel::jit
