// Which code generator this is: a hash of its sources, made when it is built.
#pragma once

namespace haptel::jit {

extern const char code_version[];

} // namespace haptel::jit
