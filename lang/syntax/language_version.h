// Texts that were written for another version of the language.
//
// A Haptel reads one version. What a later version takes away stands in a table, with what is written since, and
// `haptel fmt --upgrade` makes texts of any earlier version texts of the present one.
#pragma once

#include "lang/abi/language.h"
#include "lang/text/diagnostic.h"

#include <span>
#include <vector>

namespace haptel::lang {

// The name of a function, constant or input, which has another since that version.
struct Renamed {
    uint32_t since;
    std::string_view before, now;
};
// From the oldest version to the newest. Nothing has been renamed yet: version 1 is the first.
inline constexpr std::span<const Renamed> renamed_words{};

// Why a Haptel of that version does not read a text that asks for `number`, as it is written there. No message: it
// does.
struct VersionFault {
    std::string message, hint;
};
VersionFault fault_of_version(std::string_view number, uint32_t present = language_version);

// What makes a text of version `from` one of version `to`, from its beginning on: names, and the line that says which
// version it is. `line`: the number in that line; empty: there is none. Words that the text itself declares are its
// own.
std::vector<FixIt> upgrades(const SourceSet& sources, uint32_t file, Span line, uint32_t from,
                            uint32_t to = language_version, std::span<const Renamed> renamed = renamed_words);

} // namespace haptel::lang
