#include "jit/engine/shared_code.h"

#include "jit/engine/object_cache.h"

#include <algorithm>
#include <thread>

namespace haptel::jit {

namespace {

ContentHash key_of(const std::string& identity, Effort effort)
{
    return content_hash(identity + ";" + std::to_string(static_cast<int>(effort)));
}

} // namespace

Object found_object(const std::string& identity, Effort effort)
{
    for (Effort kept : {Effort::full, Effort::quick, Effort::draft})
        if (kept >= effort)
            if (std::optional<std::string> found = ObjectCache::shared().load(key_of(identity, kept)))
                return {std::move(*found), {}, kept};
    return {};
}

void keep(const Object& object, const std::string& identity)
{
    ObjectCache::shared().store(key_of(identity, object.effort), object.bytes);
}

llvm::orc::ExecutorAddr SharedCode::known(const std::string& name, Effort effort)
{
    const std::lock_guard lock(mutex);
    const auto found = linked.find(name);
    return found != linked.end() && found->second.effort >= effort ? found->second.address : llvm::orc::ExecutorAddr();
}

size_t SharedCode::count()
{
    const std::lock_guard lock(mutex);
    return linked.size();
}

std::string SharedCode::link(const Function& function, Effort effort)
{
    const auto& [name, write] = function;
    const std::string identity = name + ";" + target;
    Addresses wanted{{name, {}}};
    Object object = found_object(identity, effort);
    if (object.bytes.empty() || !linker.link(object.bytes, {}, wanted).place) {
        llvm::LLVMContext context;
        llvm::Module alone(name, context);
        write(alone, effort == Effort::draft);
        object = compilers.make(alone, effort);
        if (!object.error.empty()) return object.error;
        if (effort != Effort::draft) keep(object, identity);
        if (Linker::Linked made = linker.link(object.bytes, {}, wanted); !made.place) return made.error;
    }
    const Linked made{wanted.begin()->second, object.effort};
    const std::lock_guard lock(mutex);
    const auto [place, is_new] = linked.try_emplace(name, made);
    if (!is_new && place->second.effort < made.effort) place->second = made;
    return {};
}

Fetch::Fetch(SharedCode& from, const FunctionsApart& functions, Effort of_effort)
    : shared(from), wanted(functions), effort(of_effort)
{
    for (const SharedCode::Function& function : wanted)
        if (!shared.known(function.first, effort)) missing.push_back({function});
    const size_t others = std::max(std::thread::hardware_concurrency(), 2u) - 1;
    while (helpers.size() < std::min(missing.size(), others)) // deferred where no thread is to be had
        helpers.push_back(std::async(std::launch::async | std::launch::deferred, [this] { work(); }));
}

void Fetch::work()
{
    for (size_t i = next++; i < missing.size(); i = next++) missing[i].error = shared.link(missing[i].function, effort);
}

std::string Fetch::finish(Addresses& addresses)
{
    work();
    for (std::future<void>& helper : helpers) helper.get();
    helpers.clear();
    for (const Missing& one : missing)
        if (!one.error.empty()) return one.error;
    for (const SharedCode::Function& function : wanted)
        addresses[function.first] = shared.known(function.first, effort);
    return {};
}

} // namespace haptel::jit
