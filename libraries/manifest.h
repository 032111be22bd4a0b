// library.toml: what a library says of itself.
//
// Read with care, since anybody may have written it; each mistake is told with its place, what was expected and how to
// mend it. docs/libraries.md explains the keys.
#pragma once

#include "input/toml/file_messages.h"
#include "lang/abi/language.h"
#include "libraries/version.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::libraries {

inline constexpr const char* manifest_name = "library.toml";
inline constexpr uint64_t schema_version = 1; // of library.toml
inline constexpr std::size_t manifest_bytes_max = 256u << 10;
Version haptel_version();

// "board/pine:bark": the texture bark of board/pine.haptel.
struct TextureName {
    std::string file, texture; // without ".haptel"
    bool operator==(const TextureName&) const = default;
};

struct Dependency {
    std::string name;
    Version least;
};

// How wide a texture's picture is.
struct PreviewSize {
    TextureName of;
    double window_m;
};

struct Manifest {
    std::string name, tagline, license;
    Version version;
    std::vector<std::string> authors, tags;
    std::vector<TextureName> textures;
    Version haptel_least;
    uint64_t language_least = 1; // of its files that do not say
    std::vector<Dependency> dependencies;
    std::vector<PreviewSize> previews; // of those whose size is said
};

// Nothing where `messages` has got an error.
std::optional<Manifest> read_manifest(std::string_view text, input::FileMessages& messages);

// The same of a file. `fault`: why there is none, or the first of its messages, a line.
struct ManifestFile {
    std::optional<Manifest> manifest;
    std::string fault;
};
ManifestFile read_manifest_file(const std::filesystem::path& file);

// As names behind "import": wood, board_games. Small letters, since some file systems do not tell them from capitals.
bool is_library_name(std::string_view text);

// Why this Haptel cannot use the library; empty: it can.
std::string why_too_new(const Manifest& manifest);

} // namespace haptel::libraries
