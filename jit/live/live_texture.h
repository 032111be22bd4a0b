// A texture that follows its file: every edit of the file, of what it imports or of its pictures becomes a new binding.
//
// All live textures of a process share one compile thread: it watches the files, compiles, times the result and calls
// back; the servo never waits for it. A file that is broken, gone, half written or too slow leaves the old texture in
// the hand and is reported (too slow: for the request's servo). Parameter values survive by name and type: one that
// does not fit the new text is set aside and comes back when it fits again.
#pragma once

#include "jit/texture/resolver.h"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace haptel::jit {

struct LiveOptions {
    std::shared_ptr<ProgramCache> cache = ProgramCache::shared();
};

struct LiveCallbacks {
    // Called on the compile thread. They may take their time, publish to a slot, make and destroy other LiveTextures,
    // but not destroy their own.
    std::function<void(TextureBinding)> publish;
    std::function<void(std::string_view diagnostics)> report; // rendered text; may be empty: nobody listens
    // The same as publish where values alone are new, of the program and the pictures that are felt; what there is to
    // warn of is not reported then. May be empty: publish.
    std::function<void(TextureBinding)> publish_values = {};
};

class LiveTexture {
public:
    // The program that the cache holds for the file is taken to be in the hand already; with none, the first compiled
    // one is published.
    LiveTexture(TextureRequest request, LiveCallbacks callbacks, LiveOptions options = {});
    ~LiveTexture(); // waits for a callback that runs; none comes afterwards
    LiveTexture(const LiveTexture&) = delete;
    LiveTexture& operator=(const LiveTexture&) = delete;

    // A slider moved: publishes a binding with this value as soon as the compile thread is free, or reports why not.
    // Nothing is compiled. Any thread; never waits for the compiler.
    void set_parameter(std::string name, std::string value);
    // Several at once: no binding has a part of them.
    void set_parameters(std::vector<std::pair<std::string, std::string>> values);

private:
    class Client;
    std::unique_ptr<Client> client;
};

} // namespace haptel::jit
