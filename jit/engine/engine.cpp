#include "jit/engine/engine.h"

#include "jit/codegen/isa.h"
#include "jit/codegen/kernels.h"
#include "jit/codegen/llvm.h"
#include "jit/engine/linker.h"
#include "jit/engine/llvm_library.h"
#include "jit/engine/machine_code.h"
#include "jit/engine/shared_code.h"

#include <atomic>
#include <chrono>
#include <cstdlib>

namespace haptel::jit {

// Which code generator this is: a hash of its sources, made when it is built.
extern const char code_version[];

namespace {

// A program that is made in less time than that is not worth a file, unless it is of full effort: that is what the next
// process begins with. Kernels always are: textures share them.
constexpr std::chrono::milliseconds worth_keeping{10};
// More makes no kernel faster that was measured, and takes twice as long.
constexpr Effort kernel_effort_max = Effort::quick;

// What is made once per process and never taken down: code may outlive every static object.
struct Engine {
    Engine() : fault(start()) {}
    std::string start();
    CodeResult compile(const ir::Module& module, std::span<const EntryPoint> entries, const CodeOptions& options);
    CodeResult link(const Object& object, std::span<const EntryPoint> entries, Fetch& callees);
    std::string identity_of(const KernelCalls& calls, std::span<const EntryPoint> entries) const;

    EngineInfo info;
    Processor processor;
    Compilers compilers;
    Linker linker;
    SharedCode shared{compilers, linker, info.identity};
    std::atomic<size_t> programs{0};
    const std::string fault; // why there is no engine; empty: there is
};

Engine& engine()
{
    static auto* const made = new Engine;
    return *made;
}

std::string Engine::start()
{
    if (llvm::InitializeNativeTarget() || llvm::InitializeNativeTargetAsmPrinter())
        return "LLVM has no code generator for this processor";
    auto host = llvm::orc::JITTargetMachineBuilder::detectHost();
    if (!host) return "the processor was not recognised: " + llvm::toString(host.takeError());
    const char* const wanted = std::getenv("HAPTEL_ISA");
    if (std::string error = restrict_to_isa(*host, wanted ? wanted : ""); !error.empty()) return error;
    host->getOptions().AllowFPOpFusion = llvm::FPOpFusion::Strict;
    info.name = "LLVM " + llvm_version() + " " + host->getTargetTriple().str() + " " + host->getCPU();

    std::string linker_error;
    const std::string error = compilers.start(*host, [&](llvm::TargetMachine& machine) {
        processor = processor_of(machine);
        info.batch_lanes = processor.lanes;
        info.isa = isa_of(machine);
        info.identity = std::string(code_version) + ";" + llvm_identity() + ";" + info.name + ";" +
                        machine.getTargetFeatureString().str() + ";" + std::to_string(processor.lanes);
        linker_error = linker.start(*host, machine.createDataLayout());
    });
    return error.empty() ? linker_error : error;
}

// The symbol of an entry's slot, which holds the address of its code.
std::string slot_of(const EntryPoint& entry)
{
    return "slot of " + symbol_of(entry);
}

// Entries that can be given other code while they are in use: each jumps to where its slot points. Whoever calls it
// holds the same pointer before and after, and gets the same bits if the code is of the same program.
void make_replaceable(llvm::Module& module, std::span<const EntryPoint> entries)
{
    for (const EntryPoint& entry : entries) {
        llvm::Function* const body = module.getFunction(symbol_of(entry));
        body->setName("body of " + symbol_of(entry));
        body->setLinkage(llvm::GlobalValue::InternalLinkage);
        llvm::Type* const pointer = llvm::PointerType::getUnqual(module.getContext());
        auto* slot =
            new llvm::GlobalVariable(module, pointer, false, llvm::GlobalValue::ExternalLinkage, body, slot_of(entry));
        slot->setAlignment(llvm::Align(alignof(void*)));

        llvm::Function* const jump = llvm::Function::Create(body->getFunctionType(), llvm::GlobalValue::ExternalLinkage,
                                                            symbol_of(entry), module);
        jump->setDoesNotThrow();
        llvm::IRBuilder<> builder(llvm::BasicBlock::Create(module.getContext(), "", jump));
        llvm::LoadInst* code = builder.CreateLoad(pointer, slot);
        code->setAlignment(llvm::Align(alignof(void*)));
        code->setAtomic(llvm::AtomicOrdering::Acquire);
        std::vector<llvm::Value*> arguments;
        for (llvm::Argument& argument : jump->args()) arguments.push_back(&argument);
        builder.CreateCall(body->getFunctionType(), code, arguments)->setTailCallKind(llvm::CallInst::TCK_MustTail);
        builder.CreateRetVoid();
    }
}

// Equal for programs of equal code: what their entries do, under which names, and where they find the parameters.
std::string Engine::identity_of(const KernelCalls& calls, std::span<const EntryPoint> entries) const
{
    std::string text = info.identity;
    const auto add = [&](std::string_view word) { text.append(std::to_string(word.size())).append(" ").append(word); };
    for (const EntryPoint& entry : entries) {
        const bool is_height = entry.kind == EntryPoint::Kind::height;
        add(entry.name);
        add(to_text(calls.hash_of(function_of(entry))));
        for (uint32_t number :
             {uint32_t{is_height}, static_cast<uint32_t>(entry.lanes), static_cast<uint32_t>(entry.precision),
              entry.texture->writes, static_cast<uint32_t>(entry.texture->parameters.size())})
            add(std::to_string(number));
        for (const ir::Parameter& parameter : entry.texture->parameters) {
            add(std::to_string(static_cast<uint32_t>(parameter.type)));
            add(std::to_string(parameter.offset));
        }
    }
    return text;
}

// With what the object calls.
CodeResult Engine::link(const Object& object, std::span<const EntryPoint> entries, Fetch& callees)
{
    Addresses callee_addresses, entry_addresses;
    if (std::string error = callees.finish(callee_addresses); !error.empty()) return {nullptr, error};

    const bool is_replaceable = object.effort != Effort::full;
    for (const EntryPoint& entry : entries) {
        entry_addresses[symbol_of(entry)];
        if (is_replaceable) entry_addresses[slot_of(entry)];
    }
    const Linker::Linked linked = linker.link(object.bytes, callee_addresses, entry_addresses);
    if (!linked.place) return {nullptr, linked.error};
    ++programs;
    const std::shared_ptr<void> memory(linked.place, [this](llvm::orc::JITDylib* place) {
        linker.remove(*place);
        --programs;
    });
    std::map<std::string, Code::Entry> linked_entries;
    for (const EntryPoint& entry : entries)
        linked_entries[entry.name] = {entry_addresses[symbol_of(entry)].toPtr<void*>(),
                                      is_replaceable ? entry_addresses[slot_of(entry)].toPtr<void**>() : nullptr,
                                      entry.lanes == LaneForm::points};
    return {std::make_shared<Code>(std::move(linked_entries), memory, !is_replaceable), {}};
}

CodeResult Engine::compile(const ir::Module& module, std::span<const EntryPoint> entries, const CodeOptions& options)
{
    if (!fault.empty()) return {nullptr, fault};
    KernelCalls calls(module, processor, info.identity);
    const std::string identity = identity_of(calls, entries);
    const auto generate_for = [&](Effort effort, llvm::LLVMContext& context) {
        const bool has_kernels = options.kernels && effort != Effort::full;
        auto generated =
            generate(module, entries, processor, context, has_kernels ? &calls : nullptr, effort == Effort::draft);
        if (effort != Effort::full) make_replaceable(*generated, entries);
        return generated;
    };
    const auto callees_for = [&](Effort effort) {
        return Fetch(shared, calls.used(), std::min(effort, kernel_effort_max));
    };
    Object object;
    if (options.kernels) object = found_object(identity, options.effort);
    if (!object.bytes.empty()) {
        if (object.effort != Effort::full) { // which kernels it calls
            llvm::LLVMContext context;
            generate_for(object.effort, context);
        }
        Fetch callees = callees_for(object.effort);
        CodeResult linked = link(object, entries, callees);
        if (linked.code) return linked; // else what is on disk is no good
    }
    llvm::LLVMContext context;
    const std::unique_ptr<llvm::Module> generated = generate_for(options.effort, context);
    const auto start = std::chrono::steady_clock::now();
    Fetch callees = callees_for(options.effort);
    object = compilers.make(*generated, options.effort);
    if (!object.error.empty()) return {nullptr, object.error};
    const bool took_long = std::chrono::steady_clock::now() - start > worth_keeping;
    if (options.kernels && (took_long || options.effort == Effort::full)) keep(object, identity);
    return link(object, entries, callees);
}

} // namespace

haptel_entry* Code::entry(const std::string& name) const
{
    const auto found = entries.find(name);
    const bool is_one = found != entries.end() && !found->second.is_batch;
    return is_one ? reinterpret_cast<haptel_entry*>(found->second.address) : nullptr;
}

haptel_batch_entry* Code::batch_entry(const std::string& name) const
{
    const auto found = entries.find(name);
    const bool is_one = found != entries.end() && found->second.is_batch;
    return is_one ? reinterpret_cast<haptel_batch_entry*>(found->second.address) : nullptr;
}

void Code::replace_by(std::shared_ptr<const Code> better) const
{
    const std::lock_guard lock(replacing);
    if (is_final) return;
    replacement = std::move(better); // first, so that it outlives every call
    for (const auto& [name, entry] : entries)
        std::atomic_ref(*entry.slot).store(replacement->entries.at(name).address, std::memory_order_release);
    is_final = true;
}

CodeResult compile_code(const ir::Module& module, std::span<const EntryPoint> entries, const CodeOptions& options)
{
    return engine().compile(module, entries, options);
}

void prepare_kernels(const ir::Module& module, std::span<const EntryPoint> entries)
{
    if (!engine().fault.empty()) return;
    KernelCalls calls(module, engine().processor, engine().info.identity);
    llvm::LLVMContext context;
    generate(module, entries, engine().processor, context, &calls, true);
    Addresses unused;
    Fetch(engine().shared, calls.used(), kernel_effort_max).finish(unused);
}

size_t programs_alive()
{
    return engine().programs;
}

size_t kernels_alive()
{
    return engine().shared.count();
}

const EngineInfo& engine_info()
{
    return engine().info;
}

} // namespace haptel::jit
