// What `haptel check` has to say, as JSON by the contract of the command and as text for people.
#pragma once

#include "lang/compile.h"
#include "lang/ir/bounds.h"
#include "tools/json.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace haptel::tools {

// A finding with its place resolved: lines and columns from 1, ends exclusive; 1:1 if it is about the whole file.
struct CheckFinding {
    lang::Severity severity = lang::Severity::error;
    std::string code, message, hint, file;
    lang::Position begin, end;
};

// A texture that compiled, and the heights it can have in a cube round the origin.
struct CheckedTexture {
    std::string file;
    std::shared_ptr<const lang::Program> program;
    const ir::Texture* texture = nullptr;
    ir::TextureBounds bounds;      // at the parameters' values
    ir::TextureBounds over_ranges; // wherever their ranges allow; those without a range at their values
};

struct CheckReport {
    double box_m = 0; // side of the cube
    std::vector<CheckFinding> findings;
    std::vector<CheckedTexture> textures;

    size_t count(lang::Severity severity) const;
    // The findings of one file and of what it imports; said once, however many files import it.
    void add(const lang::CompileResult& result);
    void add(CheckFinding finding);

    Json to_json() const;
    std::string to_text() const; // a line per texture; findings are rendered with their source lines elsewhere
};

// Heights of the texture in the cube. `values` by Texture::parameters, SI.
CheckedTexture check_bounds(std::string file, std::shared_ptr<const lang::Program> program, const ir::Texture& texture,
                            const std::vector<double>& values, double box_m, double footprint_m);

} // namespace haptel::tools
