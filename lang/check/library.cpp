#include "lang/check/library.h"

#include "lang/check/check.h"

#include "lang/syntax/outline.h"
#include "lang/syntax/parser.h"

#include <algorithm>
#include <mutex>
#include <unordered_map>

namespace haptel::lang {
namespace {

// Texts and what of them has been wanted so far, which only grows.
class Library {
public:
    explicit Library(const std::vector<SourceFile>& texts)
    {
        for (const SourceFile& text : texts) {
            const uint32_t file = sources->add(text);
            outlines.emplace_back(*sources, file, lex(*sources, file, of_lexer));
        }
        for (size_t file = 0; file < outlines.size(); ++file) {
            const std::vector<Outline::Part>& parts = outlines[file].parts;
            is_wanted.emplace_back(parts.size());
            for (size_t part = 0; part < parts.size(); ++part) {
                is_wanted[file][part] = parts[part].names.empty(); // it must be a mistake, to be told
                for (std::string_view name : parts[part].names) unread[name].push_back({file, part});
            }
        }
    }

    bool is_of(const std::vector<SourceFile>& texts) const
    {
        const auto same = [&, index = SourceSet::library_files](const SourceFile& text) mutable {
            const uint32_t file = index++;
            return sources->has(file) && sources->file(file).name == text.name && sources->file(file).text == text.text;
        };
        return outlines.size() == texts.size() && std::all_of(texts.begin(), texts.end(), same);
    }

    // Null: with all names.
    std::shared_ptr<const CheckedLibrary> with(const Names* names)
    {
        bool has_grown = !checked;
        std::vector<std::string_view> to_see;
        if (names) to_see.assign(names->begin(), names->end());
        for (const auto& [name, places] : unread)
            if (!names) to_see.push_back(name);
        while (!to_see.empty()) {
            const auto found = unread.extract(to_see.back());
            to_see.pop_back();
            if (found.empty()) continue;
            for (const auto& [file, part] : found.mapped()) {
                if (is_wanted[file][part]) continue;
                is_wanted[file][part] = has_grown = true;
                const auto mentioned = outlines[file].mentions(outlines[file].parts[part]);
                to_see.insert(to_see.end(), mentioned.begin(), mentioned.end());
            }
        }
        if (has_grown) check_wanted();
        return checked;
    }

private:
    struct Place {
        size_t file, part;
    };

    void check_wanted()
    {
        auto made = std::make_shared<CheckedLibrary>();
        made->sources = sources;
        made->diagnostics = of_lexer;
        made->is_whole = std::ranges::all_of(is_wanted, [](const std::vector<bool>& parts) {
            return std::find(parts.begin(), parts.end(), false) == parts.end();
        });
        std::vector<CheckFile> files;
        for (size_t i = 0; i < outlines.size(); ++i) {
            const uint32_t file = SourceSet::library_files + static_cast<uint32_t>(i);
            files.push_back({parse(*sources, file, outlines[i].tokens_of(is_wanted[i]), made->diagnostics), {}});
        }
        made->program = check(*sources, std::move(files), nullptr, made->diagnostics, &made->declarations);
        checked = std::move(made);
    }

    const std::shared_ptr<SourceSet> sources = std::make_shared<SourceSet>(SourceSet::library_files);
    Diagnostics of_lexer;
    std::vector<Outline> outlines;                                   // by file
    std::vector<std::vector<bool>> is_wanted;                        // by file and part
    std::unordered_map<std::string_view, std::vector<Place>> unread; // where names are declared that nobody has named
    std::shared_ptr<const CheckedLibrary> checked;                   // what is wanted
};

// With these names; null: all.
std::shared_ptr<const CheckedLibrary> latest_library(const std::vector<SourceFile>& texts, const Names* names)
{
    if (texts.empty()) return nullptr;
    static std::mutex mutex;
    static auto& latest = *new std::unique_ptr<Library>; // threads may outlive static objects
    const std::lock_guard lock(mutex);
    if (!latest || !latest->is_of(texts)) latest = std::make_unique<Library>(texts);
    return latest->with(names);
}

} // namespace

std::shared_ptr<const CheckedLibrary> checked_library(const std::vector<SourceFile>& texts, const Names& names)
{
    return latest_library(texts, &names);
}

std::shared_ptr<const CheckedLibrary> whole_library(const std::vector<SourceFile>& texts)
{
    return latest_library(texts, nullptr);
}

} // namespace haptel::lang
