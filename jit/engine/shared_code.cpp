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
                return {std::move(*found), {}, kept, true};
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

std::string SharedCode::link(const Function& function, Effort effort, llvm::orc::ExecutorAddr& address)
{
    Addresses wanted{{function.name, {}}};
    Object object = found_object(function.identity, effort);
    if (object.bytes.empty() || !linker.link(object.bytes, {}, wanted).place) {
        CompileTimes unused;
        llvm::LLVMContext context;
        object = compilers.make(*function.generate(context, effort), effort, unused);
        if (!object.error.empty()) return object.error;
        if (effort != Effort::draft) keep(object, function.identity);
        if (Linker::Linked made = linker.link(object.bytes, {}, wanted); !made.place) return made.error;
    }
    address = wanted.begin()->second;
    const std::lock_guard lock(mutex);
    const auto [place, is_new] = linked.try_emplace(function.name, Linked{address, object.effort});
    if (!is_new && place->second.effort < object.effort) place->second = {address, object.effort};
    return {};
}

Fetch::Fetch(SharedCode& from, std::vector<SharedCode::Function> wanted, Effort of_effort)
    : shared(from), effort(of_effort)
{
    for (SharedCode::Function& function : wanted) {
        if (const auto address = shared.known(function.name, effort))
            found[function.name] = address;
        else
            missing.push_back({std::move(function), {}, {}});
    }
    const size_t others = std::max(std::thread::hardware_concurrency(), 2u) - 1;
    while (helpers.size() < std::min(missing.size(), others)) // deferred where no thread is to be had
        helpers.push_back(std::async(std::launch::async | std::launch::deferred, [this] { work(); }));
}

void Fetch::work()
{
    for (size_t i = next++; i < missing.size(); i = next++)
        missing[i].error = shared.link(missing[i].function, effort, missing[i].address);
}

std::string Fetch::finish(Addresses& addresses)
{
    work();
    for (std::future<void>& helper : helpers) helper.get();
    helpers.clear();
    addresses = found;
    for (const Item& item : missing) {
        if (!item.error.empty()) return item.error;
        addresses[item.function.name] = item.address;
    }
    return {};
}

} // namespace haptel::jit
