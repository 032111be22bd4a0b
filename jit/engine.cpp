#include "jit/engine.h"

#include "jit/isa.h"
#include "jit/llvm.h"
#include "jit/optimise.h"

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <mutex>

namespace haptel::jit {

namespace {

namespace orc = llvm::orc;

std::string text(llvm::Error error)
{
    return llvm::toString(std::move(error));
}

double seconds_since(std::chrono::steady_clock::time_point& start)
{
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(start, now)).count();
}

// What is made once per process and never taken down: code may outlive every static object.
class Engine {
public:
    static Engine& get()
    {
        static Engine* engine = new Engine;
        return *engine;
    }

    CodeResult compile(const ir::Module& module, std::span<const EntryPoint> entries, Effort effort);
    void remove(orc::JITDylib& library);
    std::string name() const { return machine_name; }
    uint32_t lanes() const { return processor.lanes; }
    std::string isa() const { return quick_machine ? isa_of(*quick_machine) : ""; }

private:
    Engine();
    std::string start();
    llvm::TargetMachine* machine(Effort effort)
    {
        return (effort == Effort::quick ? quick_machine : full_machine).get();
    }
    std::string select(llvm::Module& module, Effort effort, llvm::SmallVectorImpl<char>& object);

    std::mutex compiling;
    std::string fault; // why there is no engine; empty: there is
    std::string machine_name;
    Processor processor;
    std::unique_ptr<llvm::TargetMachine> quick_machine, full_machine;
    std::unique_ptr<orc::LLJIT> jit;
    orc::JITDylib* library = nullptr; // holds code_library()
    uint64_t programs = 0;            // made so far, for names
};

std::atomic<size_t> alive{0};

class LinkedCode final : public Code {
public:
    explicit LinkedCode(orc::JITDylib& own) : library(own) { ++alive; }
    ~LinkedCode() override
    {
        Engine::get().remove(library);
        --alive;
    }
    void add(const EntryPoint& entry, orc::ExecutorAddr address)
    {
        if (entry.lanes == LaneForm::points)
            batch_entries[entry.name] = address.toPtr<haptel_batch_entry*>();
        else
            entries[entry.name] = address.toPtr<haptel_entry*>();
    }

private:
    orc::JITDylib& library;
};

Engine::Engine()
{
    fault = start();
}

std::string Engine::start()
{
    if (llvm::InitializeNativeTarget() || llvm::InitializeNativeTargetAsmPrinter())
        return "LLVM has no code generator for this processor";
    auto host = orc::JITTargetMachineBuilder::detectHost();
    if (!host) return "the processor was not recognised: " + text(host.takeError());
    const char* const wanted = std::getenv("HAPTEL_ISA");
    if (std::string error = restrict_to_isa(*host, wanted ? wanted : ""); !error.empty()) return error;
    host->getOptions().AllowFPOpFusion = llvm::FPOpFusion::Strict;
    machine_name = "LLVM " LLVM_VERSION_STRING " " + host->getTargetTriple().str() + " " + host->getCPU();

    for (Effort effort : {Effort::quick, Effort::full}) {
        const bool quick = effort == Effort::quick;
        host->setCodeGenOptLevel(quick ? llvm::CodeGenOptLevel::Less : llvm::CodeGenOptLevel::Default);
        auto made = host->createTargetMachine();
        if (!made) return "no code generator for " + machine_name + ": " + text(made.takeError());
        (quick ? quick_machine : full_machine) = std::move(*made);
    }

    processor = processor_of(*quick_machine);

    auto layout = quick_machine->createDataLayout();
    auto built = orc::LLJITBuilder()
                     .setJITTargetMachineBuilder(*host)
                     .setDataLayout(layout)
                     .setLinkProcessSymbolsByDefault(false)
                     .setPlatformSetUp(orc::setUpInactivePlatform) // no constructors, no thread-local data
                     .create();
    if (!built) return "the JIT did not start: " + text(built.takeError());
    jit = std::move(*built);
    // Failures come back from the lookup; nothing is printed.
    jit->getExecutionSession().setErrorReporter([](llvm::Error error) { llvm::consumeError(std::move(error)); });

    auto made = jit->createJITDylib("library");
    if (!made) return "the JIT did not start: " + text(made.takeError());
    library = &*made;
    orc::SymbolMap symbols;
    for (const LibraryFunction& function : code_library())
        symbols[jit->mangleAndIntern(function.name)] = {orc::ExecutorAddr::fromPtr(function.address),
                                                        llvm::JITSymbolFlags::Exported};
    if (auto error = library->define(orc::absoluteSymbols(std::move(symbols))))
        return "the JIT did not start: " + text(std::move(error));
    return {};
}

std::string Engine::select(llvm::Module& module, Effort effort, llvm::SmallVectorImpl<char>& object)
{
    llvm::raw_svector_ostream stream(object);
    llvm::legacy::PassManager passes;
    if (machine(effort)->addPassesToEmitFile(passes, stream, nullptr, llvm::CodeGenFileType::ObjectFile))
        return "the code generator cannot write object files for " + machine_name;
    passes.run(module);
    return {};
}

CodeResult Engine::compile(const ir::Module& module, std::span<const EntryPoint> entries, Effort effort)
{
    std::lock_guard lock(compiling);
    if (!fault.empty()) return {nullptr, fault};
    CompileTimes times;
    auto start = std::chrono::steady_clock::now();

    llvm::LLVMContext context;
    std::unique_ptr<llvm::Module> generated = generate(module, entries, processor, context);
    generated->setDataLayout(machine(effort)->createDataLayout());
    generated->setTargetTriple(machine(effort)->getTargetTriple().str());
    std::string problem;
    llvm::raw_string_ostream problems(problem);
    if (llvm::verifyModule(*generated, &problems)) return {nullptr, "generated code is malformed: " + problem};
    times.generate_s = seconds_since(start);

    optimise(*generated, *machine(effort), effort);
    times.optimise_s = seconds_since(start);

    llvm::SmallVector<char, 0> object;
    if (std::string error = select(*generated, effort, object); !error.empty()) return {nullptr, error};
    times.select_s = seconds_since(start);

    auto own = jit->createJITDylib("program " + std::to_string(++programs));
    if (!own) return {nullptr, "no room for the program: " + text(own.takeError())};
    own->addToLinkOrder(*library);
    auto code = std::make_shared<LinkedCode>(*own);
    auto buffer = std::make_unique<llvm::SmallVectorMemoryBuffer>(std::move(object), "textures", false);
    if (auto error = jit->addObjectFile(*own, std::move(buffer)))
        return {nullptr, "the program's object was refused: " + text(std::move(error))};
    for (const EntryPoint& entry : entries) {
        auto found = jit->lookup(*own, entry.name);
        if (!found) return {nullptr, "linking " + entry.name + " failed: " + text(found.takeError())};
        code->add(entry, *found);
    }
    times.link_s = seconds_since(start);
    code->times = times;
    return {std::move(code), {}};
}

void Engine::remove(orc::JITDylib& own)
{
    // The only ways to fail are the operating system's, at unmapping; there is nobody to tell and nothing to mend.
    llvm::consumeError(jit->getExecutionSession().removeJITDylib(own));
}

} // namespace

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

CodeResult compile_code(const ir::Module& module, std::span<const EntryPoint> entries, Effort effort)
{
    return Engine::get().compile(module, entries, effort);
}

size_t programs_alive()
{
    return alive;
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
