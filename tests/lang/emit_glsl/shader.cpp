#include "tests/lang/emit_glsl/shader.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>
#include <cstdlib>
#include <stdexcept>

namespace haptel::test {

namespace {

void require(bool holds, const std::string& what)
{
    if (!holds) throw std::runtime_error(what);
}

uint32_t compiled(GLenum kind, const std::string& text)
{
    const uint32_t shader = glCreateShader(kind);
    const char* const source = text.c_str();
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint is_good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &is_good);
    char said[4000] = "";
    glGetShaderInfoLog(shader, sizeof said, nullptr, said);
    require(is_good, std::string("a shader does not compile: ") + said);
    return shader;
}

} // namespace

struct ShaderContext::State {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
};

ShaderContext::ShaderContext() : state(std::make_unique<State>())
{
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1); // which is the user's
    setenv("GALLIVM_PERF", "nopt", 1); // each shader runs twice: what makes it fast takes longer than all of that
    state->display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    require(state->display != EGL_NO_DISPLAY && eglInitialize(state->display, nullptr, nullptr), "EGL has no display");
    require(eglBindAPI(EGL_OPENGL_ES_API), "EGL has no OpenGL ES");
    const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_NONE};
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    require(eglChooseConfig(state->display, wanted, &config, 1, &count), "EGL has no configuration");
    state->context = eglCreateContext(state->display, count ? config : EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version);
    require(state->context != EGL_NO_CONTEXT, "EGL makes no context of OpenGL ES 3");
    require(eglMakeCurrent(state->display, EGL_NO_SURFACE, EGL_NO_SURFACE, state->context), "EGL needs a surface");
}

ShaderContext::~ShaderContext()
{
    eglMakeCurrent(state->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(state->display, state->context);
    // The display stays: without it Mesa unloads its driver, and what that has leaked is nobody's (lsan.supp).
}

std::string ShaderContext::renderer() const
{
    return reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}

Shader::Shader(const std::string& version, const std::string& fragment_text, int of_side, int of_targets)
    : side(of_side), targets(of_targets)
{
    const std::string first_line = "#version " + version + "\n";
    const uint32_t vertex =
        compiled(GL_VERTEX_SHADER, first_line + "void main()\n{\n    vec2 corner = "
                                                "vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                                                "    gl_Position = vec4(4.0 * corner - 1.0, 0.0, 1.0);\n}\n");
    const uint32_t fragment = compiled(GL_FRAGMENT_SHADER, first_line + fragment_text);
    program = glCreateProgram();
    glAttachShader(program, vertex);
    glAttachShader(program, fragment);
    glLinkProgram(program);
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    GLint is_good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &is_good);
    char said[4000] = "";
    glGetProgramInfoLog(program, sizeof said, nullptr, said);
    require(is_good, std::string("a shader does not link: ") + said);
    glUseProgram(program);
    glGenVertexArrays(1, &vertices);
    glBindVertexArray(vertices);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    std::vector<GLenum> buffers;
    for (int i = 0; i < targets; ++i) {
        buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
        textures.push_back(0);
        glGenTextures(1, &textures.back());
        glBindTexture(GL_TEXTURE_2D, textures.back());
        glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, side, side);
        glFramebufferTexture2D(GL_FRAMEBUFFER, buffers.back(), GL_TEXTURE_2D, textures.back(), 0);
    }
    glDrawBuffers(targets, buffers.data());
    require(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE, "floats cannot be drawn to");
    glViewport(0, 0, side, side);
}

Shader::~Shader()
{
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteVertexArrays(1, &vertices);
    glDeleteTextures(static_cast<GLsizei>(textures.size()), textures.data());
    glDeleteProgram(program);
}

int32_t Shader::place(const std::string& name) const
{
    return glGetUniformLocation(program, name.c_str());
}

void Shader::set(const std::string& name, std::span<const float> components) const
{
    constexpr decltype(&glUniform1fv) setters[] = {glUniform1fv, glUniform2fv, glUniform3fv, glUniform4fv};
    setters[components.size() - 1](place(name), 1, components.data());
}

void Shader::set(const std::string& name, int32_t value) const
{
    glUniform1i(place(name), value);
}

void Shader::set(const std::string& name, uint32_t value) const
{
    glUniform1ui(place(name), value);
}

void Shader::add_texture(const std::string& name)
{
    const auto unit = static_cast<int32_t>(textures.size()) - targets;
    textures.push_back(0);
    glGenTextures(1, &textures.back());
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, textures.back());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    set(name, unit);
}

void Shader::set_numbers(const std::string& name, int width, const std::vector<float>& numbers)
{
    add_texture(name);
    const auto rows = static_cast<GLsizei>(numbers.size() / 4 / static_cast<size_t>(width));
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, rows, 0, GL_RGBA, GL_FLOAT, numbers.data());
}

void Shader::set_words(const std::string& name, int width, std::vector<uint32_t> words)
{
    add_texture(name);
    const auto rows = (words.size() + static_cast<size_t>(width) - 1) / static_cast<size_t>(width);
    words.resize(rows * static_cast<size_t>(width));
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R32UI, width, static_cast<GLsizei>(rows), 0, GL_RED_INTEGER, GL_UNSIGNED_INT,
                 words.data());
}

std::vector<float> Shader::run()
{
    glDrawArrays(GL_TRIANGLES, 0, 3);
    const size_t of_target = 4 * static_cast<size_t>(side * side);
    std::vector<float> made(of_target * static_cast<size_t>(targets));
    for (int i = 0; i < targets; ++i) {
        glReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
        glReadPixels(0, 0, side, side, GL_RGBA, GL_FLOAT, made.data() + of_target * static_cast<size_t>(i));
    }
    require(glGetError() == GL_NO_ERROR, "OpenGL reports an error");
    return made;
}

} // namespace haptel::test
