// A table of a scene: one of any TOML file (input/toml/keyed_table.h), and numbers with units.
#pragma once

#include "input/toml/keyed_table.h"
#include "runtime/files/quantity.h"
#include "runtime/scene/validation.h"

#include <glm/glm.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace haptel::runtime {

using input::either_of, input::FileMessages, input::kind_of, input::nearest_word, input::table_named;

class TableReader : public input::KeyedTable {
public:
    using KeyedTable::KeyedTable;

    void number(std::string_view key, double& value, Quantity quantity, const Range& range);
    void number(std::string_view key, glm::dvec3& value, Quantity quantity, const Range& range); // three of them
    // A visitor of the fields in scene_fields.h: reads each.
    auto fields()
    {
        return [this](std::string_view key, auto& value, Quantity quantity, const Range& range) {
            number(key, value, quantity, range);
        };
    }
    // What tells the rule between figures that is broken where the figure is written.
    Broken broken();
    // Names and values as written, in the order of the file's names.
    std::vector<std::pair<std::string, std::string>> values_as_written(std::string_view key);

private:
    std::optional<double> number_in(const toml::node& node, std::string_view key, Quantity, const Range&);
};

// Those of `[[name]]`; none where something else is written, or more than `most`, which is told. `each`: what each
// costs.
std::vector<const toml::table*> tables_of(const toml::table& root, std::string_view name, std::size_t most,
                                          std::string_view each, FileMessages& messages);

} // namespace haptel::runtime
