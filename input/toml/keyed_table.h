// Reads one table of a TOML file key by key and says what is wrong with it in terms of the file.
//
// The keys that were asked for are the keys that exist: whatever else the table holds is unknown and reported, with the
// nearest known key. Nothing here throws; a value that is missing or wrong leaves the default in place.
#pragma once

#include "input/toml/file_messages.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::input {

class KeyedTable {
public:
    // `name` as in the file: "[servo]", "[[object]]"; empty: the file itself.
    KeyedTable(const toml::table& table, std::string name, FileMessages& messages);

    bool has(std::string_view key);
    const toml::source_region& where(std::string_view key) const; // of its value; of the table where absent

    void text(std::string_view key, std::string& value);
    // A list of texts, none empty; of something else an error, told by an example.
    std::vector<std::string> texts(std::string_view key, std::string_view example);
    void yes_or_no(std::string_view key, bool& value);
    // The table there, or null if absent or something else, which is told by an example.
    const toml::table* table(std::string_view key, std::string_view example);
    void whole_number(std::string_view key, uint64_t& value);
    // One of the words; returns its place in `words`, or nothing if absent or wrong.
    std::optional<std::size_t> word(std::string_view key, const std::vector<std::string_view>& words);

    void report_unknown_keys();

protected:
    const toml::node* find(std::string_view key);

    const toml::table& table_;
    std::string name_;
    FileMessages& messages_;

private:
    std::vector<std::string> known_;
};

// A table of the file, or an empty one where it is absent or something else.
const toml::table& table_named(const toml::table& root, std::string_view name, FileMessages& messages);

// The candidate that `word` was probably meant to be, or nothing.
std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& candidates);

// "a", "a or b", "a, b or c"
std::string either_of(const std::vector<std::string_view>& words);

// A value as a message names it: text and numbers as written, else what it is.
std::string kind_of(const toml::node& node);

} // namespace haptel::input
