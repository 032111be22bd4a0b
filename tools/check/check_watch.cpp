#include "tools/check/check_watch.h"

#include "jit/live/file_watch.h"
#include "lang/text/source.h"
#include "tools/output/interrupt.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <poll.h>
#include <sys/stat.h>
#include <tuple>

namespace haptel::tools {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// As where a texture follows its file (jit/live/live_texture.cpp).
constexpr auto unasked = 1s;
constexpr auto absence_awaited = 500ms;

// Another one after each save, whatever was saved. Nothing: there is no such file.
using FileState = std::optional<std::tuple<dev_t, ino_t, off_t, time_t, long>>;

FileState state_of(const std::string& file)
{
    struct stat found{};
    if (stat(file.c_str(), &found) != 0) return std::nullopt;
    return std::tuple(found.st_dev, found.st_ino, found.st_size, found.st_mtim.tv_sec, found.st_mtim.tv_nsec);
}

using FileStates = std::map<std::string, FileState>;

FileStates states_of(const FileStates& files)
{
    FileStates now;
    for (const auto& [file, state] : files) now[file] = state_of(file);
    return now;
}

bool has_lost_one(const FileStates& before, const FileStates& now)
{
    return std::any_of(now.begin(), now.end(), [&](const auto& file) { return !file.second && before.at(file.first); });
}

// "a.haptel was saved, b.haptel is gone": what is different now.
std::string told(const FileStates& before, const FileStates& now)
{
    std::string text;
    for (const auto& [file, state] : now)
        if (state != before.at(file))
            text += (text.empty() ? "" : ", ") + lang::printable(std::filesystem::path(file).filename().string()) +
                    (state ? " was saved" : " is gone");
    return text;
}

void print_separator(const std::string& what)
{
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    char clock[16] = "";
    if (localtime_r(&now, &local)) std::strftime(clock, sizeof clock, "%H:%M:%S", &local);
    fmt::print(stderr, "---- {} {} ----\n", clock, what);
}

// Until a file is in another state than `known`; nothing if a signal came first.
std::optional<FileStates> changed(jit::FileWatch& watch, const FileStates& known)
{
    std::set<std::string> files;
    for (const auto& [file, state] : known) files.insert(file);
    constexpr auto never = Clock::time_point::max();
    jit::Settling settling;
    Clock::time_point gone_since = never;
    for (Clock::time_point due = Clock::now(); !interrupted();) { // at once: something may have changed meanwhile
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(due - Clock::now());
        pollfd descriptor{watch.descriptor(), POLLIN, 0};
        poll(&descriptor, 1, static_cast<int>(std::max<int64_t>(left.count(), 0)));
        const auto now = Clock::now();
        if (const auto change = watch.take(); change != jit::FileWatch::Change::none)
            due = settling.due_after(change, now);
        if (now < due) continue;
        watch.watch(files); // folders that were not there
        FileStates states = states_of(known);
        settling.read();
        if (has_lost_one(known, states)) {
            gone_since = std::min(gone_since, now);
            due = gone_since + absence_awaited;
            if (now < due) continue;
        }
        gone_since = never;
        if (states != known) return states;
        due = now + unasked;
    }
    return std::nullopt;
}

} // namespace

void repeat_at_each_save(const std::function<std::set<std::string>()>& work)
{
    listen_for_interrupts();
    jit::FileWatch watch;
    FileStates known;
    print_separator("checked, and again at each save; Ctrl-C ends");
    for (;;) {
        FileStates read;
        for (const std::string& file : work()) {
            const auto before = known.find(file); // as it was when the work began, if it was known then
            read[file] = before == known.end() ? state_of(file) : before->second;
        }
        std::fflush(stdout);
        std::optional<FileStates> now = changed(watch, read);
        if (!now) return;
        print_separator(told(read, *now));
        known = std::move(*now);
    }
}

} // namespace haptel::tools
