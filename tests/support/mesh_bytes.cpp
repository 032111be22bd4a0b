#include "tests/support/mesh_bytes.h"

#include <array>
#include <cstdint>

namespace haptel::test {

namespace {

constexpr std::array<std::array<float, 3>, 6> points = {
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
constexpr std::array<std::array<uint16_t, 3>, 8> faces = {
    {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};

// The bytes of a number, least significant first, as on the machines that this runs on.
template <typename Number>
std::string bytes_of(Number number)
{
    return std::string(reinterpret_cast<const char*>(&number), sizeof number);
}

template <typename Number>
std::string binary(const auto& row)
{
    std::string bytes;
    for (const auto value : row) bytes += bytes_of(static_cast<Number>(value));
    return bytes;
}

template <typename Number>
std::string binary_rows(const auto& rows)
{
    std::string bytes;
    for (const auto& row : rows) bytes += binary<Number>(row);
    return bytes;
}

std::string words(const auto& numbers)
{
    std::string line;
    for (const auto number : numbers) line += " " + std::to_string(number);
    return line + "\n";
}

std::string obj()
{
    std::string text = "# octahedron\no one\n";
    for (const auto& point : points) text += "v" + words(point);
    for (const auto& point : points) text += "vt" + words(std::array{point[0], point[1]});
    for (std::size_t i = 0; i < faces.size(); ++i) {
        if (i % 4 == 0) text += i == 0 ? "s 1\n" : "s off\n";
        text += "f";
        for (const int corner : faces[i]) text += " " + std::to_string(corner + 1) + "/" + std::to_string(corner + 1);
        text += "\n";
    }
    return text;
}

std::string ply(bool text)
{
    std::string bytes = std::string("ply\nformat ") + (text ? "ascii" : "binary_little_endian") +
                        " 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\nelement face "
                        "8\nproperty list uchar int vertex_indices\nend_header\n";
    for (const auto& point : points) bytes += text ? words(point).substr(1) : binary<float>(point);
    for (const auto& face : faces) bytes += text ? "3" + words(face) : "\3" + binary<int32_t>(face);
    return bytes;
}

std::string off()
{
    std::string text = "OFF\n6 8 0\n";
    for (const auto& point : points) text += words(point).substr(1);
    for (const auto& face : faces) text += "3" + words(face);
    return text;
}

std::string stl(bool text)
{
    std::string bytes = text ? "solid octahedron\n" : std::string(80, '\0') + bytes_of(uint32_t(faces.size()));
    for (const auto& face : faces) {
        bytes += text ? "facet normal 0 0 1\nouter loop\n" : std::string(12, '\0');
        for (const int corner : face) bytes += text ? "vertex" + words(points[corner]) : binary<float>(points[corner]);
        bytes += text ? "endloop\nendfacet\n" : std::string(2, '\0');
    }
    return bytes + (text ? "endsolid octahedron\n" : "");
}

// A chunk of a 3DS file.
std::string chunk(uint16_t kind, const std::string& bytes)
{
    return bytes_of(kind) + bytes_of(static_cast<uint32_t>(6 + bytes.size())) + bytes;
}

std::string max_3ds()
{
    std::string indices = bytes_of(uint16_t(faces.size()));
    for (const auto& face : faces) indices += binary<uint16_t>(face) + bytes_of(uint16_t(7));
    const std::string mesh =
        chunk(0x4110, bytes_of(uint16_t(points.size())) + binary_rows<float>(points)) + chunk(0x4120, indices);
    return chunk(0x4d4d, chunk(0x3d3d, chunk(0x4000, std::string("one\0", 4) + chunk(0x4100, mesh))));
}

std::string collada()
{
    std::string positions, indices;
    for (const auto& point : points) positions += words(point);
    for (const auto& face : faces) indices += words(face);
    return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="18">)" +
           positions + R"(</float_array>
<technique_common><accessor source="#a" count="6" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="8"><input semantic="VERTEX" source="#v" offset="0"/><p>)" +
           indices + R"(</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";
}

std::string base64(const std::string& bytes)
{
    constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i + 3 <= bytes.size(); i += 3) { // what is written here is whole triples
        const uint32_t triple = static_cast<uint8_t>(bytes[i]) << 16 | static_cast<uint8_t>(bytes[i + 1]) << 8 |
                                static_cast<uint8_t>(bytes[i + 2]);
        for (const int shift : {18, 12, 6, 0}) text += letters[triple >> shift & 63];
    }
    return text;
}

std::string gltf(bool text)
{
    const std::string data = binary_rows<float>(points) + binary_rows<uint16_t>(faces); // 72 and 48 bytes
    std::string json =
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[)"
        R"({"bufferView":0,"componentType":5126,"count":6,"type":"VEC3","min":[-1,-1,-1],"max":[1,1,1]},)"
        R"({"bufferView":1,"componentType":5123,"count":24,"type":"SCALAR"}],)"
        R"("bufferViews":[{"buffer":0,"byteLength":72},{"buffer":0,"byteOffset":72,"byteLength":48}],)"
        R"("buffers":[{"byteLength":120)" +
        (text ? R"(,"uri":"data:application/octet-stream;base64,)" + base64(data) + "\"}]}" : "}]}");
    if (text) return json;
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const auto part = [](const char* kind, const std::string& bytes) {
        return bytes_of(static_cast<uint32_t>(bytes.size())) + std::string(kind, 4) + bytes;
    };
    const std::string parts = part("JSON", json) + part("BIN\0", data);
    return "glTF" + bytes_of(uint32_t(2)) + bytes_of(static_cast<uint32_t>(12 + parts.size())) + parts;
}

} // namespace

std::vector<MeshBytes> octahedron_files()
{
    return {{".obj", obj()},       {".ply", ply(true)},  {".ply", ply(false)}, {".off", off()},
            {".stl", stl(true)},   {".stl", stl(false)}, {".3ds", max_3ds()},  {".dae", collada()},
            {".gltf", gltf(true)}, {".glb", gltf(false)}};
}

} // namespace haptel::test
