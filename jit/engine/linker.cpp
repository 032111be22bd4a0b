#include "jit/engine/linker.h"

#include "jit/codegen/codegen.h"

namespace haptel::jit {

namespace orc = llvm::orc;

std::string Linker::start(const orc::JITTargetMachineBuilder& host, const llvm::DataLayout& layout)
{
    auto built = orc::LLJITBuilder()
                     .setJITTargetMachineBuilder(host)
                     .setDataLayout(layout)
                     .setLinkProcessSymbolsByDefault(false)
                     .setPlatformSetUp(orc::setUpInactivePlatform) // no constructors, no thread-local data
                     .create();
    if (!built) return "the JIT did not start: " + llvm::toString(built.takeError());
    jit = std::move(*built);
    // Failures come back from the lookup; nothing is printed.
    jit->getExecutionSession().setErrorReporter([](llvm::Error error) { llvm::consumeError(std::move(error)); });
    library = &new_place("library");
    Addresses functions;
    for (const LibraryFunction& function : code_library())
        functions[function.name] = orc::ExecutorAddr::fromPtr(function.address);
    define(*library, functions);
    return {};
}

Linker::Linked Linker::link(std::string_view object, const Addresses& others, Addresses& wanted)
{
    orc::JITDylib& place = new_place("object " + std::to_string(++links));
    const auto failed = [&](const std::string& what, llvm::Error error) {
        remove(place);
        return Linked{nullptr, what + llvm::toString(std::move(error))};
    };
    place.addToLinkOrder(*library);
    define(place, others);
    auto bytes = llvm::MemoryBuffer::getMemBufferCopy({object.data(), object.size()}, "textures");
    if (auto error = jit->addObjectFile(place, std::move(bytes)))
        return failed("the object was refused: ", std::move(error));
    for (auto& [name, address] : wanted) {
        auto found = jit->lookup(place, name);
        if (!found) return failed("linking " + name + " failed: ", found.takeError());
        address = *found;
    }
    return {&place};
}

void Linker::remove(orc::JITDylib& place)
{
    // The only ways to fail are the operating system's, at unmapping; there is nobody to tell and nothing to mend.
    llvm::consumeError(jit->getExecutionSession().removeJITDylib(place));
}

// Each has a name of its own, which is all that can go wrong.
orc::JITDylib& Linker::new_place(const std::string& name)
{
    return llvm::cantFail(jit->createJITDylib(name));
}

// Of names that the place does not have yet.
void Linker::define(orc::JITDylib& place, const Addresses& functions)
{
    orc::SymbolMap symbols;
    for (const auto& [name, address] : functions)
        symbols[jit->mangleAndIntern(name)] = {address, llvm::JITSymbolFlags::Exported};
    llvm::cantFail(place.define(orc::absoluteSymbols(std::move(symbols))));
}

} // namespace haptel::jit
