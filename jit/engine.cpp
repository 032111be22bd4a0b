#include "jit/engine.h"

#include "jit/code_version.h"
#include "jit/isa.h"
#include "jit/kernels.h"
#include "jit/linker.h"
#include "jit/llvm.h"
#include "jit/machine_code.h"
#include "jit/object_cache.h"
#include "jit/replaceable.h"
#include "jit/stopwatch.h"

#include <array>
#include <atomic>
#include <cstdlib>
#include <functional>
#include <mutex>

namespace haptel::jit {

namespace {

// A program that is made in less time than that is not worth a file, unless it is of full effort: that is what the next
// process begins with. Kernels always are: textures share them.
constexpr double worth_keeping_s = 10e-3;
// More makes no kernel faster that was measured, and takes twice as long.
constexpr Effort kernel_effort_max = Effort::quick;

// An object file and how to come by it.
struct Object {
    std::string bytes, error;
    Effort effort = Effort::quick; // what went into it, at least what was asked for
    bool is_from_disk = false;
};

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
    size_t kernel_count()
    {
        const std::lock_guard lock(kernels_mutex);
        return kernels.size();
    }
    uint32_t lanes() const { return processor.lanes; }
    std::string isa() const { return compilers[0].machine ? isa_of(*compilers[0].machine) : ""; }

private:
    struct Compiler {
        std::mutex in_use;
        std::unique_ptr<llvm::TargetMachine> machine;
    };
    struct Shared {
        llvm::orc::ExecutorAddr address;
        Effort effort;
    };
    using Generate = std::function<std::unique_ptr<llvm::Module>(llvm::LLVMContext&)>;

    Engine();
    std::string start();
    Object make(Effort effort, CompileTimes& times, const Generate& generate);
    CodeResult link(const Object& object, const ir::Module& module, std::span<const EntryPoint> entries,
                    const KernelCalls& calls, CompileTimes& times);
    std::string link_shared(const std::string& name, const std::string& identity, Effort effort,
                            const Generate& generate, llvm::orc::ExecutorAddr& address);
    std::string link_calls(const ir::Module& module, const KernelCalls& calls, Effort effort, Addresses& addresses);
    std::string identity_of(const KernelCalls& calls, std::span<const EntryPoint> entries) const;

    std::string fault; // why there is no engine; empty: there is
    std::string machine_name;
    std::string target; // all that decides what code is made of an IR
    Processor processor;
    std::array<Compiler, 3> compilers; // by Effort
    Linker linker;
    std::mutex kernels_mutex;
    std::map<std::string, Shared> kernels; // linked, by name; the best of each
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
    machine_name = "LLVM " LLVM_VERSION_STRING " " + host->getTargetTriple().str() + " " + host->getCPU();

    constexpr llvm::CodeGenOptLevel levels[] = {llvm::CodeGenOptLevel::None, llvm::CodeGenOptLevel::Less,
                                                llvm::CodeGenOptLevel::Default};
    for (size_t effort = 0; effort < compilers.size(); ++effort) {
        host->setCodeGenOptLevel(levels[effort]);
        auto made = host->createTargetMachine();
        if (!made) return "no code generator for " + machine_name + ": " + llvm::toString(made.takeError());
        compilers[effort].machine = std::move(*made);
    }
    const llvm::TargetMachine& machine = *compilers[0].machine;
    processor = processor_of(machine);
    target = std::string(code_version) + ";" + machine_name + ";" + machine.getTargetFeatureString().str() + ";" +
             std::to_string(processor.lanes);
    return linker.start(*host, machine.createDataLayout());
}

ContentHash key_of(const std::string& identity, Effort effort)
{
    return content_hash(identity + ";" + std::to_string(static_cast<int>(effort)));
}

// On disk, of that effort or a greater one.
Object found_object(const std::string& identity, Effort effort)
{
    for (Effort kept : {Effort::full, Effort::quick, Effort::draft})
        if (kept >= effort)
            if (std::optional<std::string> found = ObjectCache::shared().load(key_of(identity, kept)))
                return {std::move(*found), {}, kept, true};
    return {};
}

Object Engine::make(Effort effort, CompileTimes& times, const Generate& generate)
{
    Compiler& compiler = compilers[static_cast<size_t>(effort)];
    const std::lock_guard lock(compiler.in_use);
    Stopwatch stopwatch;
    llvm::LLVMContext context;
    const std::unique_ptr<llvm::Module> generated = generate(context);
    times.generate_s += stopwatch.lap_s();
    llvm::SmallVector<char, 0> made;
    std::string error = make_object(*generated, *compiler.machine, effort, made, times);
    return {std::string(made.data(), made.size()), std::move(error), effort};
}

void keep(const Object& object, const std::string& identity)
{
    ObjectCache::shared().store(key_of(identity, object.effort), object.bytes);
}

// What programs share, once per process: a function of that name, known on disk by its identity.
std::string Engine::link_shared(const std::string& name, const std::string& identity, Effort effort,
                                const Generate& generate, llvm::orc::ExecutorAddr& address)
{
    {
        const std::lock_guard lock(kernels_mutex);
        const auto known = kernels.find(name);
        if (known != kernels.end() && known->second.effort >= effort) {
            address = known->second.address;
            return {};
        }
    }
    Addresses wanted{{name, {}}};
    Object object = found_object(identity, effort);
    if (object.bytes.empty() || !linker.link(object.bytes, {}, wanted).place) {
        CompileTimes unused;
        object = make(effort, unused, generate);
        if (!object.error.empty()) return object.error;
        if (effort != Effort::draft) keep(object, identity);
        if (Linker::Linked linked = linker.link(object.bytes, {}, wanted); !linked.place) return linked.error;
    }
    address = wanted.begin()->second;
    const std::lock_guard lock(kernels_mutex);
    kernels.insert_or_assign(name, Shared{address, object.effort});
    return {};
}

// Equal for programs of equal code: what their entries do, under which names, and where they find the parameters.
std::string Engine::identity_of(const KernelCalls& calls, std::span<const EntryPoint> entries) const
{
    std::string text = target;
    const auto add = [&](std::string_view word) { text.append(std::to_string(word.size())).append(" ").append(word); };
    for (const EntryPoint& entry : entries) {
        const bool is_height = entry.kind == EntryPoint::Kind::height;
        add(entry.name);
        add(to_text(calls.hash_of(is_height ? entry.texture->height : entry.texture->height_gradient)));
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

// What a program calls, linked. Nothing or why not.
std::string Engine::link_calls(const ir::Module& module, const KernelCalls& calls, Effort effort, Addresses& addresses)
{
    std::string error;
    for (const auto& [name, kernel] : calls.used()) {
        const auto generate_it = [&, &symbol = name, &wanted = kernel](llvm::LLVMContext& context) {
            return generate_kernel(module, symbol, wanted, processor, context);
        };
        if (error.empty()) error = link_shared(name, name, effort, generate_it, addresses[name]);
    }
    for (const auto& [name, form] : calls.used_elementary()) {
        const auto generate_it = [&symbol = name, &wanted = form](llvm::LLVMContext& context) {
            return generate_elementary(symbol, wanted, context);
        };
        if (error.empty()) error = link_shared(name, name + ";" + target, effort, generate_it, addresses[name]);
    }
    return error;
}

void Engine::prepare_kernels(const ir::Module& module, std::span<const EntryPoint> entries)
{
    if (!fault.empty()) return;
    KernelCalls calls(module, target);
    llvm::LLVMContext context;
    generate(module, entries, processor, context, &calls);
    Addresses unused;
    link_calls(module, calls, kernel_effort_max, unused);
}

// With the kernels that the object calls. An object from disk that cannot be linked leaves no code and no error.
CodeResult Engine::link(const Object& object, const ir::Module& module, std::span<const EntryPoint> entries,
                        const KernelCalls& calls, CompileTimes& times)
{
    Stopwatch stopwatch;
    Addresses kernel_addresses, entry_addresses;
    const Effort effort = std::min(object.effort, kernel_effort_max);
    if (std::string error = link_calls(module, calls, effort, kernel_addresses); !error.empty())
        return {nullptr, error};
    times.kernels_s = stopwatch.lap_s();

    const bool is_replaceable = object.effort != Effort::full;
    for (const EntryPoint& entry : entries) {
        entry_addresses[entry.name];
        if (is_replaceable) entry_addresses[slot_of(entry.name)];
    }
    const Linker::Linked linked = linker.link(object.bytes, kernel_addresses, entry_addresses);
    if (!linked.place) return {nullptr, object.is_from_disk ? "" : linked.error};
    auto code = std::make_shared<LinkedCode>(*linked.place);
    for (const EntryPoint& entry : entries) {
        code->add(entry, entry_addresses[entry.name]);
        if (is_replaceable) code->add_slot(entry, entry_addresses[slot_of(entry.name)]);
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
    KernelCalls calls(module, target);
    const std::string identity = identity_of(calls, entries);
    const auto generate_for = [&](Effort effort) {
        const bool has_kernels = options.kernels && effort != Effort::full;
        return [&, has_kernels, effort](llvm::LLVMContext& context) {
            auto generated = generate(module, entries, processor, context, has_kernels ? &calls : nullptr);
            if (effort != Effort::full) make_replaceable(*generated, entries);
            return generated;
        };
    };
    Object object;
    if (options.kernels) object = found_object(identity, options.effort);
    if (!object.bytes.empty()) {
        if (object.effort != Effort::full) { // which kernels it calls
            llvm::LLVMContext context;
            generate_for(object.effort)(context);
        }
        times.generate_s = stopwatch.lap_s();
        CodeResult linked = link(object, module, entries, calls, times);
        if (linked.code || !linked.error.empty()) return linked;
    }
    times.generate_s = stopwatch.lap_s();
    object = make(options.effort, times, generate_for(options.effort));
    if (!object.error.empty()) return {nullptr, object.error};
    if (options.kernels && (stopwatch.lap_s() > worth_keeping_s || options.effort == Effort::full))
        keep(object, identity);
    return link(object, module, entries, calls, times);
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

std::string engine_name()
{
    return Engine::get().name();
}

} // namespace haptel::jit
