#include "input/regular_file.h"
#include "runtime/files/mesh_process.h"
#include "runtime/files/obj_groups.h"
#include "runtime/files/table_reader.h"

#include <assimp/DefaultLogger.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <exception>
#include <limits>
#include <new>
#include <optional>
#include <set>
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

// What a file names is read like the file itself: a pipe, a device or what is too large is refused, and told.
class RegularFiles final : public Assimp::IOSystem {
public:
    explicit RegularFiles(std::filesystem::path mesh) : mesh_(std::move(mesh)) {}

    bool Exists(const char* file) const override
    {
        note(file);
        std::error_code ignored;
        return std::filesystem::exists(file, ignored);
    }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* file, const char* /*mode*/) override
    {
        note(file);
        input::FileBytes read = input::read_regular_file(file, mesh_bytes_max);
        const auto& [refusal, why] = read.refused;
        if (refusal == input::Refusal::none) return new Stream(std::move(read.bytes));
        if (refusal != input::Refusal::missing && refused_.empty())
            refused_ = "`" + std::filesystem::path(file).lexically_normal().string() + "` " + why;
        return nullptr;
    }
    void Close(Assimp::IOStream* stream) override { delete stream; }

    const std::string& refused() const { return refused_; }         // the first one that is there; empty: none
    const std::set<std::string>& others() const { return others_; } // asked for, seen from the mesh's folder

private:
    struct Bytes {
        std::string bytes;
    };
    struct Stream final : private Bytes, public Assimp::MemoryIOStream {
        explicit Stream(std::string read)
            : Bytes{std::move(read)}
            , MemoryIOStream(reinterpret_cast<const uint8_t*>(Bytes::bytes.data()), Bytes::bytes.size())
        {
        }
    };

    void note(const char* file) const
    {
        if (file != mesh_) others_.insert(std::filesystem::path(file).lexically_relative(mesh_.parent_path()).string());
    }

    std::filesystem::path mesh_;
    std::string refused_;
    mutable std::set<std::string> others_;
};

std::string material_of(const aiScene& scene, const aiMesh& part)
{
    aiString name;
    scene.mMaterials[part.mMaterialIndex]->Get(AI_MATKEY_NAME, name);
    return name.C_Str();
}

// Cutting a polygon into triangles takes time by the square of its corners, up to some nanoseconds each.
constexpr double polygon_squares_max = 3e8;

std::string fault_of_polygons(const aiScene& scene)
{
    double squares = 0;
    unsigned most = 0;
    for (unsigned i = 0; i < scene.mNumMeshes; ++i)
        for (unsigned f = 0; f < scene.mMeshes[i]->mNumFaces; ++f) {
            const unsigned corners = scene.mMeshes[i]->mFaces[f].mNumIndices;
            if (corners <= 4) continue; // at once
            squares += static_cast<double>(corners) * corners;
            most = std::max(most, corners);
        }
    if (squares <= polygon_squares_max) return {};
    return "its polygons have too many corners, up to " + std::to_string(most) +
           ": they are cut into triangles in a time that grows by the square of that. Cut them before the model is "
           "exported (\"triangulate\")";
}

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

const std::string no_triangle = "the file holds no triangle: points or lines only, or it is cut off before its faces";

MeshFileResult failed(std::string why)
{
    return {{}, std::move(why)};
}

// Why in the words of others, or close to them.
MeshFileResult unreadable(const std::string& why)
{
    return failed("the file could not be read: " + why +
                  "; is it damaged or cut off? Export it again, or as OBJ or STL");
}

// A machine that is slow, and a build that checks everything, read a megabyte in this time.
constexpr double processor_s_per_byte = 1e-6, processor_s_min = 1.5;
// What a file says about its sizes may be wrong, so that its reader asks for far more than its bytes can fill.
constexpr std::uintmax_t memory_per_byte = 32, memory_bytes_min = 256 << 20;

MeshReadLimits limits_for(std::uintmax_t size_bytes)
{
    const double processor_s = processor_s_min + processor_s_per_byte * static_cast<double>(size_bytes);
    return {processor_s, 6 * processor_s, memory_bytes_min + memory_per_byte * size_bytes};
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
    const std::string sought = file.filename().string();
    const auto same_letters = std::find_if(
        names.begin(), names.end(), [&](const std::string& name) { return lower_case(name) == lower_case(sought); });
    const std::optional<std::string> nearest =
        same_letters != names.end() ? std::optional(*same_letters) : nearest_word(sought, names);
    return nearest ? ": did you mean `" + *nearest + "`?" : ": paths start from the scene's folder";
}

MeshFileResult read_mesh(const std::filesystem::path& file)
{
    const std::string extension = extension_of(file);
    const IndexListener listener;
    Assimp::Importer importer;
    auto* const files = new RegularFiles(file); // the importer's
    importer.SetIOHandler(files);
    std::optional<ObjGroups> groups;
    if (extension == ".obj") groups.emplace(input::read_regular_file(file, mesh_bytes_max).bytes);
    const bool grouped = groups && groups->found();
    const aiScene* scene = groups && groups->needed()
                               ? importer.ReadFileFromMemory(groups->text().data(), groups->text().size(), 0, "obj")
                               : importer.ReadFile(file.string(), 0);
    if (!files->refused().empty()) return failed("it is made of other files, and " + files->refused());
    if (scene) {
        if (const std::string fault = fault_of_polygons(*scene); !fault.empty()) return failed(fault);
        scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_PreTransformVertices);
    }
    if (!scene) {
        const std::string why = importer.GetErrorString();
        if (why.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
        // How assimp says that a file holds points only; that its content is of no kind it knows, an STL cut off
        // included.
        if (why.starts_with("No output meshes")) return failed(no_triangle);
        const bool unknown = why.find("STL storage") != std::string::npos || why.starts_with("No suitable reader");
        return unreadable(unknown ? "its content is not that of a whole " + extension + " file" : why);
    }
    if (!listener.heard().empty()) return unreadable(listener.heard());

    std::size_t triangles = 0;
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) triangles += scene->mMeshes[i]->mNumFaces;
    if (triangles > mesh_triangles_max)
        return failed("it has " + std::to_string(triangles) + " triangles, and at most " +
                      std::to_string(mesh_triangles_max) + " are read: simplify the model before it is exported");

    MeshFileResult result;
    bool with_uv = scene->mNumMeshes > 0;
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) with_uv = with_uv && scene->mMeshes[i]->HasTextureCoords(0);
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
        append(result.mesh, *scene->mMeshes[i], with_uv);
        if (grouped)
            result.mesh.smoothing_groups.resize(result.mesh.triangles.size(),
                                                groups->group_of(material_of(*scene, *scene->mMeshes[i])));
    }
    if (result.mesh.triangles.empty()) return failed(no_triangle);
    result.warning = warning_of_rounding(result.mesh);
    for (const std::string& other : files->others()) (result.other_files += other) += '\0';
    if (groups && groups->dropped())
        result.warning += (result.warning.empty() ? "" : "; ") +
                          ("it has more than " + std::to_string(ObjGroups::parts_max) +
                           " smoothing groups, which are not kept apart then: it is felt round where it is not sharper "
                           "than `crease_deg`");
    return result;
}

} // namespace

MeshFileResult load_mesh(const std::filesystem::path& file, std::optional<MeshReadLimits> limits,
                         const Loading* loading)
try {
    std::error_code ignored;
    const input::Refused look = input::look_at_regular_file(file, mesh_bytes_max);
    if (look.refusal == input::Refusal::missing)
        return failed("there is no such file (looked for " + file.string() + ")" + did_you_mean(file));
    if (look.refusal != input::Refusal::none) return failed("it " + look.why);
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
                return unreadable(problem.what());
            }
        },
        std::filesystem::absolute(file).string(), limits.value_or(limits_for(size_bytes)), loading);
    if (!reading.gave_up.empty())
        return failed("the reader of " + extension + " files gave up: " + reading.gave_up +
                      "; the file may be damaged or cut off: export it again, or as OBJ or STL");
    return std::move(reading.result);
} catch (const std::exception& problem) {
    return unreadable(problem.what());
}

} // namespace haptel::runtime
