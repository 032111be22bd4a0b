// A root of its own for commands about libraries: home, data and a working directory, nothing of the machine's.
#pragma once

#include "tests/support/catch.h"
#include "tests/tools/commands/run_command.h"
#include "tools/output/json.h"

#include <filesystem>
#include <map>
#include <string>

namespace haptel::test {

struct LibraryRoot {
    Folder folder;
    std::filesystem::path libraries = folder.path / "data" / "haptel" / "libraries", work = folder.path / "work";

    LibraryRoot() { std::filesystem::create_directories(work); }

    // In `work`, or a folder of it.
    Ran run(const std::string& arguments, const std::string& in = ".") const
    {
        return run_command(arguments, "cd '" + (work / in).string() + "' && env -u HAPTEL_PATH HOME='" +
                                          folder.file("") + "' XDG_DATA_HOME='" + folder.file("data") + "'");
    }
    tools::Json json(const std::string& arguments, const std::string& in = ".") const
    {
        const Ran ran = run(arguments + " --json", in);
        INFO(arguments << ": " << ran.out << ran.err);
        return tools::Json::parse(ran.out);
    }
    void write(const std::string& name, std::string_view text) const
    {
        std::filesystem::create_directories((work / name).parent_path());
        std::ofstream(work / name, std::ios::binary) << text;
    }
    // Bytes by path, of all files.
    std::map<std::string, std::string> state() const
    {
        std::map<std::string, std::string> files;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path))
            files[entry.path().lexically_relative(folder.path)] =
                entry.is_regular_file() ? read_file(entry.path()) : "(a folder)";
        return files;
    }
};

// The height at a point as eval prints it.
inline std::string height_of(const Ran& ran)
{
    INFO(ran.out << ran.err);
    CHECK(ran.code == 0);
    return ran.out.substr(0, ran.out.find('\n'));
}

// A library that packs, with a texture oak:board of this height in millimetres.
inline void write_library(const LibraryRoot& root, const std::string& folder, const std::string& name,
                          const std::string& version, const std::string& height_mm, const std::string& more = "")
{
    root.write(folder + "/library.toml", "schema = 1\nname = \"" + name + "\"\nversion = \"" + version +
                                             "\"\ntagline = \"For tests\"\nauthors = [\"A. Tester\"]\nlicense = "
                                             "\"CC0-1.0\"\ntextures = [\"oak:board\"]\n" +
                                             more);
    root.write(folder + "/oak.haptel",
               "/// Flat.\ntexture board(float height = " + height_mm + "mm in 0mm .. 9mm) { return height; }\n");
    root.write(folder + "/tests/oak.haptel",
               "import " + name +
                   ".oak as tested;\n\n/// It is flat.\ntexture board() { "
                   "return tested.board() - tested.board(p = p + vec3(1mm, 2mm, 3mm)); }\n");
}

} // namespace haptel::test
