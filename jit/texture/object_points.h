// Places of a request's object at which its texture is called: to be timed, compared, and searched for its heights.
#pragma once

#include "lang/abi/texture_binding.h"

#include <cstdint>

namespace haptel::jit {

// The same for the same request, and spread evenly: additive sequences whose steps are powers of the generalised golden
// ratios (M. Roberts, The Unreasonable Effectiveness of Quasirandom Sequences, 2018).
class ObjectPoints {
public:
    explicit ObjectPoints(const TextureRequest& of) : request(of) {}

    // Where the request does not know the mesh's coordinates they are 0 .. 1; its Jacobian, up to 100 /m; time, within
    // a minute.
    haptel_point next();

private:
    const TextureRequest& request;
    uint64_t index = 0;
};

} // namespace haptel::jit
