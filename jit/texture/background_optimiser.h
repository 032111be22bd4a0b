// The thread that makes the code of programs in use faster: full effort, after a draft is in the hand.
//
// What it makes has the same bits and takes the place of the draft under the feet of its callers
// (CompiledProgram::optimise), so nobody is told. It is kept on disk, and the next process begins with it. It yields to
// every other thread, waits until edits have come to rest, and drops programs that nobody holds any more.
#pragma once

#include "jit/texture/texture.h"

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace haptel::jit {

class BackgroundOptimiser {
public:
    // The one of this process; it ends with the process, which waits for the program under work.
    static BackgroundOptimiser& shared();

    void add(const std::shared_ptr<const CompiledProgram>& program);

private:
    BackgroundOptimiser();
    void run();
    void stop();

    std::mutex mutex;
    std::condition_variable changed;
    std::vector<std::weak_ptr<const CompiledProgram>> waiting;
    bool is_stopping = false;
    std::thread thread;
};

} // namespace haptel::jit
