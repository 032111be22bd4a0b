// Scene files in a folder of their own, and what is said about them.
#pragma once

#include "runtime/files/scene_file.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"

#include <memory>
#include <string>
#include <string_view>

namespace haptel::tests {

using test::Folder;

// One right-angled triangle with legs of 3 and 4 units.
inline constexpr std::string_view triangle_obj = "v 0 0 0\nv 4 0 0\nv 0 3 0\nf 1 2 3\n";

inline TextureResult resolve_flat(const TextureRequest&)
{
    return {flat_texture(0), ""};
}

inline runtime::DeviceResult open_scripted(const runtime::DeviceRequest&)
{
    return {std::make_unique<ScriptedDevice>([](uint64_t, runtime::DevicePose&) { return runtime::DeviceStatus::ok; }),
            ""};
}

inline bool contains(std::string_view text, std::string_view part)
{
    return text.find(part) != text.npos;
}

// What is said about a scene, with the folder's name taken out.
inline std::string diagnostics_of(std::string_view toml, const TextureResolver& textures = resolve_flat,
                                  const runtime::DeviceFactory& devices = open_scripted)
{
    using namespace std::string_view_literals;
    const Folder folder;
    folder.write("triangle.obj", triangle_obj);
    folder.write("empty.obj", "");
    folder.write("garbage.obj", "\0\1\2\xff\xfe garbage \n\n f f f"sv);
    folder.write("points.obj", "v 0 0 0\nv 1 0 0\n");
    folder.write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 inf 0\nf 1 2 3\n");
    folder.write("beyond.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\nf 1 2 3\n");
    folder.write(
        "beyond.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face "
        "2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n4 0 0\n0 3 0\n3 0 1 2\n3 0 1 7\n");
    folder.write("beyond.off", "OFF\n3 2 0\n0 0 0\n4 0 0\n0 3 0\n3 0 1 2\n3 0 1 9\n");
    folder.write("note.txt", "hello");
    const runtime::LoadedScene loaded = runtime::load_scene(folder.write("scene.toml", toml), textures, devices);
    std::string text = loaded.diagnostics;
    const std::string name = folder.path.string() + "/";
    for (std::size_t at; (at = text.find(name)) != std::string::npos;) text.erase(at, name.size());
    CHECK((loaded.scene == nullptr) == (text.find(": error: ") != std::string::npos));
    CHECK(loaded.hands.empty() == (loaded.scene == nullptr));
    return text;
}

inline runtime::LoadedScene load(const Folder& folder, std::string_view toml,
                                 const TextureResolver& textures = resolve_flat,
                                 const runtime::DeviceFactory& devices = open_scripted)
{
    folder.write("triangle.obj", triangle_obj);
    runtime::LoadedScene loaded = runtime::load_scene(folder.write("scene.toml", toml), textures, devices);
    INFO(loaded.diagnostics);
    REQUIRE(loaded.scene);
    return loaded;
}

} // namespace haptel::tests
