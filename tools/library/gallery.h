// A page that shows the textures of a library: the picture of each, its name, and what its doc comment says.
#pragma once

#include "libraries/package/package.h"
#include "tools/library/inspect_library.h"

#include <string>

namespace haptel::tools {

// Markdown: the library's own README.md, or its name and tagline where that is empty; then its textures. `pictures`:
// the folder of the previews, as seen from the page.
std::string gallery_page(const libraries::Manifest& manifest, const LibraryInspection& inspection,
                         const std::string& read_me, const std::string& pictures);

// Writes the page to PAGE.md and its pictures beside it, into PAGE/, where those of textures that are gone go too. Why
// it could not be done, a line; empty: it is done.
std::string write_gallery(const libraries::Package& package, const LibraryInspection& inspection,
                          const std::string& page);

} // namespace haptel::tools
