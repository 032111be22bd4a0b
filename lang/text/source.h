// File text and places in it. Spans are bytes inside one file; lines and columns are made only when something is
// printed.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::lang {

// Half-open byte range [begin, end) of file `file` (index into SourceSet).
struct Span {
    uint32_t file = 0, begin = 0, end = 0;
    auto operator<=>(const Span&) const = default;
};

inline Span join(Span a, Span b)
{
    return {a.file, a.begin < b.begin ? a.begin : b.begin, a.end > b.end ? a.end : b.end};
}

// 1-based; columns count code points (an invalid byte counts as one).
struct Position {
    uint32_t line = 1, column = 1;
};

struct SourceFile {
    std::string name; // as shown in messages
    std::string text; // any bytes; need not be UTF-8
};

// Value of a byte that is no part of valid UTF-8.
inline constexpr char32_t invalid_code_point = 0xFFFFFFFF;

struct CodePoint {
    char32_t value = 0;
    uint32_t length = 1; // bytes; 1 for an invalid byte
};

// The code point that starts at byte `at` (< size) of `text`.
CodePoint decode_utf8(std::string_view text, size_t at);

// `text` as valid UTF-8 that is safe to print: invalid bytes, control characters (line ends too) and characters that
// change the writing direction become U+FFFD.
std::string printable(std::string_view text);

// The files of one compilation. Indices are stable. Those of the library are a set of their own, which compilations
// share: its files have the indices from `library_files` on.
class SourceSet {
public:
    static constexpr uint32_t library_files = 1 << 16;

    explicit SourceSet(uint32_t index_of_first = 0) : first(index_of_first) {}
    uint32_t add(SourceFile file);
    void share(std::shared_ptr<const SourceSet> library_set) { library = std::move(library_set); }
    bool has(uint32_t index) const { return find(index) != nullptr; }
    const SourceFile& file(uint32_t index) const { return find(index)->file; } // which it has
    std::string_view text(Span span) const;
    uint32_t line_of(uint32_t file, uint32_t byte) const; // its number
    Position position(uint32_t file, uint32_t byte) const;
    std::string_view line(uint32_t file, uint32_t line_number) const; // without its line end

private:
    struct Entry {
        SourceFile file;
        std::vector<uint32_t> line_starts;
    };
    uint32_t first;
    std::deque<Entry> entries;                // texts stay where they are
    std::shared_ptr<const SourceSet> library; // null: none

    const Entry* find(uint32_t index) const;
};

} // namespace haptel::lang
