#include "jit/live/file_watch.h"

#include <algorithm>
#include <filesystem>
#include <sys/inotify.h>
#include <unistd.h>

namespace haptel::jit {

namespace fs = std::filesystem;

namespace {

constexpr uint32_t ended = IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE | IN_ATTRIB;
constexpr uint32_t folder_events = ended | IN_CREATE | IN_MODIFY | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR;

using namespace std::chrono_literals;

// After the last sign that a file is complete: an editor's rename and what belongs to it are over by then.
constexpr auto settle_after_written = 10ms;
// After a write without an end: the writer is at work, or keeps the file open.
constexpr auto settle_after_writing = 150ms;
constexpr auto settle_longest = 1s; // since the first sign, however many follow

} // namespace

FileWatch::FileWatch() : inotify(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {}

FileWatch::~FileWatch()
{
    if (inotify >= 0) close(inotify);
}

void FileWatch::watch(const std::set<std::string>& files)
{
    if (inotify < 0) return;
    std::map<std::string, std::set<std::string>> wanted; // file names by folder
    for (const std::string& file : files) {
        std::error_code error;
        // The file as named and, where it is a link, the file behind it; empty: there is none.
        for (const fs::path& place : {fs::absolute(file, error).lexically_normal(), fs::canonical(file, error)})
            if (!place.empty()) wanted[place.parent_path()].insert(place.filename());
    }
    std::map<int, std::set<std::string>> names_by_number;
    for (auto& [folder, names] : wanted) {
        // Adding a folder that is watched already returns its number; a folder made anew gets a new one.
        const int number = inotify_add_watch(inotify, folder.c_str(), folder_events);
        if (number >= 0) names_by_number[number].merge(names); // two paths may lead to one folder, which has one number
    }
    for (const auto& [number, names] : names_by_watch)
        if (!names_by_number.contains(number)) inotify_rm_watch(inotify, number);
    names_by_watch = std::move(names_by_number);
}

FileWatch::Change FileWatch::take()
{
    Change change = Change::none;
    alignas(inotify_event) char buffer[16384];
    for (;;) {
        const ssize_t size = inotify < 0 ? 0 : read(inotify, buffer, sizeof buffer);
        if (size <= 0) return change;
        for (ssize_t at = 0; at < size;) {
            const auto* event = reinterpret_cast<const inotify_event*>(buffer + at);
            at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
            const auto folder = names_by_watch.find(event->wd);
            const bool lost = event->mask & IN_Q_OVERFLOW;
            const bool folder_gone = event->mask & (IN_DELETE_SELF | IN_MOVE_SELF | IN_IGNORED);
            const bool ours = lost || (folder != names_by_watch.end() &&
                                       (folder_gone || (event->len > 0 && folder->second.contains(event->name))));
            if (!ours) continue;
            change = std::max(change, lost || folder_gone || (event->mask & ended) ? Change::written : Change::writing);
        }
    }
}

Settling::Clock::time_point Settling::due_after(FileWatch::Change change, Clock::time_point now)
{
    if (!first_sign) first_sign = now;
    const auto settled = change == FileWatch::Change::written ? settle_after_written : settle_after_writing;
    return std::min<Clock::time_point>(now + settled, *first_sign + settle_longest);
}

} // namespace haptel::jit
