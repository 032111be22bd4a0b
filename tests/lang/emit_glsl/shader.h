// Shaders of OpenGL ES run by Mesa on the processor, with no display: a number of floats for each texel of a square.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace haptel::test {

// One thread's. What fails is told by an exception.
class ShaderContext {
public:
    ShaderContext();
    ~ShaderContext();
    ShaderContext(const ShaderContext&) = delete;
    ShaderContext& operator=(const ShaderContext&) = delete;
    std::string renderer() const;

private:
    struct State;
    std::unique_ptr<State> state;
};

// A fragment shader of that version ("300 es") with `targets` outputs of type vec4, over side x side texels.
class Shader {
public:
    Shader(const std::string& version, const std::string& fragment_text, int side, int targets);
    ~Shader();
    Shader(const Shader&) = delete;
    Shader& operator=(const Shader&) = delete;

    // Uniforms; those that the compiler has left out are passed over.
    void set(const std::string& name, std::span<const float> components) const; // 1 to 4
    void set(const std::string& name, int32_t value) const;
    void set(const std::string& name, uint32_t value) const;
    // Textures: of vec4, and of words, in rows of so many texels.
    void set_numbers(const std::string& name, int width, const std::vector<float>& numbers);
    void set_words(const std::string& name, int width, std::vector<uint32_t> words);
    // By target, then texel, then component.
    std::vector<float> run();

private:
    int side, targets;
    uint32_t program = 0, framebuffer = 0, vertices = 0;
    std::vector<uint32_t> textures;

    int32_t place(const std::string& name) const;
    void add_texture(const std::string& name);
};

} // namespace haptel::test
