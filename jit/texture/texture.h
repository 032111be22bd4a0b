// Source text to textures that can be called: the front door of the compiler for applications.
//
// compile_texture() says what there is to say about the text as data; make_binding() gives one texture its parameter
// values and what is proven about the two over an object. Nothing here throws or prints, whatever the text. A program
// is verified (lang/ir/verify.h) before a pointer into it is handed out.
#pragma once

#include "jit/engine/engine.h"
#include "lang/abi/texture_binding.h"
#include "lang/compile.h"

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::jit {

// The textures of one file with their code. Immutable; the code lives as long as the program.
class CompiledProgram {
public:
    CompiledProgram(std::shared_ptr<const lang::Program> checked, std::vector<EntryPoint> of_code,
                    std::shared_ptr<const Code> machine_code, bool has_facts);
    CompiledProgram(const CompiledProgram&) = delete;
    CompiledProgram& operator=(const CompiledProgram&) = delete;

    // In the order of the source. Their facts hold over the parameters' ranges and any point; where they were not asked
    // for, all but operations_max say that nothing is known.
    std::span<const haptel_texture> textures() const { return table; }
    // Null if there is none of that name; an empty one finds the only texture, or among several the one that is called
    // like the file.
    const haptel_texture* find(std::string_view name) const;

    // What the texture was compiled from, for evaluators other than code.
    const ir::Module& module() const { return program->module; }
    const lang::SourceSet& sources() const { return program->sources; }
    const ir::Texture& source_of(const haptel_texture& texture) const;

    // Puts code of full effort in the place of a draft or of quick code, in seconds rather than milliseconds; the same
    // bits. Any thread, whoever calls the entries meanwhile. Nothing happens where that is done, or cannot be.
    void optimise() const;
    bool is_optimised() const { return code->is_full(); }

private:
    std::shared_ptr<const lang::Program> program;
    std::vector<EntryPoint> entries;
    std::shared_ptr<const Code> code;
    std::vector<std::vector<haptel_parameter>> parameters; // by texture
    std::vector<std::vector<const char* const*>> choices;  // likewise, by parameter; they point into
    std::deque<std::vector<const char*>> choice_names;
    std::vector<haptel_texture> table;
};

// Which entries of each texture become code. A servo calls height_gradient alone; the batches are for pictures and
// figures.
enum class Entries : uint8_t { height_gradient, both, both_and_batches };

struct TextureOptions {
    std::string name = "texture.haptel"; // of the text, in messages
    Entries entries = Entries::both;
    bool standard_library = true;
    lang::ImportLoader load_import = {}; // empty: imports are errors
    std::string only_texture = {};       // compile this one alone; empty: all
    Effort effort = Effort::quick;
    bool kernels = true; // of drafts and quick code; no difference but in speed, of compilation and of the code
    // Whether haptel_texture::facts are looked for, which takes longer than all else: a binding has its own.
    bool facts_over_ranges = false;
    std::optional<Precision> precision = {}; // of every entry; none: f64 for one point, mixed for many
    // For one point: iterations of loops in lanes, which changes the order of additions. None: in mixed and f32, so
    // that f64 has the bits of the interpreter and of a batch.
    std::optional<bool> iterations_in_lanes = {};
};

// What a scene's textures are compiled with, for a hand that waits: a draft with height and gradient, to be optimised,
// and iterations in lanes.
TextureOptions servo_options();

struct CompiledTextures {
    std::shared_ptr<const CompiledProgram> program; // null if there was an error
    lang::Diagnostics diagnostics;
    lang::SourceSet sources;
    std::vector<std::string> files; // the text's own name, then its imports

    std::string rendered(bool color = false) const { return lang::render(diagnostics.all(), sources, color); }
    bool has_finding(std::string_view code) const
    {
        return std::ranges::find(diagnostics.all(), code, &lang::Diagnostic::code) != diagnostics.all().end();
    }
};

CompiledTextures compile_texture(std::string_view text, const TextureOptions& options = {});

// The first half of it: what there is to say about the text, and its IR; no code is made.
lang::CompileResult check_texture(std::string text, const TextureOptions& options = {});
lang::CompileResult check_texture_file(const std::string& path, TextureOptions options = {});
// The second half: code of what the first one made, if it made something.
CompiledTextures with_code(lang::CompileResult checked, const TextureOptions& options);

// What becomes code of such a program, under these options.
std::vector<EntryPoint> entry_points(const ir::Module& module, const TextureOptions& options);

// The same of a file; imports are read beside the files that name them. A file that cannot be read is an error at 1:1.
// `options.name` and `options.load_import` are set from `path`.
CompiledTextures compile_texture_file(const std::string& path, TextureOptions options = {});

// Who a binding is for. A hand is given a finite range of heights, whatever is proven (jit/texture/envelope.h), and no
// other fact, which it need not wait for; pictures and figures all that is proven, infinite where nothing is.
enum class For : uint8_t { hand, figures };

// What a search finds of a texture's height: at least this.
struct FoundHeights {
    double minimum_m = 0, maximum_m = 0;
};

// One texture of a program (empty name: its only one) with the request's parameters, box and footprint; the request's
// reference is not looked at. Refused, with a message that says how to mend it: a name that does not exist, a value
// that does not fit, a call that takes too long for the request's servo. `found`: filled for a hand.
TextureResult make_binding(const std::shared_ptr<const CompiledProgram>& program, std::string_view texture,
                           const TextureRequest& request, For use = For::hand, FoundHeights* found = nullptr);

// For a hand that turns a knob, within a millisecond or two where a call takes some microseconds. `before` is of the
// same program, texture and pictures with other values, by make_binding. The range of heights may be another than that
// of make_binding; it is as true. Neither a binding nor diagnostics: so soon nothing can be said of the range.
TextureResult make_binding_at_once(const std::shared_ptr<const CompiledProgram>& program, std::string_view texture,
                                   const TextureRequest& request, const TextureBinding& before);

} // namespace haptel::jit
