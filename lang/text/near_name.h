// Which known word was most likely meant by one that is unknown. Header only, so that whoever reads a text may ask:
// the compiler, the command, the reader of scenes.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace haptel {

// Letters: nobody mistypes a longer name by a few. Bounds the work.
constexpr size_t near_name_max = 64;

// With transpositions (optimal string alignment). Upper and lower case are a quarter apart, a letter typed twice or
// once too few a half. Words longer than near_name_max are farther from each other than any word can be.
inline double edit_distance(std::string_view a, std::string_view b)
{
    if (a.size() > near_name_max || b.size() > near_name_max) return 2.0 * near_name_max;
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
    const auto change = [&](char x, char y) { return x == y ? 0.0 : lower(x) == lower(y) ? 0.25 : 1.0; };
    const auto skip = [](std::string_view text, size_t i) { return i > 1 && text[i - 1] == text[i - 2] ? 0.5 : 1.0; };
    std::array<std::array<double, near_name_max + 1>, 3> rows{}; // i % 3: this one and the two above
    for (size_t j = 1; j <= b.size(); ++j) rows[0][j] = rows[0][j - 1] + skip(b, j);
    for (size_t i = 1; i <= a.size(); ++i) {
        auto &row = rows[i % 3], &above = rows[(i + 2) % 3], &before = rows[(i + 1) % 3];
        row[0] = above[0] + skip(a, i);
        for (size_t j = 1; j <= b.size(); ++j) {
            row[j] =
                std::min({above[j] + skip(a, i), row[j - 1] + skip(b, j), above[j - 1] + change(a[i - 1], b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
    }
    return rows[a.size() % 3][b.size()];
}

struct NearName {
    std::string_view name; // empty: none is near enough to be meant
    bool is_only = false;  // none other may be meant: others are farther by far, and most letters are the same
};

inline NearName near_name(std::string_view name, const std::vector<std::string_view>& candidates)
{
    constexpr double hardly = 0.2; // one that is nearer by this is hardly likelier: a letter too many, or another one
    NearName best;
    double best_distance = std::max(1.0, static_cast<double>(name.size()) / 3) + 0.11, next_distance = near_name_max;
    for (const std::string_view candidate : candidates) {
        const size_t longer = std::max(name.size(), candidate.size()),
                     shorter = std::min(name.size(), candidate.size());
        const double keeps_length = longer > shorter ? 0.1 : 0; // as a slip does
        const double least = 0.5 * static_cast<double>(longer - shorter) + keeps_length;
        if (candidate == best.name || least > best_distance + hardly) continue;
        const double distance = edit_distance(name, candidate) + keeps_length;
        if (distance >= static_cast<double>(longer)) continue; // nothing is alike
        if (distance < best_distance) {
            if (!best.name.empty()) next_distance = best_distance;
            best.name = candidate;
            best_distance = distance;
        } else {
            next_distance = std::min(next_distance, distance);
        }
    }
    best.is_only = next_distance > best_distance + hardly && 2 * best_distance < static_cast<double>(name.size());
    return best;
}

} // namespace haptel
