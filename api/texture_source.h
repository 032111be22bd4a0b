// What stands behind a TextureSource: the compiler's library makes one, too.
#pragma once

#include "lang/abi/texture_binding.h"

#include <haptel/texture.h>

#include <functional>
#include <memory>
#include <string>

namespace haptel {

// A texture that follows its files.
class FollowedTexture {
public:
    virtual ~FollowedTexture() = default; // no binding comes afterwards
    virtual void set(const std::string& parameter, const std::string& value) = 0;
};

struct TextureSource::Implementation {
    TextureResolver resolve;
    // The same with the program that is in use, for other values: nothing is read but pictures. Nothing, and no
    // diagnostics: the file was compiled again and has mistakes.
    TextureResolver rebind;
    // Empty: its textures do not follow their files. What is published comes on another thread; the publisher says why
    // it is not used, or nothing.
    std::function<std::unique_ptr<FollowedTexture>(TextureRequest, std::function<std::string(TextureBinding)>)> follow;
};

} // namespace haptel
