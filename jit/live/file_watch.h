// Tells when one of a set of files may have changed, whoever writes it and however: in place, by rename, by deletion
// and making anew, through a link.
//
// inotify on the folders that hold the files; where that is not to be had (limits, network file systems) the owner's
// timeouts stand in. A report is a hint: whoever cares compares the content.
#pragma once

#include <map>
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

} // namespace haptel::jit
