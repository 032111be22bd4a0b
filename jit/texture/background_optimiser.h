// The thread that makes the code of programs in use faster.
#pragma once

#include "jit/texture/texture.h"

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace haptel::jit {

// Full effort, after a draft is in the hand. What it makes has the same bits and takes the place of the draft under the
// feet of its callers, so nobody is told. It is kept on disk, and the next process begins with it. It yields to every
// other thread, waits until edits have come to rest, and drops programs that nobody holds any more.
class BackgroundOptimiser {
public:
    // The one of this process. It ends with its last owner, who waits for the program under work: LLVM makes objects
    // when it first needs them, and they go when the process ends; no thread may be at work with them by then.
    static std::shared_ptr<BackgroundOptimiser> shared();
    BackgroundOptimiser();

    // Any thread; once for each program, however often it is added.
    void add(const std::shared_ptr<const CompiledProgram>& program);

private:
    void run(const std::stop_token& stop);

    std::mutex mutex;
    std::condition_variable_any changed;
    using Programs = std::vector<std::weak_ptr<const CompiledProgram>>;
    Programs waiting, taken; // not begun, and begun or done
    std::jthread thread;     // last: ends before what it works on
};

} // namespace haptel::jit
