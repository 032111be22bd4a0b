#include "runtime/files/mesh_surface.h"

#include "input/regular_file.h"
#include "runtime/files/mesh_file.h"
#include "runtime/files/surface_file.h"
#include "runtime/surface/shapes.h"

#include <algorithm>
#include <chrono>
#include <sstream>
#include <unistd.h>
#include <utility>
#include <vector>

namespace haptel::runtime {

namespace {

using input::Checksum;
using input::checksum;

constexpr const char* missing = "missing";

std::string sum_of_file(const std::filesystem::path& file)
{
    const input::FileBytes read = input::read_regular_file(file, mesh_bytes_max);
    return read.refused.refusal == input::Refusal::none ? to_text(checksum(read.bytes)) : missing;
}

// Nothing of a file that cannot be read now.
std::optional<std::string> key_text(const std::filesystem::path& file, double size_m, std::optional<double> crease_deg)
{
    const std::string sum = sum_of_file(file);
    if (sum == missing) return {};
    std::ostringstream key;
    key << std::hexfloat << file.extension().string() << ' ' << size_m << ' ' << crease_deg.value_or(-1) << ' ' << sum;
    return key.str();
}

// What is kept beside a surface: of reading the mesh its warning and whether its groups are off; then what other files
// were asked for, seen from the mesh's folder, and their checksums then. Each ends with a zero.
using Words = std::vector<std::string>;
constexpr std::size_t words_of_reading = 2;

Words words_in(const std::string& text)
{
    Words words;
    for (std::size_t begin = 0, end; (end = text.find('\0', begin)) != std::string::npos; begin = end + 1)
        words.push_back(text.substr(begin, end - begin));
    return words;
}

std::optional<MeshSurface> find(const std::filesystem::path& file, const Checksum& key, unsigned threads,
                                const input::KeptFiles& kept)
{
    const int descriptor = kept.open(to_text(key));
    if (descriptor < 0) return {};
    std::optional<KeptSurface> found = read_surface(descriptor, key, threads);
    close(descriptor);
    if (!found) return {};
    const Words words = words_in(found->text);
    if (words.size() < words_of_reading) return {};
    for (std::size_t k = words_of_reading; k + 1 < words.size(); k += 2)
        if (sum_of_file(file.parent_path() / words[k]) != words[k + 1]) return {};
    return MeshSurface{std::move(found->surface), found->report, {}, words[0], words[1] == "off"};
}

} // namespace

input::KeptFiles& kept_surfaces()
{
    static const std::filesystem::path folder = input::KeptFiles::folder_of_environment();
    static auto* kept =
        new input::KeptFiles(folder.empty() ? folder : folder / "surfaces", ".surface", kept_surfaces_bytes_max);
    return *kept;
}

MeshSurface surface_of_mesh_file(const std::filesystem::path& file, double size_m, std::optional<double> crease_deg,
                                 const Loading& loading, input::KeptFiles& kept, double keep_from_s)
{
    using Clock = std::chrono::steady_clock;
    std::optional<std::string> named;
    Checksum key;
    try {
        named = key_text(file, size_m, crease_deg);
        if (named) {
            key = checksum(*named);
            if (std::optional<MeshSurface> found = find(file, key, loading.threads, kept)) return std::move(*found);
        }
    } catch (const std::exception&) { // too little memory: what is kept saves time alone
        named.reset();
    }

    const Clock::time_point begin = Clock::now();
    const auto began = std::filesystem::file_time_type::clock::now();
    MeshFileResult read = load_mesh(file, std::nullopt, &loading);
    if (!read.error.empty()) return {nullptr, {}, read.error, {}};
    std::vector<uint32_t>& groups = read.mesh.smoothing_groups;
    if (crease_deg) groups.clear();
    const bool all_off =
        !groups.empty() && std::all_of(groups.begin(), groups.end(), [](uint32_t group) { return group == 0; });
    if (size_m > 0) scale_to_size(read.mesh, size_m);
    SurfaceResult built = build_surface(read.mesh, crease_deg.value_or(default_crease_deg), &loading);
    const std::chrono::duration<double> took = Clock::now() - begin;
    if (built.surface && named && took.count() >= keep_from_s) try {
            read.mesh = {};
            std::string words;
            const auto keep = [&](const std::string& word) { (words += word) += '\0'; };
            keep(read.warning);
            keep(all_off ? "off" : "");
            bool changes = false; // what is read is summed later: not of a file that changed meanwhile
            for (const std::string& other : words_in(read.other_files)) {
                std::error_code none;
                changes |= std::filesystem::last_write_time(file.parent_path() / other, none) >= began && !none;
                keep(other);
                keep(sum_of_file(file.parent_path() / other));
            }
            std::string room;
            const KeptSurface made{built.surface, built.report, std::move(words)};
            if (!changes && key_text(file, size_m, crease_deg) == named)
                kept.store(to_text(key), pieces_of_file(made, key, loading.threads, room));
        } catch (const std::exception&) {
        }
    return {std::move(built.surface), built.report, std::move(built.error), std::move(read.warning), all_off};
}

} // namespace haptel::runtime
