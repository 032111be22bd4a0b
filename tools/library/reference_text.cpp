// The reference as a list, a page for a person, JSON, and Markdown.
#include "tools/library/reference.h"

#include <algorithm>
#include <fmt/format.h>
#include <sstream>

namespace haptel::tools {

namespace {

std::string indented(const std::string& text)
{
    std::istringstream lines(text);
    std::string result;
    for (std::string line; std::getline(lines, line);) result += line.empty() ? "\n" : "    " + line + "\n";
    return result;
}

Json to_json(const std::optional<Facts>& facts)
{
    if (!facts) return nullptr;
    return {{"value_minimum", value_or_null(facts->value_minimum)},
            {"value_maximum", value_or_null(facts->value_maximum)},
            {"slope", value_or_null(facts->slope)},
            {"curvature", value_or_null(facts->curvature)},
            {"class", facts->continuity.empty() ? Json(nullptr) : Json(facts->continuity)}};
}

// Overloads in a row that share doc and facts.
template <typename Each>
void by_doc(const Entry& entry, Each each)
{
    for (size_t begin = 0; begin < entry.overloads.size();) {
        size_t end = begin + 1;
        const auto same = [&](const Overload& a, const Overload& b) {
            return a.doc == b.doc && (a.facts ? a.facts->text : "") == (b.facts ? b.facts->text : "");
        };
        while (end < entry.overloads.size() && same(entry.overloads[begin], entry.overloads[end])) ++end;
        each(begin, end);
        begin = end;
    }
}

// As an inequality in Markdown's eyes: "|x|" would end a cell of a table.
std::string escaped(std::string text)
{
    for (size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
    return text;
}

std::string replaced(std::string text, std::string_view from, std::string_view to)
{
    for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

// A signature of vec2, vec4, mat2 or mat4 that exists for vec3 or mat3 as well.
bool is_likewise(const Entry& entry, const std::string& signature)
{
    for (const char* size : {"2", "4"}) {
        const std::string three =
            replaced(replaced(signature, std::string("vec") + size, "vec3"), std::string("mat") + size, "mat3");
        for (const Overload& other : entry.overloads)
            if (three != signature && other.signature == three) return true;
    }
    return false;
}

std::string built_in_table(const std::vector<Entry>& entries)
{
    std::string page = "\n## Built-in functions\n\nThose of `vec3` and `mat3` are there for 2 and 4 likewise; angles "
                       "are in radians.\n\n"
                       "| function | what it is |\n|---|---|\n";
    for (const Entry& entry : entries) {
        if (entry.group != built_in_group) continue;
        by_doc(entry, [&](size_t begin, size_t end) {
            std::string signatures;
            for (size_t i = begin; i < end; ++i)
                if (!is_likewise(entry, entry.overloads[i].signature))
                    signatures += (signatures.empty() ? "`" : "<br>`") + entry.overloads[i].signature + "`";
            page += fmt::format("| {} | {} |\n", signatures, escaped(entry.overloads[begin].doc));
        });
    }
    return page;
}

} // namespace

Json to_json(const Entry& entry)
{
    Json overloads = Json::array();
    for (const Overload& overload : entry.overloads)
        overloads.push_back(
            {{"signature", overload.signature}, {"doc", overload.doc}, {"facts", to_json(overload.facts)}});
    return {{"name", entry.name},
            {"group", entry.group},
            {"overloads", std::move(overloads)},
            {"example", entry.example ? Json(entry.example->text) : Json(nullptr)}};
}

std::string to_list(const std::vector<Entry>& entries)
{
    size_t widest = 0;
    for (const Entry& entry : entries) widest = std::max(widest, entry.name.size());
    std::string list;
    std::string_view group;
    for (const Entry& entry : entries) {
        if (entry.group != group) list += fmt::format("{}{}\n", list.empty() ? "" : "\n", entry.group);
        group = entry.group;
        list += fmt::format("  {:<{}}  {}\n", entry.name, widest, entry.summary());
    }
    return list;
}

std::string to_text(const Entry& entry)
{
    std::string text;
    by_doc(entry, [&](size_t begin, size_t end) {
        if (begin > 0) text += "\n";
        for (size_t i = begin; i < end; ++i) text += entry.overloads[i].signature + "\n";
        text += indented(entry.overloads[begin].doc);
        if (const auto& facts = entry.overloads[begin].facts) text += "    facts: " + facts->text + "\n";
    });
    if (entry.example) text += "\nExample:\n" + indented(entry.example->text);
    text += entry.group == built_in_group ? "\nBuilt into the language.\n"
                                          : fmt::format("\nOf the standard library, stdlib/{}.haptel.\n", entry.group);
    return text;
}

std::string to_markdown(const std::vector<Entry>& entries)
{
    std::string page =
        "# The standard library\n\n"
        "Every texture sees these functions, without an import. `./dev docs` makes this page from the doc comments in\n"
        "`stdlib/`; `haptel info NAME` shows the same in a terminal. *Facts* hold for all arguments: the least and "
        "the\n"
        "greatest value; the slope, which is the greatest length of the gradient with respect to the first argument; "
        "the\n"
        "curvature, the greatest second derivative along any direction; and the class, how smooth the function is.\n"
        "Pictures are 30 mm wide.\n\n";
    std::string_view group;
    for (const Entry& entry : entries) {
        if (entry.group == built_in_group) break;
        if (entry.group != group) page += fmt::format("{}**{}**", group.empty() ? "" : " \\\n", entry.group);
        group = entry.group;
        page += fmt::format(" [`{}`](#{})", entry.name, entry.name);
    }
    page += "\n";
    group = {};
    for (const Entry& entry : entries) {
        if (entry.group == built_in_group) break;
        if (entry.group != group) page += fmt::format("\n## {}.haptel\n", entry.group);
        group = entry.group;
        page += fmt::format("\n### {}\n", entry.name);
        if (entry.example && entry.example->has_picture)
            page += fmt::format("\n![{0}](pictures/{1}/{2}.png)\n", entry.name, entry.example->file,
                                entry.example->texture);
        by_doc(entry, [&](size_t begin, size_t end) {
            page += "\n```glsl\n";
            for (size_t i = begin; i < end; ++i) page += entry.overloads[i].signature + "\n";
            page += "```\n\n" + entry.overloads[begin].doc + "\n";
            if (const auto& facts = entry.overloads[begin].facts) page += "\n*Facts:* " + facts->text + "\n";
        });
        if (entry.example) page += "\n*Example:*\n\n```glsl\n" + entry.example->text + "\n```\n";
    }
    return page + built_in_table(entries);
}

} // namespace haptel::tools
