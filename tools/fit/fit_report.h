// What a fit has found, for people, for programs, and as a preset.
#pragma once

#include "jit/fit/fit.h"
#include "tools/output/json.h"

#include <string>
#include <string_view>

namespace haptel::tools {

// parameters: by name their values, SI; error, undetermined and bands.
Json fit_json(const haptel_texture& texture, const jit::FitResult& result);
std::string fit_text(const haptel_texture& texture, const jit::FitResult& result);

// "texture NAME = BASE(depth = 60e-6m, ...);", with a line that says what it was fitted to.
std::string preset_text(std::string_view name, std::string_view base, const haptel_texture& texture,
                        const jit::FitResult& result, std::string_view measured);

} // namespace haptel::tools
