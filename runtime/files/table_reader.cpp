#include "runtime/files/table_reader.h"

#include "lang/text/near_name.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace haptel::runtime {

namespace {

std::string kind_of(const toml::node& node)
{
    switch (node.type()) {
    case toml::node_type::none: return "nothing";
    case toml::node_type::table: return "a table";
    case toml::node_type::array: return "a list";
    case toml::node_type::string: return "\"" + std::string(*node.value<std::string_view>()) + "\"";
    case toml::node_type::integer: return std::to_string(*node.value<int64_t>());
    case toml::node_type::floating_point: return shortest(*node.value<double>());
    case toml::node_type::boolean: return *node.value<bool>() ? "true" : "false";
    case toml::node_type::date:
    case toml::node_type::time:
    case toml::node_type::date_time: return "a date or time";
    }
    return "something else";
}

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

void FileMessages::write(toml::source_position at, std::string_view severity, const std::string& message)
{
    if (full()) {
        ++left_out_;
        return;
    }
    messages_.push_back(
        {at, place(at) + ": " + std::string(severity) + ": " +
                 (message.size() > message_bytes_max ? message.substr(0, message_bytes_max) + " ..." : message) +
                 "\n"});
}

std::string FileMessages::place(toml::source_position at) const
{
    if (file_.empty()) return at.line == 0 ? "scene" : "object " + std::to_string(at.line);
    return file_.string() + ":" + std::to_string(std::max<toml::source_index>(at.line, 1)) + ":" +
           std::to_string(std::max<toml::source_index>(at.column, 1));
}

std::string FileMessages::text() const
{
    std::vector<Message> sorted = messages_;
    std::stable_sort(sorted.begin(), sorted.end(), [](const Message& a, const Message& b) { return a.at < b.at; });
    std::string all;
    for (const Message& message : sorted) all += message.text;
    if (left_out_ > 0)
        all += place({}) + ": note: " + std::to_string(left_out_) +
               " more errors, warnings and notes are not shown: mend the first ones first\n";
    return all + added_;
}

void FileMessages::error(const toml::source_region& where, const std::string& message)
{
    ++errors_;
    write(where.begin, "error", message);
}

void FileMessages::error(const std::string& message)
{
    error(toml::source_region{}, message);
}

void FileMessages::warning(const toml::source_region& where, const std::string& message)
{
    write(where.begin, "warning", message);
}

void FileMessages::note(const toml::source_region& where, const std::string& message)
{
    write(where.begin, "note", message);
}

void FileMessages::add(std::string_view text)
{
    added_ += text;
    if (!added_.empty() && !added_.ends_with('\n')) added_ += '\n';
}

TableReader::TableReader(const toml::table& table, std::string name, FileMessages& messages)
    : table_(table), name_(std::move(name)), messages_(messages)
{
}

const toml::node* TableReader::find(std::string_view key)
{
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
    return table_.get(key);
}

bool TableReader::has(std::string_view key)
{
    return find(key) != nullptr;
}

const toml::source_region& TableReader::where(std::string_view key) const
{
    const toml::node* node = table_.get(key);
    return node ? node->source() : table_.source();
}

std::optional<double> TableReader::number_in(const toml::node& node, std::string_view key, Quantity quantity,
                                             const Range& range)
{
    std::optional<double> value;
    if (node.is_string())
        value = parse_quantity(*node.value<std::string_view>(), quantity);
    else if (const auto whole = node.value_exact<int64_t>())
        value = static_cast<double>(*whole); // also one with more digits than a double has
    else
        value = node.value_exact<double>();
    if (!value) {
        const std::string units = units_of(quantity);
        messages_.error(node.source(),
                        "expected " + std::string(description_of(quantity)) + " for `" + std::string(key) +
                            "`, found " + kind_of(node) +
                            (node.is_string() && !units.empty() ? " (units that fit: " + units + ")" : ""));
        return std::nullopt;
    }
    if (!range.holds(*value)) {
        messages_.error(node.source(), out_of_range(key, range, kind_of(node)));
        return std::nullopt;
    }
    return value;
}

void TableReader::number(std::string_view key, double& value, Quantity quantity, const Range& range)
{
    if (const toml::node* node = find(key)) value = number_in(*node, key, quantity, range).value_or(value);
}

void TableReader::three_numbers(std::string_view key, glm::dvec3& value, Quantity quantity, const Range& range)
{
    const toml::node* node = find(key);
    if (!node) return;
    const toml::array* list = node->as_array();
    if (!list || list->size() != 3) {
        messages_.error(node->source(), "expected three numbers, such as [0, 0, 0], for `" + std::string(key) +
                                            "`, found " +
                                            (list ? "a list of " + std::to_string(list->size()) : kind_of(*node)));
        return;
    }
    for (int i = 0; i < 3; ++i)
        value[i] = number_in((*list)[static_cast<std::size_t>(i)], key, quantity, range).value_or(value[i]);
}

Broken TableReader::broken()
{
    return [this](std::string_view key, const std::string& why) { messages_.error(where(key), why); };
}

void TableReader::text(std::string_view key, std::string& value)
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

void TableReader::yes_or_no(std::string_view key, bool& value)
{
    const toml::node* node = find(key);
    if (!node) return;
    if (const auto yes = node->value_exact<bool>())
        value = *yes;
    else
        messages_.error(node->source(),
                        "expected true or false for `" + std::string(key) + "`, found " + kind_of(*node));
}

const toml::table* TableReader::table(std::string_view key, std::string_view example)
{
    const toml::node* node = find(key);
    if (!node || node->is_table()) return node ? node->as_table() : nullptr;
    messages_.error(node->source(), "expected a table, such as `" + std::string(key) + " = " + std::string(example) +
                                        "`, found " + kind_of(*node));
    return nullptr;
}

void TableReader::whole_number(std::string_view key, uint64_t& value)
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

std::optional<std::size_t> TableReader::word(std::string_view key, const std::vector<std::string_view>& words)
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

std::vector<std::pair<std::string, std::string>> TableReader::values_as_written(std::string_view key)
{
    std::vector<std::pair<std::string, std::string>> values;
    const toml::node* node = find(key);
    if (!node) return values;
    const toml::table* table = node->as_table();
    if (!table) {
        messages_.error(node->source(), "expected names and values, such as { depth = \"60um\" }, for `" +
                                            std::string(key) + "`, found " + kind_of(*node));
        return values;
    }
    const auto as_written = [](const toml::node& value) -> std::optional<std::string> {
        if (value.is_string()) return *value.value<std::string>();
        if (value.is_number() || value.is_boolean()) return kind_of(value);
        return std::nullopt;
    };
    for (const auto& [name, value] : *table) {
        std::optional<std::string> text = as_written(value);
        if (const toml::array* list = value.as_array(); list && list->size() > 1) { // of a vector
            text = "";
            for (const toml::node& one : *list) {
                const std::optional<std::string> part = text ? as_written(one) : std::nullopt;
                text = part ? std::optional(*text + (&one == &list->front() ? "" : ", ") + *part) : std::nullopt;
            }
        }
        if (text)
            values.emplace_back(name.str(), std::move(*text));
        else
            messages_.error(value.source(),
                            "expected a number, true, false, text or, for a vector, a list of numbers for parameter `" +
                                std::string(name.str()) + "`, found " + kind_of(value));
    }
    return values;
}

void TableReader::report_unknown_keys()
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

} // namespace haptel::runtime
