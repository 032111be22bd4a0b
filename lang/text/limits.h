// How much of what a text may hold. Whoever writes a texture comes nowhere near; what goes beyond is refused at its
// place, before it costs seconds. Stages that are linear need none of these; each says which stage is not.
#pragma once

#include <cstddef>
#include <cstdint>

namespace haptel::lang {

// Of a file, and of all that a program imports: texts are kept, for messages.
constexpr size_t text_bytes_max = 64u << 20;
// Words, numbers, signs and comments of a program with its imports. Trees take some hundred bytes for each.
constexpr size_t tokens_max = 1'000'000;
// Of a name, number or path: messages quote them.
constexpr size_t word_bytes_max = 4096;
constexpr size_t textures_max = 1'000; // of a file: each is differentiated, and bounded by `check`
// Functions of one name in one file: every call looks at all of them.
constexpr size_t overloads_max = 256;
// Of a function or a texture, in numbers, with the names of choices. What depends on which of them takes a bit for
// each value.
constexpr size_t parameters_max = 1'000;
// Variables of one body: every `if` and `for` asks what each of them is behind it.
constexpr size_t variables_max = 1'000;
// Functions and numbers that are bound to a function that is passed, and to those bound to it in turn: one that is
// bound to two others is there twice.
constexpr size_t bound_max = 1'000;
// IR instructions of a texture's body with all it calls, and of its entries once derivatives are made: machine code of
// one program takes about a tenth of a millisecond for each.
constexpr size_t instructions_max = 10'000, entry_instructions_max = 50'000;

} // namespace haptel::lang
