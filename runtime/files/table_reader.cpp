#include "runtime/files/table_reader.h"

namespace haptel::runtime {

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

void TableReader::number(std::string_view key, glm::dvec3& value, Quantity quantity, const Range& range)
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

std::vector<const toml::table*> tables_of(const toml::table& root, std::string_view name, std::size_t most,
                                          std::string_view each, FileMessages& messages)
{
    std::vector<const toml::table*> tables;
    const toml::node* node = root.get(name);
    if (!node) return tables;
    const toml::array* list = node->as_array();
    const std::string one(name);
    if (!list || !list->is_array_of_tables())
        messages.error(node->source(),
                       "expected `[[" + one + "]]` in double brackets: a scene may hold several " + one + "s");
    else if (list->size() > most)
        messages.error((*list)[most].source(), "a scene may hold " + std::to_string(most) + " " + one + "s" +
                                                   std::string(each) + ", and this one has " +
                                                   std::to_string(list->size()) + ": leave some out");
    else
        for (const toml::node& table : *list) tables.push_back(table.as_table());
    return tables;
}

} // namespace haptel::runtime
