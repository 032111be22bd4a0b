#include "runtime/files/obj_groups.h"

#include <algorithm>
#include <set>
#include <sstream>
#include <utility>

namespace haptel::runtime {

namespace {

constexpr std::string_view opening = "usemtl smoothing ", off = "off";

// With their ends.
template <class Visit>
void for_each_line(std::string_view text, Visit&& visit)
{
    while (!text.empty()) {
        const std::string_view line = text.substr(0, std::min(text.find('\n'), text.size() - 1) + 1);
        text.remove_prefix(line.size());
        visit(line);
    }
}

std::string group_line(std::string_view name)
{
    return std::string(opening).append(name).append("\n");
}

} // namespace

ObjGroups::ObjGroups(std::string_view file)
{
    std::set<std::string> names;
    text_ = group_line(off);
    for_each_line(file, [&](std::string_view line) {
        if (line.find_first_of("sumog") != line.find_first_not_of(" \t")) { // most of a large file, as it is
            text_ += line;
            return;
        }
        std::istringstream words{std::string(line)};
        std::string first, second;
        words >> first >> second;
        if (first == "s" && !second.empty()) {
            found_ = true;
            if (names.size() <= parts_max) names.insert(second);
            text_ += group_line(second == "0" ? off : second);
        } else if (first == "usemtl" || first == "mtllib" || first == "o" || first == "g") {
            ++parts_;
        } else {
            text_ += line;
        }
    });
    if (!text_.ends_with('\n')) text_ += '\n';
    if (names.size() > parts_max) drop_groups();
}

void ObjGroups::drop_groups()
{
    std::string kept;
    kept.reserve(text_.size());
    for_each_line(text_, [&](std::string_view line) {
        if (!line.starts_with(opening)) kept += line;
    });
    text_ = std::move(kept);
    dropped_ = true;
}

uint32_t ObjGroups::group_of(const std::string& material)
{
    const std::string_view prefix = opening.substr(std::string_view("usemtl ").size());
    if (material == std::string(prefix).append(off)) return 0;
    return numbers_.try_emplace(material, static_cast<uint32_t>(numbers_.size() + 1)).first->second;
}

} // namespace haptel::runtime
