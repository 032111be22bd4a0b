#include "lang/library.h"

#include "lang/parser.h"

#include <algorithm>
#include <mutex>

namespace haptel::lang {
namespace {

bool is_of(const CheckedLibrary& library, const std::vector<SourceFile>& texts)
{
    const auto same = [&, index = SourceSet::library_files](const SourceFile& text) mutable {
        const uint32_t file = index++;
        return library.sources->has(file) && library.sources->file(file).name == text.name &&
               library.sources->file(file).text == text.text;
    };
    return library.program.files.size() == texts.size() && std::all_of(texts.begin(), texts.end(), same);
}

std::shared_ptr<const CheckedLibrary> made_of(const std::vector<SourceFile>& texts)
{
    auto library = std::make_shared<CheckedLibrary>();
    auto sources = std::make_shared<SourceSet>(SourceSet::library_files);
    std::vector<CheckFile> files;
    for (const SourceFile& text : texts)
        files.push_back({parse(*sources, sources->add(text), library->diagnostics), {}});
    check(*sources, std::move(files), *library);
    library->sources = std::move(sources);
    return library;
}

} // namespace

std::shared_ptr<const CheckedLibrary> checked_library(const std::vector<SourceFile>& texts)
{
    if (texts.empty()) return nullptr;
    static std::mutex mutex;
    static auto& latest = *new std::shared_ptr<const CheckedLibrary>; // threads may outlive static objects
    const std::lock_guard lock(mutex);
    if (!latest || !is_of(*latest, texts)) latest = made_of(texts);
    return latest;
}

} // namespace haptel::lang
