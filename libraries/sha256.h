// Fingerprints of files that somebody may have changed on purpose: where bytes differ, so does this.
#pragma once

#include <string>
#include <string_view>

namespace haptel::libraries {

std::string sha256(std::string_view bytes); // 64 hexadecimal digits, as sha256sum writes them

} // namespace haptel::libraries
