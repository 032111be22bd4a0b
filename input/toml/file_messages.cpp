#include "input/toml/file_messages.h"

#include <algorithm>

namespace haptel::input {

void FileMessages::write(toml::source_position at, std::string_view severity, const std::string& message)
{
    if (full()) {
        ++left_out_;
        return;
    }
    messages_.push_back(
        {at, place(at) + ": " + std::string(severity) + ": " +
                 (message.size() > message_bytes_max ? message.substr(0, message_bytes_max) + " ..." : message) +
                 "\n"});
}

std::string FileMessages::place(toml::source_position at) const
{
    if (file_.empty()) return at.line == 0 ? "scene" : "object " + std::to_string(at.line);
    return file_.string() + ":" + std::to_string(std::max<toml::source_index>(at.line, 1)) + ":" +
           std::to_string(std::max<toml::source_index>(at.column, 1));
}

std::string FileMessages::text() const
{
    std::vector<Message> sorted = messages_;
    std::stable_sort(sorted.begin(), sorted.end(), [](const Message& a, const Message& b) { return a.at < b.at; });
    std::string all;
    for (const Message& message : sorted) all += message.text;
    if (left_out_ > 0)
        all += place({}) + ": note: " + std::to_string(left_out_) +
               " more errors, warnings and notes are not shown: mend the first ones first\n";
    return all + added_;
}

void FileMessages::error(const toml::source_region& where, const std::string& message)
{
    ++errors_;
    write(where.begin, "error", message);
}

void FileMessages::error(const std::string& message)
{
    error(toml::source_region{}, message);
}

void FileMessages::warning(const toml::source_region& where, const std::string& message)
{
    write(where.begin, "warning", message);
}

void FileMessages::note(const toml::source_region& where, const std::string& message)
{
    write(where.begin, "note", message);
}

void FileMessages::add(std::string_view text)
{
    added_ += text;
    if (!added_.empty() && !added_.ends_with('\n')) added_ += '\n';
}

} // namespace haptel::input
