// Where the textures of a scene come from. A program that compiles them includes haptel/compiler.h; one that brings
// compiled ones needs no compiler.
#pragma once

#include <haptel/abi.h>
#include <haptel/export.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace haptel {

// Name and value as a scene file has them: {{"depth", "60um"}, {"octaves", "5"}}.
using Parameters = std::vector<std::pair<std::string, std::string>>;

// Cheap to copy. One that was made of nothing leaves every object smooth and refuses textures.
class HAPTEL_API TextureSource {
public:
    TextureSource() = default;

    struct Implementation;
    // By compiler and precompiled.
    explicit TextureSource(std::shared_ptr<const Implementation> implementation)
        : implementation_(std::move(implementation))
    {
    }
    // For scenes.
    const Implementation* implementation() const { return implementation_.get(); }

private:
    std::shared_ptr<const Implementation> implementation_;
};

// Textures that were compiled ahead of time, by `haptel build` or by hand: an object asks for "precompiled:NAME". The
// tables stay where they are as long as a scene uses them. Their bounds are those over all values of their parameters.
HAPTEL_API TextureSource precompiled(std::vector<const haptel_texture*> textures);

} // namespace haptel
