#include "jit/engine/linker.h"

#include "jit/codegen/codegen.h"

namespace haptel::jit {

namespace {

namespace orc = llvm::orc;

std::string text(llvm::Error error)
{
    return llvm::toString(std::move(error));
}

} // namespace

std::string Linker::start(const orc::JITTargetMachineBuilder& host, const llvm::DataLayout& layout)
{
    auto built = orc::LLJITBuilder()
                     .setJITTargetMachineBuilder(host)
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

Linker::Linked Linker::link(std::string_view object, const Addresses& others, Addresses& wanted)
{
    auto made = jit->createJITDylib("object " + std::to_string(++links));
    if (!made) return {nullptr, "no room for the object: " + text(made.takeError())};
    orc::JITDylib& place = *made;
    const auto failed = [&](const std::string& what, llvm::Error error) {
        remove(place);
        return Linked{nullptr, what + text(std::move(error))};
    };
    place.addToLinkOrder(*library);
    orc::SymbolMap symbols;
    for (const auto& [name, address] : others)
        symbols[jit->mangleAndIntern(name)] = {address, llvm::JITSymbolFlags::Exported};
    if (!symbols.empty())
        if (auto error = place.define(orc::absoluteSymbols(std::move(symbols))))
            return failed("what the object calls was refused: ", std::move(error));
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

} // namespace haptel::jit
