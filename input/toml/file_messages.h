// What is wrong with a TOML file, told by its places.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

namespace haptel::input {

// Messages about one file: "FILE:LINE:COLUMN: error: ...", one per line, in the order of the file. Of a file that is
// wrong all over the first ones are kept, none longer than a screen, and the others are counted. Without a file they
// are about a scene that a program made, whose lines are its objects: "object 2: error: ...", "scene: error: ...".
class FileMessages {
public:
    static constexpr std::size_t messages_max = 200, message_bytes_max = 2000;

    explicit FileMessages(std::filesystem::path file) : file_(std::move(file)) {}

    void error(const toml::source_region& where, const std::string& message);
    void error(const std::string& message); // about the file as a whole
    void warning(const toml::source_region& where, const std::string& message);
    void note(const toml::source_region& where, const std::string& message);
    void add(std::string_view text); // of somebody else, as it is, after all others

    bool any_error() const { return errors_ > 0; }
    std::size_t errors() const { return errors_; } // so far
    bool full() const { return messages_.size() >= messages_max; }
    std::string text() const;

private:
    struct Message {
        toml::source_position at;
        std::string text;
    };
    std::string place(toml::source_position at) const;
    void write(toml::source_position at, std::string_view severity, const std::string& message);

    std::filesystem::path file_;
    std::vector<Message> messages_;
    std::string added_;
    std::size_t errors_ = 0, left_out_ = 0;
};

} // namespace haptel::input
