// The compiler: a library of its own (haptel_compiler), so that a program without this header needs no LLVM.
#pragma once

#include <haptel/texture.h>

#include <haptel/mesh.h>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace haptel {

// How textures are compiled.
struct CompilerOptions {
    // Textures follow their files: what is saved is felt as soon as it is compiled. A file that is broken, half written
    // or gone leaves the old texture in the hand, and `report` hears why, on a thread of the compiler's, for as long as
    // there is a scene, a servo, a renderer or an object of it. Whoever lets go of the last waits for a report: it may
    // neither let go of them nor wait for who does.
    bool follow_files = false;
    std::function<void(std::string_view)> report = {}; // hears why a texture stays as it was
};

// Compiles what objects ask for as "FILE.haptel:NAME". Relative paths start from the working directory, and those of a
// scene file from its folder.
HAPTEL_API TextureSource compiler(CompilerOptions options = {});

// One texture with its values, to be looked at rather than felt: for figures, tests and other programs' forces. Cheap
// to copy.
class HAPTEL_API Texture {
public:
    explicit operator bool() const;      // false: messages() says why
    const std::string& messages() const; // with line and column; empty: all is well
    // Of one that was compiled, as long as it lives.
    const haptel_texture& table() const;
    const void* block() const;         // its values, as the entries of table() take them
    const haptel_facts& facts() const; // proven over the box
    // Where the surface is flat and faces +z. As many heights as points; as many gradients, or none. Any thread.
    void evaluate(std::span<const Vec3> points_m, std::span<double> heights_m, std::span<Vec3> gradients = {}) const;

    struct State;
    // By compile and compile_file.
    explicit Texture(std::shared_ptr<const State> state) : state_(std::move(state)) {}

private:
    std::shared_ptr<const State> state_; // never null
};

// Of an object that a texture is on.
struct Box {
    Vec3 minimum_m = {-0.05, -0.05, -0.05}, maximum_m = {0.05, 0.05, 0.05}; // its corners
};

// Of a text; without a name its only texture. Everything is computed in 64 bits, as for a servo.
HAPTEL_API Texture compile(std::string_view text, const std::string& name = {}, const Parameters& parameters = {},
                           const Box& box = {});
// The same of a file, and of what it imports.
HAPTEL_API Texture compile_file(const std::string& file, const std::string& name = {},
                                const Parameters& parameters = {}, const Box& box = {});

} // namespace haptel
