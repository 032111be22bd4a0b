// A folder of its own for a test, gone with it.
#pragma once

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <unistd.h>

namespace haptel::test {

struct Folder {
    std::filesystem::path path;

    Folder()
    {
        static std::atomic<int> count = 0;
        path = std::filesystem::temp_directory_path() /
               ("haptel-test-" + std::to_string(getpid()) + "-" + std::to_string(count++));
        std::filesystem::create_directories(path);
    }
    ~Folder() { std::filesystem::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::string file(const std::string& name) const { return (path / name).string(); }
    std::string write(const std::string& name, std::string_view text) const
    {
        std::ofstream(path / name, std::ios::binary) << text;
        return file(name);
    }
    // As most editors save: a new file takes the old one's name.
    void replace(const std::string& name, std::string_view text) const
    {
        write(name + "~", text);
        std::filesystem::rename(path / (name + "~"), path / name);
    }
};

} // namespace haptel::test
