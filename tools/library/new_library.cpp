#include "tools/library/new_library.h"

#include "libraries/manifest.h"

#include <fmt/format.h>

namespace haptel::tools {

namespace {

// {0}: the library's name.
constexpr const char* manifest = R"(schema = 1
name = "{0}"
version = "0.1.0"
tagline = "What these textures have in common"
authors = ["Your Name <you@example.org>"]
license = "Apache-2.0"        # how others may use it: a name of https://spdx.org/licenses
textures = ["waves:waves"]    # FILE:TEXTURE, each that others shall use
tags = ["first"]
haptel = "{1}"              # the least version that it needs
language = 1

[dependencies]                # other libraries, and the least versions that will do
)";

// In the style of haptel fmt.
constexpr const char* texture = R"(/// Straight waves, as of a washboard.
texture waves(
    float wavelength = 2mm in 0.5mm .. 20mm,  // from crest to crest
    float depth = 40um     in 0um .. 300um)   // how high they are, half of it up and half of it down
{
    return 0.5 * depth * sinturn(p.x / wavelength);
}
)";

constexpr const char* test =
    R"(// A test has the name of the texture that it tests, and is flat where that keeps its promise.
import {0}.waves as tested;

/// One wavelength further everything is as it was.
texture waves()
{{
    return tested.waves() - tested.waves(p = p + vec3(2mm, 0, 0));
}}
)";

constexpr const char* read_me = R"(# {0}

Pack this library with `haptel pack {0}`, and install what that makes with `haptel install`. Then
`import {0}.waves;` finds its textures.
)";

} // namespace

libraries::Contents new_library(const std::string& name)
{
    const std::string haptel = to_text(libraries::haptel_version());
    return {{libraries::manifest_name, fmt::format(manifest, name, haptel.substr(0, haptel.rfind('.')))},
            {"waves.haptel", texture},
            {"tests/waves.haptel", fmt::format(test, name)},
            {"README.md", fmt::format(read_me, name)}};
}

} // namespace haptel::tools
