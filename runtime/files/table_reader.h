// Reads one table of a TOML file key by key and says what is wrong with it in terms of the file.
//
// The keys that were asked for are the keys that exist: whatever else the table holds is unknown and reported, with the
// nearest known key. Nothing here throws; a value that is missing or wrong leaves the default in place.
#pragma once

#include "runtime/files/quantity.h"
#include "runtime/scene/validation.h"

#include <glm/glm.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <toml++/toml.h>

namespace haptel::runtime {

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

class TableReader {
public:
    // `name` as in the file: "[servo]", "[[object]]".
    TableReader(const toml::table& table, std::string name, FileMessages& messages);

    bool has(std::string_view key);
    const toml::source_region& where(std::string_view key) const; // of its value; of the table where absent

    void number(std::string_view key, double& value, Quantity quantity, const Range& range);
    void three_numbers(std::string_view key, glm::dvec3& value, Quantity quantity, const Range& range);
    // A visitor of the fields in scene_fields.h: reads each.
    auto fields()
    {
        return [this](std::string_view key, auto& value, Quantity quantity, const Range& range) {
            if constexpr (std::is_same_v<decltype(value), double&>)
                number(key, value, quantity, range);
            else
                three_numbers(key, value, quantity, range);
        };
    }
    // What tells the rule between figures that is broken where the figure is written.
    Broken broken();
    void text(std::string_view key, std::string& value);
    void yes_or_no(std::string_view key, bool& value);
    // The table there, or null if absent or something else, which is told by an example.
    const toml::table* table(std::string_view key, std::string_view example);
    void whole_number(std::string_view key, uint64_t& value);
    // One of the words; returns its place in `words`, or nothing if absent or wrong.
    std::optional<std::size_t> word(std::string_view key, const std::vector<std::string_view>& words);
    // Names and values as written, in the order of the file's names.
    std::vector<std::pair<std::string, std::string>> values_as_written(std::string_view key);

    void report_unknown_keys();

private:
    const toml::node* find(std::string_view key);
    std::optional<double> number_in(const toml::node& node, std::string_view key, Quantity, const Range&);

    const toml::table& table_;
    std::string name_;
    FileMessages& messages_;
    std::vector<std::string> known_;
};

// A table of the scene, or an empty one where it is absent or something else.
const toml::table& table_named(const toml::table& root, std::string_view name, FileMessages& messages);

// The candidate that `word` was probably meant to be, or nothing.
std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& candidates);

// "a", "a or b", "a, b or c"
std::string either_of(const std::vector<std::string_view>& words);

} // namespace haptel::runtime
