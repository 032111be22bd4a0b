// A texture with what a fit looks for in it; and the result of a search, in words of the texture.
#pragma once

#include "jit/fit/fit.h"
#include "jit/fit/misfit.h"
#include "jit/fit/parameter_gradient.h"
#include "jit/fit/search.h"
#include "jit/fit/unknowns.h"

#include <optional>
#include <span>

namespace haptel::jit {

class TextureToFit {
public:
    // Over a rectangle of these sides round the origin of the plane z = 0.
    TextureToFit(const std::shared_ptr<const CompiledProgram>& program, const FitRequest& request, double width_m,
                 double height_m);
    const std::string& failure() const { return why; } // empty: there are the two below
    Unknowns& unknowns() { return *looked_for; }
    const ParameterGradient& texture() const { return *made; }

    // `all`: what a search with this last misfit found.
    FitResult result(std::span<const Found> all, Misfit& misfit);

private:
    std::optional<TextureBinding> binding; // keeps what the block points to
    std::optional<Unknowns> looked_for;
    std::optional<ParameterGradient> made;
    std::string why;
};

} // namespace haptel::jit
