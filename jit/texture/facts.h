// What is proven about a texture, as the C interface carries it.
#pragma once

#include "lang/abi/abi.h"
#include "lang/abi/texture_binding.h"
#include "lang/ir/bounds/spline_image.h"
#include "lang/ir/ir.h"

#include <span>

namespace haptel::jit {

// For every point and all values within the parameters' ranges.
haptel_facts facts_over_ranges(const ir::Module& module, const ir::Texture& texture);

// Nothing is known, but for the operations: their count costs nothing.
haptel_facts no_facts(const ir::Module& module, const ir::Texture& texture);

// For points of the box, these values and images (by Texture::parameters, SI), this footprint, and normals and mesh
// coordinates as the request knows them.
haptel_facts facts_over_box(const ir::Module& module, const ir::Texture& texture, std::span<const double> values,
                            std::span<const ir::SplineImage* const> images, const haptel_block_head& head,
                            const TextureRequest& request);

} // namespace haptel::jit
