// A scene to run `haptel explore` on, and what it leaves behind.
#pragma once

#include "tests/support/catch.h"
#include "tests/tools/commands/run_command.h"
#include "tools/output/json.h"

#include <sstream>
#include <string>
#include <vector>

namespace haptel::test {

inline constexpr const char* grooves = R"(
texture grooves(float pitch = 2mm in 0.5mm .. 5mm, float depth = 60um in 0um .. 200um)
{
    return depth * sin(6.283185307179586 * p.x / pitch);
}
)";

// A folder with a texture and a scene that touches it.
struct Stage {
    Folder folder;
    std::string scene;

    explicit Stage(const std::string& device = "", const std::string& object = "")
    {
        folder.write("grooves.haptel", grooves);
        scene = folder.write(
            "scene.toml",
            "[probe]\nkind = \"stylus\"\n[device]\n" + device +
                "\n[[object]]\nshape = \"icosphere\"\nsize_m = 0.1\ntexture = \"grooves.haptel:grooves\"\n" + object);
    }
    std::string out(const std::string& name) const { return folder.file(name); }
};

// The rows of a trace without the one column that is about time and not about touch.
inline std::vector<std::string> felt(const std::string& folder, const std::string& trace = "trace.csv")
{
    std::istringstream in(read_file(folder + "/" + trace));
    std::vector<std::string> rows;
    for (std::string line; std::getline(in, line);) {
        std::string row, cell;
        std::istringstream cells(line);
        for (int column = 0; std::getline(cells, cell, ','); ++column)
            if (column != 14) row += cell + ","; // compute_ns
        rows.push_back(row);
    }
    return rows;
}

inline tools::Json json_of(const Ran& ran)
{
    INFO(ran.out << ran.err);
    return tools::Json::parse(ran.out);
}

} // namespace haptel::test
