// How long it takes from text to code: examples as people write them, and texts of every length.
#pragma once

#include "bench/timing.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace haptel::bench {

// From text to a callable entry, as a scene asks for it (height and gradient, a draft that better code replaces soon).
// Each time the text is another one: a constant of it was edited.
struct CompileRow {
    std::string texture;
    uint32_t lines = 0;
    Times front_end;      // text to checked, differentiated, verified IR
    Times warm;           // to code, in a process that has compiled before
    Times binding;        // what is proven and found about it over an object of 0.2 m, before a hand gets it
    Times felt;           // both: from a saved text to what a hand feels
    double first_ms = 0;  // to code, first of all in a fresh process, with nothing on disk
    double primed_ms = 0; // the same where the library's functions are on disk, as after a build
    double cached_ms = 0; // the same where the text was felt before: its own code is on disk, too
};

// Milliseconds to code in a process of its own that has compiled nothing yet, with that folder for code on disk: what
// first_compile() returns there. Nothing where no process can be had.
using FreshProcess =
    std::function<std::optional<double>(const std::string& texture, uint32_t edit, const std::string& cache_folder)>;

struct Text {
    std::string name, text;
};

// Interleaved: every texture is measured once per round.
std::vector<CompileRow> bench_compile(bool quick, const FreshProcess& fresh_process);

// Of somebody's texts, each to its last texture, which returns what is edited; in this process alone. Throws
// std::runtime_error with what the compiler says of one that does not compile or bind.
std::vector<CompileRow> bench_edits(const std::vector<Text>& texts, bool quick);

// Compiles one of bench_compile()'s textures, and has its code of full effort kept on disk as a session of exploring
// does. Milliseconds to the first code; nothing if there is no such texture.
std::optional<double> first_compile(const std::string& texture, uint32_t edit);

// Of the texts of many lengths: time per line beyond the shortest, of the longest over that of the second shortest: 1
// where time grows in proportion.
double growth(const std::vector<CompileRow>& rows, Times CompileRow::* times);

} // namespace haptel::bench
