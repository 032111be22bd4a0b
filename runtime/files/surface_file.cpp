#include "runtime/files/surface_file.h"

#include "runtime/files/mesh_surface.h"
#include "runtime/surface/box_tree.h"
#include "runtime/surface/in_parallel.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <sys/stat.h>
#include <unistd.h>

namespace haptel::runtime {

extern const char code_version[];

namespace {

using input::Checksum;
using input::checksum;

constexpr std::size_t arrays = 8, block_bytes = 1 << 20;
constexpr uint64_t text_max = 1 << 20, count_max = uint64_t{1} << 32;

struct Head {
    char magic[16] = {'h', 'a', 'p', 't', 'e', 'l', ' ', 's', 'u', 'r', 'f', 'a', 'c', 'e', ' ', '1'};
    Checksum version, key;
    Checksum content; // of all else
    uint64_t text_bytes = 0, counts[arrays] = {};
    MeshReport report;
    Lattice lattice;
    glm::dvec3 box_minimum_m{0}, box_maximum_m{0};
    double normal_turn_max_per_m = 0;
    uint64_t cuts_itself = 0;
};

// Both ways: visit(number, array).
template <class SomeSurface, class Nodes, class Visit>
void for_each_array(SomeSurface& surface, Nodes& nodes, Visit&& visit)
{
    visit(0, surface.vertices);
    visit(1, surface.faces);
    visit(2, surface.fans);
    visit(3, surface.fan_parts);
    visit(4, surface.uv);
    visit(5, surface.uv_of);
    visit(6, surface.roundness);
    visit(7, nodes);
}

// Blocks of the arrays, each with its place in the file; summed up, and read before that, side by side.
struct Block {
    char* bytes;
    std::size_t size;
    uint64_t at;
};

template <class Array>
void add_blocks(Array& array, uint64_t& at, std::vector<Block>& blocks)
{
    auto* const bytes = const_cast<char*>(reinterpret_cast<const char*>(array.data()));
    const std::size_t size = array.size() * sizeof array[0];
    for (std::size_t done = 0; done < size; done += block_bytes)
        blocks.push_back({bytes + done, std::min(block_bytes, size - done), at + done});
    at += size;
}

bool read_all(int file, char* to, std::size_t size, uint64_t at)
{
    while (size > 0) {
        const ssize_t count = pread(file, to, size, static_cast<off_t>(at));
        if (count <= 0) return false; // cut short, or not to be read: then it is made anew
        to += count, at += uint64_t(count), size -= std::size_t(count);
    }
    return true;
}

Checksum sum_of(Head head, std::string_view text, const std::vector<Checksum>& of_blocks)
{
    head.content = {};
    const auto bytes = [](const auto* first, std::size_t count) {
        return std::string_view(reinterpret_cast<const char*>(first), count * sizeof *first);
    };
    return checksum(bytes(of_blocks.data(), of_blocks.size()), checksum(text, checksum(bytes(&head, 1))));
}

std::vector<Checksum> sums_of(const std::vector<Block>& blocks, unsigned threads)
{
    std::vector<Checksum> sums(blocks.size());
    in_parallel(blocks.size(), threads, [&](std::size_t i) { sums[i] = checksum({blocks[i].bytes, blocks[i].size}); });
    return sums;
}

} // namespace

std::vector<std::string_view> pieces_of_file(const KeptSurface& kept, const Checksum& key, unsigned threads,
                                             std::string& room)
{
    const Surface& surface = *kept.surface;
    Head head;
    head.version = checksum(code_version);
    head.key = key;
    head.text_bytes = kept.text.size();
    head.report = kept.report;
    head.lattice = surface.lattice;
    head.box_minimum_m = surface.box_minimum_m, head.box_maximum_m = surface.box_maximum_m;
    head.normal_turn_max_per_m = surface.normal_turn_max_per_m;
    head.cuts_itself = surface.cuts_itself;
    std::vector<std::string_view> pieces{{}, kept.text};
    std::vector<Block> blocks;
    uint64_t at = 0;
    for_each_array(surface, surface.tree->nodes(), [&](std::size_t number, const auto& array) {
        head.counts[number] = array.size();
        pieces.emplace_back(reinterpret_cast<const char*>(array.data()), array.size() * sizeof array[0]);
        add_blocks(array, at, blocks);
    });
    head.content = sum_of(head, kept.text, sums_of(blocks, threads));
    room.assign(reinterpret_cast<const char*>(&head), sizeof head);
    pieces[0] = room;
    return pieces;
}

std::optional<KeptSurface> read_surface(int file, const Checksum& key, unsigned threads)
{
    struct stat status = {};
    Head head;
    const Head expected;
    if (fstat(file, &status) != 0 || uint64_t(status.st_size) > kept_surfaces_bytes_max ||
        !read_all(file, reinterpret_cast<char*>(&head), sizeof head, 0))
        return {};
    if (std::memcmp(head.magic, expected.magic, sizeof head.magic) != 0 || head.key != key ||
        head.version != checksum(code_version) || head.text_bytes > text_max ||
        std::any_of(std::begin(head.counts), std::end(head.counts), [](uint64_t count) { return count > count_max; }))
        return {};

    auto surface = std::make_shared<Surface>();
    std::vector<BoxTree::Node> nodes;
    uint64_t size = sizeof head + head.text_bytes;
    for_each_array(*surface, nodes,
                   [&](std::size_t number, auto& array) { size += head.counts[number] * sizeof array[0]; });
    if (size != static_cast<uint64_t>(status.st_size)) return {}; // before memory is taken for it
    KeptSurface kept{nullptr, head.report, std::string(head.text_bytes, '\0')};
    if (!read_all(file, kept.text.data(), kept.text.size(), sizeof head)) return {};

    std::vector<Block> blocks;
    uint64_t at = sizeof head + head.text_bytes;
    for_each_array(*surface, nodes, [&](std::size_t number, auto& array) {
        array.resize(head.counts[number]);
        add_blocks(array, at, blocks);
    });
    std::atomic<bool> whole = true;
    std::vector<Checksum> sums(blocks.size());
    in_parallel(blocks.size(), threads, [&](std::size_t i) {
        if (!read_all(file, blocks[i].bytes, blocks[i].size, blocks[i].at)) whole = false;
        sums[i] = checksum({blocks[i].bytes, blocks[i].size});
    });
    if (!whole || sum_of(head, kept.text, sums) != head.content) return {};

    surface->lattice = head.lattice;
    surface->box_minimum_m = head.box_minimum_m, surface->box_maximum_m = head.box_maximum_m;
    surface->normal_turn_max_per_m = head.normal_turn_max_per_m;
    surface->cuts_itself = head.cuts_itself != 0;
    surface->tree = std::make_unique<const BoxTree>(surface->vertices, surface->faces, std::move(nodes), threads);
    kept.surface = std::move(surface);
    return kept;
}

} // namespace haptel::runtime
