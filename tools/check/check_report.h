// What `haptel check` has to say, as JSON by the contract of the command and as text for people.
#pragma once

#include "lang/analyse.h"
#include "tools/check/check_precision.h"
#include "tools/output/json.h"

#include <memory>
#include <optional>
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

// Of a texture's height, as a hand has it (jit/texture/envelope.h).
struct CheckedHeights {
    ir::Interval found, felt;
    bool is_bent = false; // what lies beyond the latter, which is not proven
};

// A texture that compiled, and what it can be in a cube round the origin.
struct CheckedTexture {
    std::string file;
    std::shared_ptr<const lang::Program> program;
    const ir::Texture* texture = nullptr;
    lang::Analysis analysis;
    std::vector<std::string> any_picture;           // image parameters that nobody set
    std::optional<CheckedHeights> heights = {};     // without a value where a picture is missing
    std::optional<double> call_s = {};              // measured, of the code that a hand has; where costs are asked for
    std::optional<CheckedPrecision> precision = {}; // where a precision is asked for
};

struct CheckReport {
    double box_m = 0;             // side of the cube
    double normal_turn_per_m = 0; // that slopes of what reads normals are for
    bool with_cost = false;       // by line
    std::vector<CheckFinding> findings;
    std::vector<CheckedTexture> textures;

    size_t count(lang::Severity severity) const;
    // The findings of one file and of what it imports; said once, however many files import it.
    void add(const lang::CompileResult& result);
    void add(const lang::Diagnostics& diagnostics, const lang::SourceSet& sources);
    void add(CheckFinding finding);

    Json to_json() const;
    std::string to_text() const; // a line per texture; findings are rendered with their source lines elsewhere
};

// Names of what a texture reads and writes, in the order of their bits.
std::vector<std::string> inputs_of(const ir::Texture& texture);
std::vector<std::string> outputs_of(const ir::Texture& texture);
// "file name doc parameters inputs outputs": what is known of a texture before it is analysed.
Json texture_json(const std::string& file, const ir::Texture& texture);

} // namespace haptel::tools
