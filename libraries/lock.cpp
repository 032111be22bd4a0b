#include "libraries/lock.h"

#include "input/regular_file.h"
#include "input/toml/keyed_table.h"
#include "input/toml/toml_syntax.h"
#include "libraries/manifest.h"

#include <algorithm>
#include <tuple>

namespace haptel::libraries {

namespace {

constexpr const char* how_it_is_made = "`haptel install --project` writes this file";

bool is_sha256(std::string_view text)
{
    return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == text.npos;
}

} // namespace

std::optional<std::vector<Locked>> read_lock(std::string_view text, input::FileMessages& messages)
{
    const std::optional<toml::table> root = input::parse_toml(text, messages);
    if (!root) return std::nullopt;
    input::KeyedTable keys(*root, "", messages);
    std::vector<Locked> all;
    const bool has_libraries = keys.has("library");
    keys.report_unknown_keys();
    const toml::node* const list = root->get("library");
    if (has_libraries && !list->is_array_of_tables()) {
        messages.error(list->source(), std::string("expected `[[library]]` in two brackets: ") + how_it_is_made);
        return std::nullopt;
    }
    if (!has_libraries) return messages.any_error() ? std::nullopt : std::optional(all);
    for (const toml::node& each : *list->as_array()) {
        input::KeyedTable library(*each.as_table(), "[[library]]", messages);
        Locked locked;
        std::string version;
        library.text("name", locked.name);
        library.text("version", version);
        library.text("sha256", locked.sha256);
        library.report_unknown_keys();
        const std::optional<Version> parsed = parse_version(version);
        locked.version = parsed.value_or(Version{});
        if (!is_library_name(locked.name) || !parsed || !is_sha256(locked.sha256))
            messages.error(each.source(), std::string("expected a name, a version of three numbers and a sha256 of 64 "
                                                      "digits: ") +
                                              how_it_is_made);
        all.push_back(std::move(locked));
    }
    if (messages.any_error()) return std::nullopt;
    return all;
}

LockFile read_lock_file(const std::filesystem::path& file)
{
    const input::FileBytes read = input::read_regular_file(file, lock_bytes_max);
    if (read.refused.refusal == input::Refusal::missing) return {};
    if (read.refused.refusal != input::Refusal::none) return {{}, file.string() + " " + read.refused.why};
    input::FileMessages messages(file);
    std::optional<std::vector<Locked>> libraries = read_lock(read.bytes, messages);
    const std::string said = messages.text();
    return {std::move(libraries).value_or(std::vector<Locked>()), said.substr(0, said.find('\n'))};
}

std::string lock_text(std::vector<Locked> libraries)
{
    std::sort(libraries.begin(), libraries.end(), [](const Locked& a, const Locked& b) {
        return std::tie(a.name, a.version) < std::tie(b.name, b.version);
    });
    std::string text = "# The libraries of this project, to the byte. `haptel install --project` writes this file.\n";
    for (const Locked& one : libraries)
        text += "\n[[library]]\nname = \"" + one.name + "\"\nversion = \"" + to_text(one.version) + "\"\nsha256 = \"" +
                one.sha256 + "\"\n";
    return text;
}

} // namespace haptel::libraries
