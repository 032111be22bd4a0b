#include "libraries/manifest.h"

#include "input/regular_file.h"
#include "input/toml/keyed_table.h"
#include "input/toml/toml_syntax.h"
#include "lang/abi/library_name.h"

#include <algorithm>
#include <set>

namespace haptel::libraries {

namespace {

constexpr std::size_t name_max = 64, line_max = 200; // bytes
constexpr double preview_least_m = 1e-4, preview_greatest_m = 10;

bool is_line(std::string_view text)
{
    return text.size() <= line_max && std::none_of(text.begin(), text.end(), [](char c) {
               return static_cast<unsigned char>(c) < ' ' || c == 127;
           });
}

// An SPDX expression by its form, "Apache-2.0", "MIT OR (CC0-1.0 AND LicenseRef-mine)": whether the names in it are of
// the list of SPDX, which grows, is not looked at.
bool is_license(std::string_view text)
{
    bool wants_name = true;
    int open = 0;
    for (std::size_t at = 0; at < text.size();) {
        const auto is_letter = [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.' ||
                   c == '+';
        };
        const std::size_t end = static_cast<std::size_t>(
            std::find_if_not(text.begin() + static_cast<std::ptrdiff_t>(at), text.end(), is_letter) - text.begin());
        const std::string_view word = text.substr(at, end - at);
        const bool joins = word == "AND" || word == "OR" || word == "WITH";
        if (word.empty()) {
            const char c = text[at++];
            if (c == '(' && wants_name)
                ++open;
            else if (c == ')' && !wants_name && open > 0)
                --open;
            else if (c != ' ')
                return false;
            continue;
        }
        if (joins == wants_name) return false;
        wants_name = joins;
        at = end;
    }
    return !wants_name && open == 0;
}

class ManifestReader {
public:
    ManifestReader(const toml::table& root, input::FileMessages& to) : messages(to), keys(root, "", to) {}

    Manifest read()
    {
        Manifest made;
        uint64_t schema = 0;
        keys.whole_number("schema", schema);
        demand("schema", "1");
        if (keys.has("schema") && schema != schema_version && !messages.any_error())
            wrong("schema", "this Haptel reads schema " + std::to_string(schema_version) + ", found " +
                                std::to_string(schema) +
                                (schema > schema_version ? ": a newer Haptel may read it" : ""));
        read_name(made.name);
        read_version("version", made.version, parse_version, "three numbers, such as \"1.0.0\"");
        demand("version", "\"1.0.0\"");
        made.tagline = line("tagline");
        demand("tagline", "\"Boards, planed and rough\"");
        made.authors = lines("authors", "[\"Ada Lovelace <ada@example.org>\"]");
        demand("authors", "[\"Ada Lovelace <ada@example.org>\"]");
        made.license = line("license");
        demand("license", "\"Apache-2.0\", of https://spdx.org/licenses");
        if (!made.license.empty() && !is_license(made.license))
            wrong("license",
                  "expected the SPDX name of a licence, such as \"Apache-2.0\" or \"MIT OR CC0-1.0\", found \"" +
                      made.license + "\"");
        read_textures(made.textures);
        made.tags = lines("tags", "[\"wood\", \"rough\"]");
        read_version("haptel", made.haptel_least, parse_least_version, "the least version of Haptel, such as \"0.1\"");
        keys.whole_number("language", made.language_least);
        read_dependencies(made);
        read_previews(made);
        keys.report_unknown_keys();
        return made;
    }

private:
    void wrong(std::string_view key, const std::string& message) { messages.error(keys.where(key), message); }

    void demand(std::string_view key, std::string_view example)
    {
        if (!keys.has(key))
            messages.error("`" + std::string(key) + "` is missing: write " + std::string(key) + " = " +
                           std::string(example));
    }

    std::string line(std::string_view key)
    {
        std::string text;
        keys.text(key, text);
        if (!is_line(text))
            wrong(key,
                  "expected one line of at most " + std::to_string(line_max) + " bytes for `" + std::string(key) + "`");
        return text;
    }

    std::vector<std::string> lines(std::string_view key, std::string_view example)
    {
        std::vector<std::string> all = keys.texts(key, example);
        for (const std::string& one : all)
            if (!is_line(one))
                wrong(key, "expected lines of at most " + std::to_string(line_max) + " bytes for `" + std::string(key) +
                               "`");
        if (keys.has(key) && all.empty() && !messages.any_error())
            wrong(key, "`" + std::string(key) + "` is empty: name something, or leave the key out");
        return all;
    }

    void read_name(std::string& name)
    {
        keys.text("name", name);
        demand("name", "\"wood\"");
        if (!name.empty() && !is_library_name(name))
            wrong("name", "expected a name of small letters, digits and _, such as \"wood\", found \"" + name + "\"");
    }

    template <typename Parse>
    void read_version(std::string_view key, Version& version, Parse parse, const std::string& expected)
    {
        std::string text;
        keys.text(key, text);
        const std::optional<Version> found = parse(text);
        if (found)
            version = *found;
        else if (!text.empty())
            wrong(key, "expected " + expected + ", found \"" + text + "\"");
    }

    void read_textures(std::vector<TextureName>& textures)
    {
        const char* const example = "[\"oak:board\"]";
        const std::vector<std::string> names = keys.texts("textures", example);
        demand("textures", "[\"oak:board\"], the texture board of oak.haptel");
        for (const std::string& name : names) {
            const std::size_t colon = name.find(':');
            const std::string file = name.substr(0, colon);
            if (colon == name.npos || !is_plain_name(std::string_view(name).substr(colon + 1)) || !is_file(file)) {
                wrong("textures", "expected a file, without .haptel, a colon and the name of a texture in it, such as "
                                  "\"oak:board\", found \"" +
                                      name + "\"");
                continue;
            }
            const TextureName texture{file, name.substr(colon + 1)};
            if (std::find(textures.begin(), textures.end(), texture) != textures.end())
                wrong("textures", "\"" + name + "\" is there twice: leave one out");
            else
                textures.push_back(texture);
        }
        if (keys.has("textures") && names.empty() && !messages.any_error())
            wrong("textures", "expected one texture or more, such as " + std::string(example));
    }

    // "board/pine": each part can stand in an import.
    static bool is_file(std::string_view file)
    {
        for (;; file.remove_prefix(file.find('/') + 1)) {
            if (!is_library_name(file.substr(0, file.find('/')))) return false;
            if (file.find('/') == file.npos) return true;
        }
    }

    void read_dependencies(Manifest& made)
    {
        const toml::table* table = keys.table("dependencies", "{ wood = \"1.2\" }");
        if (!table) return;
        for (const auto& [key, value] : *table) {
            const std::string name(key.str());
            const std::optional<Version> least =
                value.is_string() ? parse_least_version(*value.value<std::string_view>()) : std::nullopt;
            if (!is_library_name(name))
                messages.error(key.source(), "expected the name of a library, such as wood, found \"" + name + "\"");
            else if (name == made.name)
                messages.error(key.source(), "a library does not depend on itself: leave this line out");
            else if (!least)
                messages.error(value.source(), "expected the least version that will do, such as " + name +
                                                   " = \"1.2\", found " + input::kind_of(value));
            else
                made.dependencies.push_back({name, *least});
        }
    }

    void read_previews(Manifest& made)
    {
        const toml::table* table = keys.table("previews", "{ \"oak:board\" = 0.01 }");
        if (!table) return;
        for (const auto& [key, value] : *table) {
            const std::string_view name = key.str();
            const std::size_t colon = std::min(name.find(':'), name.size());
            const TextureName texture{std::string(name.substr(0, colon)),
                                      std::string(name.substr(std::min(colon + 1, name.size())))};
            const std::optional<double> size = value.is_number() ? value.value<double>() : std::nullopt;
            if (std::find(made.textures.begin(), made.textures.end(), texture) == made.textures.end())
                messages.error(key.source(), "expected one of `textures`, such as \"oak:board\", found \"" +
                                                 std::string(name) + "\"");
            else if (!size || !(*size >= preview_least_m && *size <= preview_greatest_m))
                messages.error(value.source(),
                               "expected how wide the picture is, 0.0001 .. 10 metres, such as 0.01, found " +
                                   input::kind_of(value));
            else
                made.previews.push_back({texture, *size});
        }
    }

    input::FileMessages& messages;
    input::KeyedTable keys;
};

} // namespace

Version haptel_version()
{
    return parse_version(HAPTEL_VERSION).value_or(Version{});
}

std::optional<Manifest> read_manifest(std::string_view text, input::FileMessages& messages)
{
    const std::optional<toml::table> root = input::parse_toml(text, messages);
    if (!root) return std::nullopt;
    Manifest made = ManifestReader(*root, messages).read();
    if (messages.any_error()) return std::nullopt;
    return made;
}

ManifestFile read_manifest_file(const std::filesystem::path& file)
{
    const input::FileBytes read = input::read_regular_file(file, manifest_bytes_max);
    if (read.refused.refusal != input::Refusal::none) return {{}, file.string() + " " + read.refused.why};
    input::FileMessages messages(file);
    std::optional<Manifest> manifest = read_manifest(read.bytes, messages);
    const std::string said = messages.text();
    return {std::move(manifest), said.substr(0, said.find('\n'))};
}

bool is_library_name(std::string_view text)
{
    return text.size() <= name_max && is_plain_name(text) &&
           std::none_of(text.begin(), text.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
}

std::string why_too_new(const Manifest& manifest)
{
    if (manifest.haptel_least > haptel_version())
        return "it needs Haptel " + to_text(manifest.haptel_least) + ", and this is " + to_text(haptel_version());
    if (manifest.language_least > language_version)
        return "it is written in version " + std::to_string(manifest.language_least) +
               " of the language, and this Haptel reads up to " + std::to_string(language_version);
    return {};
}

} // namespace haptel::libraries
