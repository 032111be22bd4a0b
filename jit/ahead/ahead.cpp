#include "jit/ahead/ahead.h"

#include "jit/ahead/choose_set.h"
#include "jit/ahead/library_code.h"
#include "jit/ahead/texture_table.h"
#include "jit/codegen/isa.h"
#include "jit/engine/machine_code.h"
#include "jit/texture/texture.h"

#include <llvm/Linker/Linker.h>
#include <llvm/Object/ArchiveWriter.h>

namespace haptel::jit {

namespace {

void start_code_generators()
{
    static const bool once = [] {
        llvm::InitializeAllTargetInfos();
        llvm::InitializeAllTargets();
        llvm::InitializeAllTargetMCs();
        llvm::InitializeAllAsmPrinters();
        llvm::InitializeAllAsmParsers(); // of what asks the processor
        return true;
    }();
    static_cast<void>(once);
}

std::unique_ptr<llvm::TargetMachine> machine_of(const std::string& isa, std::string& error)
{
    std::optional<llvm::orc::JITTargetMachineBuilder> target = machine_with_isa(isa, error);
    if (!target) return nullptr;
    target->setRelocationModel(llvm::Reloc::PIC_);
    target->setCodeModel(llvm::CodeModel::Small); // code in place is made for any distance, which -static cannot link
    target->setCodeGenOptLevel(llvm::CodeGenOptLevel::Default);
    target->getOptions().AllowFPOpFusion = llvm::FPOpFusion::Strict;
    target->getOptions().UseInitArray = true;
    auto made = target->createTargetMachine();
    if (made) return std::move(*made);
    error = "no code generator for " + isa + ": " + llvm::toString(made.takeError());
    return nullptr;
}

// A library's code on its way, with the machine that its least set is for.
struct Build {
    llvm::LLVMContext context;
    std::unique_ptr<llvm::TargetMachine> machine;
    std::unique_ptr<llvm::Module> code;
    std::string error;

    Build(std::span<const emit_c::LibraryTexture> all, const AheadOptions& given) : textures(all), options(given)
    {
        start_code_generators();
        const std::optional<std::vector<std::string>> isas = sets_in_order(options.isas, error);
        if (!isas) return;
        code = std::make_unique<llvm::Module>("textures", context);
        code->setPICLevel(llvm::PICLevel::BigPIC);
        for (const std::string& isa : *isas) {
            std::unique_ptr<llvm::TargetMachine> of_set = machine_of(isa, error);
            if (!of_set) return;
            add_set(isa, *of_set, isas->size() > 1);
            if (!machine) machine = std::move(of_set);
        }
        for (llvm::Function& function : *code)
            if (!function.isDeclaration()) function.setLinkage(llvm::GlobalValue::InternalLinkage);
        if (isas->size() > 1) choose();
    }

private:
    std::span<const emit_c::LibraryTexture> textures;
    const AheadOptions& options;
    // By set and texture: what the entries are called in `code`, whose functions a linker moves.
    struct NamedSet {
        std::string isa;
        std::vector<std::array<std::string, 4>> entries;
    };
    std::vector<NamedSet> sets;

    // Every function of a set among several says for which processor it is: one module holds them all.
    void add_set(const std::string& isa, const llvm::TargetMachine& of_set, bool is_one_of_several)
    {
        auto set = std::make_unique<llvm::Module>("set", context);
        const bool is_least = sets.empty();
        sets.push_back({isa, {}});
        const Processor processor = processor_of(of_set);
        for (size_t first = 0, end = 0; first < textures.size(); first = end) {
            while (end < textures.size() && textures[end].module == textures[first].module) ++end;
            const ir::Module& module = *textures[first].module;
            const std::vector<EntryPoint> entries =
                entry_points(module, {.entries = Entries::both_and_batches, .precision = options.precision});
            std::unique_ptr<llvm::Module> part = generate(module, entries, processor, context);
            for (size_t i = first; i < end; ++i) {
                const TableEntries of_texture = table_entries(*part, *textures[i].texture, entries);
                if (is_least) write_table(*part, textures[i], of_texture, is_one_of_several);
                sets.back().entries.emplace_back();
                for (size_t k = 0; k < of_texture.size(); ++k)
                    if (llvm::Function* const entry = of_texture[k]) {
                        if (is_one_of_several) entry->setName(entry->getName() + "." + isa);
                        sets.back().entries.back()[k] = entry->getName().str();
                    }
            }
            link(*set, std::move(part));
        }
        write_library(*set);
        if (is_one_of_several)
            for (llvm::Function& function : *set)
                if (!function.isDeclaration()) function.addFnAttr("target-cpu", of_set.getTargetCPU());
        link(*code, std::move(set));
    }

    void link(llvm::Module& to, std::unique_ptr<llvm::Module> part)
    {
        if (llvm::Linker::linkModules(to, std::move(part))) error = "the textures' code could not be put together";
    }

    void choose()
    {
        std::vector<llvm::GlobalVariable*> tables;
        for (const emit_c::LibraryTexture& texture : textures)
            tables.push_back(code->getGlobalVariable(emit_c::texture_symbol(*texture.texture)));
        std::vector<SetOfEntries> larger;
        for (size_t s = 1; s < sets.size(); ++s) {
            larger.push_back({sets[s].isa, std::vector<TableEntries>(textures.size())});
            for (size_t i = 0; i < textures.size(); ++i)
                for (size_t k = 0; k < sets[s].entries[i].size(); ++k)
                    if (const std::string& name = sets[s].entries[i][k]; !name.empty())
                        larger.back().entries[i][k] = code->getFunction(name);
        }
        choose_at_load(*code, tables, larger);
    }
};

AheadResult build_code(std::span<const emit_c::LibraryTexture> textures, const AheadOptions& options,
                       llvm::CodeGenFileType type)
{
    Build build(textures, options);
    if (!build.error.empty()) return {{}, std::move(build.error)};
    Object object = make_object(*build.code, *build.machine, Effort::full, type);
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
    if (Object object = make_object(*build.code, *build.machine, Effort::full); !object.error.empty())
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
