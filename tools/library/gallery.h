// A page that shows the textures of a library: the picture of each, its name, and what its doc comment says.
#pragma once

#include "libraries/manifest.h"
#include "tools/library/inspect_library.h"

#include <string>

namespace haptel::tools {

// Markdown. `pictures`: the folder of the previews, as seen from the page.
std::string gallery_page(const libraries::Manifest& manifest, const LibraryInspection& inspection,
                         const std::string& pictures);

// Writes the page to PAGE.md and its pictures beside it, into PAGE/, where those of textures that are gone go too. Why
// it could not be done, a line; empty: it is done.
std::string write_gallery(const libraries::Manifest& manifest, const LibraryInspection& inspection,
                          const std::string& page);

} // namespace haptel::tools
