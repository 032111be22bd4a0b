#include "runtime/files/mesh_process.h"
#include "runtime/files/table_reader.h"

#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <exception>
#include <fstream>
#include <limits>
#include <map>
#include <new>
#include <optional>
#include <sstream>
#include <system_error>

namespace haptel::runtime {

namespace {

// Assimp reads some forty formats, many of them rarely tested; these are the ones people have.
constexpr std::array<std::string_view, 8> extensions = {".obj", ".ply", ".stl",  ".off",
                                                        ".3ds", ".dae", ".gltf", ".glb"};

std::string lower_case(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

void append(Mesh& mesh, const aiMesh& part, bool with_uv)
{
    const std::size_t first = mesh.positions_m.size();
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
        const aiVector3D& p = part.mVertices[i];
        mesh.positions_m.emplace_back(p.x, p.y, p.z);
        if (with_uv) mesh.uv.emplace_back(part.mTextureCoords[0][i].x, part.mTextureCoords[0][i].y);
    }
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
        const aiFace& face = part.mFaces[i];
        if (face.mNumIndices != 3) continue;
        std::array<uint32_t, 3> triangle;
        for (unsigned corner = 0; corner < 3; ++corner)
            triangle[corner] = face.mIndices[corner] < part.mNumVertices
                                   ? static_cast<uint32_t>(first + face.mIndices[corner])
                                   : std::numeric_limits<uint32_t>::max(); // out of range stays so: it is counted when
                                                                           // the surface is built
        mesh.triangles.push_back(triangle);
    }
}

// Listens to what assimp says of vertex indices while one file is read: some of its readers put another vertex in the
// place of one that does not exist, and only log it. The log is assimp's one of the process: a logger that the program
// has made itself stays.
class IndexListener final : public Assimp::LogStream {
public:
    IndexListener() : own_logger_(Assimp::DefaultLogger::isNullLogger())
    {
        if (own_logger_) Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
        Assimp::DefaultLogger::get()->attachStream(this, severities);
    }
    ~IndexListener() override
    {
        Assimp::DefaultLogger::get()->detachStream(this, severities);
        if (own_logger_) Assimp::DefaultLogger::kill();
    }

    void write(const char* message) override
    {
        const std::string text = message; // "Error, T0: OFF: Vertex index is out of range"
        if (!heard_.empty() || lower_case(text).find("vertex index") == std::string::npos) return;
        const std::size_t prefix = text.find(": ");
        heard_ = prefix == std::string::npos ? text : text.substr(prefix + 2);
        while (!heard_.empty() && std::isspace(static_cast<unsigned char>(heard_.back()))) heard_.pop_back();
    }
    const std::string& heard() const { return heard_; } // the first one; empty: none

private:
    static constexpr unsigned severities = Assimp::Logger::Warn | Assimp::Logger::Err;

    bool own_logger_;
    std::string heard_;
};

// What assimp does not tell of an OBJ file. A file with smoothing groups is read with each of them as a material of its
// own, which it keeps apart; objects, groups and materials of the file do not matter here.
class ObjGroups {
public:
    static constexpr std::string_view prefix = "smoothing ";

    explicit ObjGroups(const std::filesystem::path& file)
    {
        std::ifstream in(file, std::ios::binary);
        text_ = "usemtl " + std::string(prefix) + "off\n";
        for (std::string line; std::getline(in, line);) {
            line += '\n';
            if (line.find_first_of("sumog") != line.find_first_not_of(" \t")) { // most of a large file, as it is
                text_ += line;
                continue;
            }
            std::istringstream words(line);
            std::string first, second;
            words >> first >> second;
            if (first == "s" && !second.empty()) {
                found_ = true;
                text_ += "usemtl " + std::string(prefix) + (second == "0" ? "off" : second) + "\n";
            } else if (first != "usemtl" && first != "mtllib" && first != "o" && first != "g") {
                text_ += line;
            }
        }
    }

    bool found() const { return found_; }
    const std::string& text() const { return text_; }

    // Of a part that was read from the text: 0 for `off`, else one number per name.
    uint32_t group_of(const aiScene& scene, const aiMesh& part)
    {
        aiString name;
        scene.mMaterials[part.mMaterialIndex]->Get(AI_MATKEY_NAME, name);
        const std::string group = name.C_Str();
        if (group == std::string(prefix) + "off") return 0;
        return numbers_.try_emplace(group, static_cast<uint32_t>(numbers_.size() + 1)).first->second;
    }

private:
    bool found_ = false;
    std::string text_;
    std::map<std::string, uint32_t> numbers_;
};

// Coordinates come from assimp as 32-bit numbers, also where the file has more digits: far from the origin that is
// coarse. Of the vertices that triangles use, in the file's units.
std::string warning_of_rounding(const Mesh& mesh)
{
    constexpr double tolerable = 1e-5; // of its size: 1 um of 10 cm
    glm::dvec3 minimum(std::numeric_limits<double>::infinity()), maximum = -minimum;
    for (const auto& triangle : mesh.triangles)
        for (const uint32_t corner : triangle) {
            if (corner >= mesh.positions_m.size()) continue;
            minimum = glm::min(minimum, mesh.positions_m[corner]);
            maximum = glm::max(maximum, mesh.positions_m[corner]);
        }
    const auto largest = [](const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); };
    const double size = largest(maximum - minimum), farthest = largest(glm::max(maximum, -minimum));
    const double rounding = std::ldexp(farthest, -std::numeric_limits<float>::digits);
    if (!(rounding > tolerable * size && std::isfinite(farthest))) return {};
    std::ostringstream text;
    text.precision(3);
    text << "its coordinates are read as 32-bit numbers, and as far from the origin as " << farthest
         << " they are rounded by up to " << rounding << "; its size is only " << size / rounding
         << " times that: move the model to the origin before it is exported";
    return text.str();
}

const std::string unreadable = "the file could not be read: ",
                  no_triangle = "the file holds no triangle: points or lines only, or it is cut off before its faces";

MeshFileResult failed(std::string why)
{
    MeshFileResult result;
    result.error = std::move(why);
    return result;
}

// A machine that is slow, and a build that checks everything, read a megabyte in this time.
constexpr double processor_s_per_byte = 1e-6, processor_s_min = 10;

MeshReadLimits limits_for(std::uintmax_t size_bytes)
{
    const double processor_s = processor_s_min + processor_s_per_byte * static_cast<double>(size_bytes);
    return {processor_s, 6 * processor_s};
}

std::string extension_of(const std::filesystem::path& file)
{
    return lower_case(file.extension().string());
}

// A file of nearly that name in the same folder.
std::string did_you_mean(const std::filesystem::path& file)
{
    std::vector<std::string> names;
    std::error_code error;
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (std::find(extensions.begin(), extensions.end(), extension_of(entry->path())) != extensions.end())
            names.push_back(entry->path().filename().string());
    std::sort(names.begin(), names.end()); // a folder has no order
    const auto nearest = nearest_word(file.filename().string(), names);
    return nearest ? ": did you mean `" + *nearest + "`?" : ": paths start from the scene's folder";
}

MeshFileResult read_mesh(const std::filesystem::path& file)
{
    const std::string extension = extension_of(file);
    const IndexListener listener;
    Assimp::Importer importer;
    constexpr unsigned steps = aiProcess_Triangulate | aiProcess_PreTransformVertices;
    std::optional<ObjGroups> groups;
    if (extension == ".obj") groups.emplace(file);
    const bool grouped = groups && groups->found();
    const aiScene* scene = grouped
                               ? importer.ReadFileFromMemory(groups->text().data(), groups->text().size(), steps, "obj")
                               : importer.ReadFile(file.string(), steps);
    if (!scene) {
        const std::string why = importer.GetErrorString();
        if (why.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
        // How assimp says that a file is shorter than its number of triangles asks for, and that it holds points only.
        if (why.find("STL storage") != std::string::npos)
            return failed(unreadable + "it is no STL, or it is cut off: export it again");
        return failed(why.starts_with("No output meshes") ? no_triangle : unreadable + why);
    }
    if (!listener.heard().empty()) return failed(unreadable + listener.heard());

    MeshFileResult result;
    bool with_uv = scene->mNumMeshes > 0;
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) with_uv = with_uv && scene->mMeshes[i]->HasTextureCoords(0);
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
        append(result.mesh, *scene->mMeshes[i], with_uv);
        if (grouped)
            result.mesh.smoothing_groups.resize(result.mesh.triangles.size(),
                                                groups->group_of(*scene, *scene->mMeshes[i]));
    }
    if (result.mesh.triangles.empty()) return failed(no_triangle);
    result.warning = warning_of_rounding(result.mesh);
    return result;
}

} // namespace

MeshFileResult load_mesh(const std::filesystem::path& file, std::optional<MeshReadLimits> limits)
try {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored))
        return failed("there is no such file (looked for " + file.string() + ")" + did_you_mean(file));
    if (!std::filesystem::is_regular_file(file, ignored)) return failed("this is not a file");
    const std::uintmax_t size_bytes = std::filesystem::file_size(file, ignored);
    if (size_bytes == 0) return failed("the file is empty");
    const std::string extension = extension_of(file);
    if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end())
        return failed("expected a mesh of type .obj, .ply, .stl, .off, .3ds, .dae, .gltf or .glb, found " +
                      (extension.empty() ? "no type" : extension));
    MeshReading reading = read_in_own_process(
        [](const std::string& path) {
            try {
                return read_mesh(path);
            } catch (const std::bad_alloc&) {
                throw;
            } catch (const std::exception& problem) {
                return failed(unreadable + problem.what());
            }
        },
        std::filesystem::absolute(file).string(), limits.value_or(limits_for(size_bytes)));
    if (!reading.gave_up.empty())
        return failed("the reader of " + extension + " files gave up: " + reading.gave_up +
                      "; the file may be damaged or cut off: export it again, or as OBJ or STL");
    return std::move(reading.result);
} catch (const std::exception& problem) {
    return failed(unreadable + problem.what());
}

} // namespace haptel::runtime
