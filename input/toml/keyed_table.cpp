#include "input/toml/keyed_table.h"

#include "lang/text/near_name.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace haptel::input {

namespace {

// To `key` as it is or without its unit, or whatever else follows a `_`: "stifness" is one letter from
// "stiffness_n_per_m".
double distance_to(std::string_view word, std::string_view key)
{
    double smallest = edit_distance(word, key);
    for (std::size_t end = key.find('_'); end != key.npos; end = key.find('_', end + 1))
        smallest = std::min(smallest, edit_distance(word, key.substr(0, end)));
    return smallest;
}

} // namespace

const toml::table& table_named(const toml::table& root, std::string_view name, FileMessages& messages)
{
    static const toml::table none;
    const toml::node* node = root.get(name);
    if (!node) return none;
    if (const toml::table* table = node->as_table()) return *table;
    messages.error(node->source(),
                   "expected a table: write `[" + std::string(name) + "]` on a line of its own, its keys below");
    return none;
}

std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& candidates)
{
    constexpr std::size_t word_max = 64; // no name is as long, and the search takes time by its length
    std::optional<std::string> nearest;
    if (word.size() > word_max) return nearest;
    double smallest = static_cast<double>(std::max<std::size_t>(1, word.size() / 3)) + 0.01; // as near, or nearer
    for (const std::string& candidate : candidates) {
        // A key without its unit is the most common slip of all: "stiffness" for "stiffness_n_per_m".
        const bool lacks_unit = word.size() >= 3 && candidate.starts_with(word);
        const double distance = lacks_unit ? 1 : distance_to(word, candidate);
        if (distance < smallest) {
            smallest = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

std::string either_of(const std::vector<std::string_view>& words)
{
    std::string list;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) list += i + 1 == words.size() ? " or " : ", ";
        list.append("\"").append(words[i]).append("\"");
    }
    return list;
}

std::string kind_of(const toml::node& node)
{
    switch (node.type()) {
    case toml::node_type::none: return "nothing";
    case toml::node_type::table: return "a table";
    case toml::node_type::array: return "a list";
    case toml::node_type::string: return "\"" + std::string(*node.value<std::string_view>()) + "\"";
    case toml::node_type::integer: return std::to_string(*node.value<int64_t>());
    case toml::node_type::floating_point: {
        std::array<char, 32> digits; // those that tell the number from its neighbours
        const auto [end, error] = std::to_chars(digits.begin(), digits.end(), *node.value<double>());
        return error == std::errc() ? std::string(digits.begin(), end) : "a number";
    }
    case toml::node_type::boolean: return *node.value<bool>() ? "true" : "false";
    case toml::node_type::date:
    case toml::node_type::time:
    case toml::node_type::date_time: return "a date or time";
    }
    return "something else";
}

KeyedTable::KeyedTable(const toml::table& table, std::string name, FileMessages& messages)
    : table_(table), name_(std::move(name)), messages_(messages)
{
}

const toml::node* KeyedTable::find(std::string_view key)
{
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
    return table_.get(key);
}

bool KeyedTable::has(std::string_view key)
{
    return find(key) != nullptr;
}

const toml::source_region& KeyedTable::where(std::string_view key) const
{
    const toml::node* node = table_.get(key);
    return node ? node->source() : table_.source();
}

void KeyedTable::text(std::string_view key, std::string& value)
{
    const toml::node* node = find(key);
    if (!node) return;
    const auto text = node->value<std::string_view>();
    if (node->is_string() && text->empty())
        messages_.error(node->source(), "`" + std::string(key) + "` is empty: name something, or leave the key out");
    else if (!node->is_string())
        messages_.error(node->source(),
                        "expected text in quotes for `" + std::string(key) + "`, found " + kind_of(*node));
    else
        value = *text;
}

std::vector<std::string> KeyedTable::texts(std::string_view key, std::string_view example)
{
    std::vector<std::string> values;
    const toml::node* node = find(key);
    if (!node) return values;
    const toml::array* list = node->as_array();
    const bool is_of_texts = list && std::all_of(list->begin(), list->end(), [](const toml::node& one) {
                                 return one.is_string() && !one.value<std::string_view>()->empty();
                             });
    if (!is_of_texts) {
        messages_.error(node->source(), "expected a list of texts, such as " + std::string(example) + ", for `" +
                                            std::string(key) + "`, found " +
                                            (list ? "one that holds something else" : kind_of(*node)));
        return values;
    }
    for (const toml::node& one : *list) values.push_back(*one.value<std::string>());
    return values;
}

void KeyedTable::yes_or_no(std::string_view key, bool& value)
{
    const toml::node* node = find(key);
    if (!node) return;
    if (const auto yes = node->value_exact<bool>())
        value = *yes;
    else
        messages_.error(node->source(),
                        "expected true or false for `" + std::string(key) + "`, found " + kind_of(*node));
}

const toml::table* KeyedTable::table(std::string_view key, std::string_view example)
{
    const toml::node* node = find(key);
    if (!node || node->is_table()) return node ? node->as_table() : nullptr;
    messages_.error(node->source(), "expected a table, such as `" + std::string(key) + " = " + std::string(example) +
                                        "`, found " + kind_of(*node));
    return nullptr;
}

void KeyedTable::whole_number(std::string_view key, uint64_t& value)
{
    const toml::node* node = find(key);
    if (!node) return;
    const auto number = node->value_exact<int64_t>();
    if (!number || *number < 0)
        messages_.error(node->source(),
                        "expected a whole number from 0 on for `" + std::string(key) + "`, found " + kind_of(*node));
    else
        value = static_cast<uint64_t>(*number);
}

std::optional<std::size_t> KeyedTable::word(std::string_view key, const std::vector<std::string_view>& words)
{
    const toml::node* node = find(key);
    if (!node) return std::nullopt;
    if (const auto text = node->value_exact<std::string_view>()) {
        const auto found = std::find(words.begin(), words.end(), *text);
        if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
    }
    messages_.error(node->source(),
                    "expected " + either_of(words) + " for `" + std::string(key) + "`, found " + kind_of(*node));
    return std::nullopt;
}

void KeyedTable::report_unknown_keys()
{
    for (const auto& [key, value] : table_) {
        if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
        if (messages_.full()) { // whatever would be said
            messages_.error(key.source(), "");
            continue;
        }
        const std::string in = name_.empty() ? "" : " in " + name_;
        if (const auto meant = nearest_word(key.str(), known_)) {
            messages_.error(key.source(),
                            "unknown key `" + std::string(key.str()) + "`" + in + ": did you mean `" + *meant + "`?");
        } else {
            std::string all;
            for (const std::string& known : known_) all += (all.empty() ? "" : ", ") + known;
            messages_.error(key.source(), "unknown key `" + std::string(key.str()) + "`" + in + ": it may hold " + all);
        }
    }
}

} // namespace haptel::input
