// Writes a file so that whoever reads it, and whatever happens meanwhile, finds the old text or the new one whole.
#pragma once

#include <string>
#include <string_view>

namespace haptel::tools {

// Replaces the text of a file that exists; its permissions stay, and a link goes on pointing to it. Returns why it
// could not be done; empty: it is done.
std::string replace_file(const std::string& path, std::string_view text);

// The same of a file that may not exist yet; its folder does. What is no regular file is never replaced.
std::string write_file(const std::string& path, std::string_view bytes);

// Why write_file would refuse, before the work; empty: it would not.
std::string why_not_written(const std::string& path);

} // namespace haptel::tools
