#include "runtime/contact/read_ahead.h"

namespace haptel::runtime {

namespace {

template <class Record>
void prefetch(const Record& record)
{
    const char* const first = reinterpret_cast<const char*>(&record);
    __builtin_prefetch(first);
    __builtin_prefetch(first + sizeof(Record) - 1); // it may lie across two lines, or three
    if constexpr (sizeof(Record) > 64) __builtin_prefetch(first + 64);
}

// The face that `to` leads to, and those beyond its other edges, `rings` times.
uint32_t read_from(const Surface& surface, const SideEdge& to, int rings)
{
    const Face& face = surface.faces[to.face()];
    for (size_t corner = 0; corner < 3; ++corner) {
        prefetch(surface.vertices[face.vertex[corner]]);
        prefetch(surface.shading_normal(face.fan_or_part[corner][to.side()]));
    }
    uint32_t seen = 1;
    if (rings == 0) return seen;
    for (const auto& link : face.link) prefetch(surface.faces[link[to.side()].face()]);
    for (uint32_t edge = 0; edge < 3; ++edge)
        if (edge != to.edge()) seen += read_from(surface, face.link[edge][to.side()], rings - 1);
    return seen;
}

} // namespace

uint32_t read_ahead(const Surface& surface, uint32_t face, uint32_t side) noexcept
{
    return read_from(surface, SideEdge(face, 3, side), 2); // from no edge: beyond all three
}

} // namespace haptel::runtime
