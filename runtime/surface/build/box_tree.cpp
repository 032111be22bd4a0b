// Splits the triangles in two again and again, until each part fits a node, where the surface area heuristic says: a
// query comes into a box as often as its surface is large (Goldsmith and Salmon 1987; Wald 2007 for the bins). Parts
// are cut at whole nodes of faces, so that nearly every node is full.
#include "runtime/surface/box_tree.h"

#include "runtime/surface/build/build.h"
#include "runtime/surface/in_parallel.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <vector>

namespace haptel::runtime {

namespace {

using Node = BoxTree::Node;
constexpr uint32_t width = BoxTree::width;
constexpr std::size_t bins = 16;

// Beyond this depth parts are halved, so that the tree ends, whatever the mesh.
constexpr uint32_t depth_of_halving = 24;

struct Box {
    glm::vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};

    void add(const Box& other)
    {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
    float half_area() const
    {
        const glm::vec3 size = high - low;
        return size.x >= 0 ? size.x * size.y + size.y * size.z + size.z * size.x : 0;
    }
};

struct Item { // a face
    Box box;
    uint32_t face;
    float twice_centre(int axis) const { return box.low[axis] + box.high[axis]; }
};

struct Part {
    std::span<Item> items;
    Box box, centres; // centres: twice them

    explicit Part(std::span<Item> those) : items(those)
    {
        for (const Item& item : items) {
            box.add(item.box);
            const glm::vec3 twice = item.box.low + item.box.high;
            centres.low = glm::min(centres.low, twice);
            centres.high = glm::max(centres.high, twice);
        }
    }
};

std::size_t whole_nodes(std::size_t items)
{
    return (items + width / 2) / width * width;
}

// How many go to the lower part.
std::size_t cut_of(const Part& part, int axis, bool halve)
{
    const std::size_t count = part.items.size(), half = std::max<std::size_t>(width, whole_nodes(count / 2));
    const float low = part.centres.low[axis], size = part.centres.high[axis] - low;
    if (halve || !(size > 0)) return half;
    const float per_size = float(bins) / size;
    std::array<Box, bins> box;
    std::array<std::size_t, bins> in{};
    for (const Item& item : part.items) {
        const auto bin = std::min<std::size_t>(bins - 1, std::size_t((item.twice_centre(axis) - low) * per_size));
        box[bin].add(item.box);
        ++in[bin];
    }
    std::array<float, bins> cost_above{}; // of those from this bin on
    Box above;
    std::size_t many = 0;
    for (std::size_t k = bins; k-- > 1;) {
        above.add(box[k]);
        cost_above[k] = above.half_area() * float(many += in[k]);
    }
    Box below;
    std::size_t cut = half;
    float least = std::numeric_limits<float>::infinity();
    many = 0;
    for (std::size_t k = 1; k < bins; ++k) {
        below.add(box[k - 1]);
        many += in[k - 1];
        const std::size_t whole = whole_nodes(many);
        const float cost = below.half_area() * float(many) + cost_above[k];
        if (whole == 0 || whole >= count || !(cost < least)) continue;
        least = cost;
        cut = whole;
    }
    return cut;
}

// Two of one that has more faces than fit a node.
std::pair<Part, Part> split(const Part& part, bool halve)
{
    const glm::vec3 spread = part.centres.high - part.centres.low;
    const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
    const std::size_t cut = cut_of(part, axis, halve);
    const auto key = [axis](const Item& item) { return std::pair(item.twice_centre(axis), item.face); };
    std::ranges::nth_element(part.items, part.items.begin() + std::ptrdiff_t(cut), {}, key);
    return {Part(part.items.first(cut)), Part(part.items.subspan(cut))};
}

// Up to eight of one: that with the largest surface is split first.
std::vector<Part> children_of(const Part& part, uint32_t depth)
{
    const bool halve = depth >= depth_of_halving;
    std::vector<Part> parts{part};
    while (parts.size() < width) {
        auto next = parts.end();
        float largest = -1;
        for (auto at = parts.begin(); at != parts.end(); ++at) {
            const float size = halve ? float(at->items.size()) : at->box.half_area();
            if (at->items.size() <= width || size <= largest) continue;
            largest = size;
            next = at;
        }
        if (next == parts.end()) break;
        auto [lower, upper] = split(*next, halve);
        *next = lower;
        parts.insert(next + 1, upper);
    }
    return parts;
}

void set(Node& node, std::size_t place, const Box& box, uint32_t child)
{
    for (int axis = 0; axis < 3; ++axis) {
        node.low[axis][place] = box.low[axis];
        node.high[axis][place] = box.high[axis];
    }
    node.child[place] = child;
}

Node empty_node()
{
    Node node;
    for (uint32_t k = 0; k < width; ++k) set(node, k, Box(), 0);
    return node;
}

// The node of a part, and behind it those below.
void add(const Part& part, uint32_t depth, std::vector<Node>& nodes)
{
    const std::size_t index = nodes.size();
    nodes.push_back(empty_node());
    if (part.items.size() <= width) {
        std::ranges::sort(part.items, {}, &Item::face);
        for (std::size_t k = 0; k < part.items.size(); ++k)
            set(nodes[index], k, part.items[k].box, part.items[k].face | BoxTree::is_face);
        return;
    }
    const std::vector<Part> parts = children_of(part, depth);
    for (std::size_t k = 0; k < parts.size(); ++k) {
        set(nodes[index], k, parts[k].box, uint32_t(nodes.size()));
        add(parts[k], depth + 1, nodes);
    }
}

// What is split before others can go on beside each other: whose child it is.
struct Waiting {
    Part part;
    uint32_t depth;
    std::size_t node, place;
};

} // namespace

std::vector<BoxTree::Node> box_tree_of(const std::vector<glm::dvec3>& vertices, const std::vector<Face>& faces,
                                       unsigned threads)
{
    std::vector<Item> items(faces.size());
    each_in_parallel(faces.size(), threads, [&](uint32_t f) {
        const auto& corners = faces[f].vertex;
        const glm::dvec3 &a = vertices[corners[0]], &b = vertices[corners[1]], &c = vertices[corners[2]];
        items[f] = {{glm::vec3(glm::min(a, glm::min(b, c)) * BoxTree::scale) - BoxTree::widening,
                     glm::vec3(glm::max(a, glm::max(b, c)) * BoxTree::scale) + BoxTree::widening},
                    f};
    });
    std::vector<Node> nodes;
    // The top, a storey at a time, then what hangs below it.
    std::vector<Waiting> storey{{Part(items), 0, 0, 0}}, below;
    while (!storey.empty()) {
        std::vector<Waiting> large;
        for (Waiting& waiting : storey)
            (waiting.part.items.size() > items_per_piece ? large : below).push_back(waiting);
        std::vector<std::vector<Part>> children(large.size());
        in_parallel(large.size(), threads,
                    [&](std::size_t i) { children[i] = children_of(large[i].part, large[i].depth); });
        storey.clear();
        for (std::size_t i = 0; i < large.size(); ++i) {
            const std::size_t index = nodes.size();
            nodes.push_back(empty_node());
            if (index > 0) set(nodes[large[i].node], large[i].place, large[i].part.box, uint32_t(index));
            for (std::size_t k = 0; k < children[i].size(); ++k)
                storey.push_back({children[i][k], large[i].depth + 1, index, k});
        }
    }
    std::vector<std::vector<Node>> hanging(below.size());
    in_parallel(below.size(), threads, [&](std::size_t i) { add(below[i].part, below[i].depth, hanging[i]); });
    std::size_t count = nodes.size();
    for (const std::vector<Node>& those : hanging) count += those.size();
    nodes.reserve(count);
    for (std::size_t i = 0; i < below.size(); ++i) {
        const auto first = uint32_t(nodes.size());
        if (first > 0) set(nodes[below[i].node], below[i].place, below[i].part.box, first);
        for (Node& node : hanging[i]) {
            for (uint32_t& child : node.child)
                if (child != 0 && !(child & BoxTree::is_face)) child += first;
            nodes.push_back(node);
        }
        hanging[i] = {};
    }
    return nodes;
}

} // namespace haptel::runtime
