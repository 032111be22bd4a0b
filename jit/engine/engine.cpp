#include "jit/engine/engine.h"

#include "jit/codegen/isa.h"
#include "jit/codegen/kernels.h"
#include "jit/codegen/llvm.h"
#include "jit/engine/code_generator_tables.h"
#include "jit/engine/code_version.h"
#include "jit/engine/compilers.h"
#include "jit/engine/hot_swap.h"
#include "jit/engine/linker.h"
#include "jit/engine/llvm_library.h"
#include "jit/engine/shared_code.h"
#include "jit/engine/stopwatch.h"

#include <atomic>
#include <cstdlib>

namespace haptel::jit {

namespace {

// A program that is made in less time than that is not worth a file, unless it is of full effort: that is what the next
// process begins with. Kernels always are: textures share them.
constexpr double worth_keeping_s = 10e-3;
// More makes no kernel faster that was measured, and takes twice as long.
constexpr Effort kernel_effort_max = Effort::quick;

// What is made once per process and never taken down: code may outlive every static object.
class Engine {
public:
    static Engine& get()
    {
        static Engine* engine = new Engine;
        return *engine;
    }

    CodeResult compile(const ir::Module& module, std::span<const EntryPoint> entries, const CodeOptions& options);
    void prepare_kernels(const ir::Module& module, std::span<const EntryPoint> entries);
    void remove(llvm::orc::JITDylib& place) { linker.remove(place); }
    std::string name() const { return machine_name; }
    std::string identity() const { return target; }
    size_t kernel_count() { return shared.count(); }
    uint32_t lanes() const { return processor.lanes; }
    std::string isa() const { return isa_text; }

private:
    Engine();
    std::string start();
    CodeResult link(const Object& object, std::span<const EntryPoint> entries, Fetch& callees, CompileTimes& times);
    std::string identity_of(const KernelCalls& calls, std::span<const EntryPoint> entries) const;

    std::string fault; // why there is no engine; empty: there is
    std::string machine_name, isa_text;
    std::string target; // all that decides what code is made of an IR
    Processor processor;
    Compilers compilers;
    Linker linker;
    SharedCode shared{compilers, linker, target};
};

std::atomic<size_t> alive{0};

class LinkedCode final : public Code {
public:
    explicit LinkedCode(llvm::orc::JITDylib& own) : place(own) { ++alive; }
    ~LinkedCode() override
    {
        Engine::get().remove(place);
        --alive;
    }
    void add(const EntryPoint& entry, llvm::orc::ExecutorAddr address)
    {
        if (entry.lanes == LaneForm::points)
            batch_entries[entry.name] = address.toPtr<haptel_batch_entry*>();
        else
            entries[entry.name] = address.toPtr<haptel_entry*>();
    }
    void add_slot(const EntryPoint& entry, llvm::orc::ExecutorAddr address)
    {
        slots[entry.name] = address.toPtr<void**>();
    }
    void set_full() { is_final = true; }

private:
    llvm::orc::JITDylib& place;
};

Engine::Engine()
{
    fault = start();
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
    machine_name = "LLVM " + llvm_version() + " " + host->getTargetTriple().str() + " " + host->getCPU();

    if (std::string error = compilers.start(*host); !error.empty()) return error;
    compilers.with_machine([&](const llvm::TargetMachine& machine) {
        make_code_generator_tables(machine);
        processor = processor_of(machine);
        isa_text = isa_of(machine);
        target = std::string(code_version) + ";" + llvm_identity() + ";" + machine_name + ";" +
                 machine.getTargetFeatureString().str() + ";" + std::to_string(processor.lanes);
        fault = linker.start(*host, machine.createDataLayout());
    });
    return fault;
}

// Equal for programs of equal code: what their entries do, under which names, and where they find the parameters.
std::string Engine::identity_of(const KernelCalls& calls, std::span<const EntryPoint> entries) const
{
    std::string text = target;
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

void Engine::prepare_kernels(const ir::Module& module, std::span<const EntryPoint> entries)
{
    if (!fault.empty()) return;
    KernelCalls calls(module, processor, target);
    llvm::LLVMContext context;
    generate(module, entries, processor, context, &calls, true);
    Addresses unused;
    Fetch(shared, calls.used(), kernel_effort_max).finish(unused);
}

// With what the object calls. An object from disk that cannot be linked leaves no code and no error.
CodeResult Engine::link(const Object& object, std::span<const EntryPoint> entries, Fetch& callees, CompileTimes& times)
{
    Stopwatch stopwatch;
    Addresses callee_addresses, entry_addresses;
    if (std::string error = callees.finish(callee_addresses); !error.empty()) return {nullptr, error};
    times.kernels_s = stopwatch.lap_s();

    const bool is_replaceable = object.effort != Effort::full;
    for (const EntryPoint& entry : entries) {
        entry_addresses[symbol_of(entry)];
        if (is_replaceable) entry_addresses[slot_of(entry)];
    }
    const Linker::Linked linked = linker.link(object.bytes, callee_addresses, entry_addresses);
    if (!linked.place) return {nullptr, object.is_from_disk ? "" : linked.error};
    auto code = std::make_shared<LinkedCode>(*linked.place);
    for (const EntryPoint& entry : entries) {
        code->add(entry, entry_addresses[symbol_of(entry)]);
        if (is_replaceable) code->add_slot(entry, entry_addresses[slot_of(entry)]);
    }
    if (!is_replaceable) code->set_full();
    times.link_s = stopwatch.lap_s();
    code->times = times;
    return {std::move(code), {}};
}

CodeResult Engine::compile(const ir::Module& module, std::span<const EntryPoint> entries, const CodeOptions& options)
{
    if (!fault.empty()) return {nullptr, fault};
    CompileTimes times;
    Stopwatch stopwatch;
    KernelCalls calls(module, processor, target);
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
        times.generate_s = stopwatch.lap_s();
        Fetch callees = callees_for(object.effort);
        CodeResult linked = link(object, entries, callees, times);
        if (linked.code || !linked.error.empty()) return linked;
    }
    llvm::LLVMContext context;
    const std::unique_ptr<llvm::Module> generated = generate_for(options.effort, context);
    times.generate_s = stopwatch.lap_s();
    Fetch callees = callees_for(options.effort);
    object = compilers.make(*generated, options.effort, times);
    if (!object.error.empty()) return {nullptr, object.error};
    if (options.kernels && (stopwatch.lap_s() > worth_keeping_s || options.effort == Effort::full))
        keep(object, identity);
    return link(object, entries, callees, times);
}

} // namespace

void Code::replace_by(std::shared_ptr<const Code> better) const
{
    const std::lock_guard lock(replacing);
    if (is_final) return;
    replacement = std::move(better); // first, so that it outlives every call
    for (const auto& [name, slot] : slots) {
        void* code = reinterpret_cast<void*>(replacement->entry(name));
        if (!code) code = reinterpret_cast<void*>(replacement->batch_entry(name));
        if (code) std::atomic_ref(*slot).store(code, std::memory_order_release);
    }
    is_final = true;
}

haptel_entry* Code::entry(const std::string& name) const
{
    const auto found = entries.find(name);
    return found == entries.end() ? nullptr : found->second;
}

haptel_batch_entry* Code::batch_entry(const std::string& name) const
{
    const auto found = batch_entries.find(name);
    return found == batch_entries.end() ? nullptr : found->second;
}

CodeResult compile_code(const ir::Module& module, std::span<const EntryPoint> entries, const CodeOptions& options)
{
    return Engine::get().compile(module, entries, options);
}

void prepare_kernels(const ir::Module& module, std::span<const EntryPoint> entries)
{
    Engine::get().prepare_kernels(module, entries);
}

size_t programs_alive()
{
    return alive;
}

size_t kernels_alive()
{
    return Engine::get().kernel_count();
}

uint32_t batch_lanes()
{
    return Engine::get().lanes();
}

std::string isa_name()
{
    return Engine::get().isa();
}

std::string code_identity()
{
    return Engine::get().identity();
}

std::string engine_name()
{
    return Engine::get().name();
}

} // namespace haptel::jit
