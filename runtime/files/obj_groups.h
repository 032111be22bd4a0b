// Smoothing groups of an OBJ file, of which assimp does not tell. A file that has them is read from a text in which
// each of them is a material of its own, which assimp keeps apart; objects, groups and materials of the file do not
// matter here.
//
// Assimp takes time by the square of how many it keeps apart: of many of the file's own none are, and of many smoothing
// groups neither.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace haptel::runtime {

class ObjGroups {
public:
    static constexpr std::size_t parts_max = 1000;

    explicit ObjGroups(std::string_view file);

    bool needed() const { return found_ || parts_ > parts_max; } // text() in place of the file
    bool found() const { return found_ && !dropped_; }           // its materials are the groups
    bool dropped() const { return dropped_; }                    // there were too many
    const std::string& text() const { return text_; }

    // Of a material of the text: 0 for `off`, else one number per name.
    uint32_t group_of(const std::string& material);

private:
    void drop_groups();

    bool found_ = false, dropped_ = false;
    std::size_t parts_ = 0;
    std::string text_;
    std::map<std::string, uint32_t> numbers_;
};

} // namespace haptel::runtime
