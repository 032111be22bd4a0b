// Does something again whenever files are saved, until Ctrl-C.
//
// An editor may write in place, rename a new file over the old one, or delete and make it anew: each is one save. What
// has gone for longer than that is a change too, and so is its return. Where the system does not tell of changes, files
// are looked at once a second.
#pragma once

#include <functional>
#include <set>
#include <string>

namespace haptel::tools {

// `work` is called now and after each change of what it names: files, whether they exist or not. Before each call a
// line with the time goes to standard error. Returns at Ctrl-C, or SIGTERM, after the call that runs; a second one ends
// the program as it ends any.
void repeat_at_each_save(const std::function<std::set<std::string>()>& work);

} // namespace haptel::tools
