// What `haptel test` found out about each texture and each feel recording, as a table, as JSON and as JUnit's XML.
#pragma once

#include "jit/check/check_gradient.h"
#include "tools/check/amplified_place.h"
#include "tools/output/json.h"
#include "tools/replay/feel_report.h"

#include <optional>
#include <string>
#include <vector>

namespace haptel::tools {

struct TestedTexture {
    std::string file, name;                  // name empty: the file did not compile
    std::optional<jit::GradientCheck> check; // none: not reached
    std::string fault;                       // why it was not; empty: it was
    double seconds = 0;
    std::optional<AmplifiedPlace> amplified = {}; // with check->amplified
    bool is_held_promise = false;                 // a library's own test, which is flat: its gradient does not matter

    bool passed() const { return is_held_promise || (check && check->passed()); }
};

// A texture of `file` compared with the oracle, over the request's box.
TestedTexture test_texture(const std::shared_ptr<const jit::CompiledProgram>& program, const std::string& file,
                           const std::string& name, const TextureRequest& request, uint32_t points, uint64_t seed);

// Why it did not pass, one line each.
std::vector<std::string> reasons(const TestedTexture& texture);

struct TestReport {
    std::vector<TestedTexture> textures;
    std::vector<TestedFeel> feels;

    size_t count() const { return textures.size() + feels.size(); }
    size_t passed() const;
    size_t failed() const { return count() - passed(); }

    Json to_json() const;
    std::string to_table() const;
    std::string to_junit() const;
};

} // namespace haptel::tools
