// Tells when one of a set of files may have changed, whoever writes it and however: in place, by rename, by deletion
// and making anew, through a link.
//
// inotify on the folders that hold the files; where that is not to be had (limits, network file systems) the owner's
// timeouts stand in. A report is a hint: whoever cares compares the content.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace haptel::jit {

class FileWatch {
public:
    FileWatch();
    ~FileWatch();
    FileWatch(const FileWatch&) = delete;
    FileWatch& operator=(const FileWatch&) = delete;

    // Replaces the set. Folders that do not exist yet are taken up at a later call.
    void watch(const std::set<std::string>& files);

    // To wait on with poll(); -1 where there is no inotify.
    int descriptor() const { return inotify; }

    enum class Change {
        none,
        writing, // somebody is at it: more is to come
        written  // closed, renamed or removed
    };
    // Takes all events that wait; never blocks.
    Change take();

private:
    int inotify = -1;
    std::map<int, std::set<std::string>> names_by_watch; // file names of interest, by a folder's watch descriptor
};

// When what somebody writes may be read: soon after it is closed, later where more is to come, and in any case a second
// after the first sign.
class Settling {
public:
    using Clock = std::chrono::steady_clock;

    // Of a change that was taken at this time.
    Clock::time_point due_after(FileWatch::Change change, Clock::time_point now);
    bool is_awaited() const { return first_sign.has_value(); }
    void read() { first_sign.reset(); }

private:
    std::optional<Clock::time_point> first_sign;
};

} // namespace haptel::jit
